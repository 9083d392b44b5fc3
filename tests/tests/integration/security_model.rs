//! The security model names a test for each threat. Here it is seen to that they exist.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

const MODEL: &str = include_str!("../../../docs/SECURITY-MODEL.md");

#[test]
fn every_threat_names_a_test_that_exists() {
    let tests = tests();
    assert!(tests.len() > 300, "only {} tests were found", tests.len());
    let mut threats = 0;
    for table in MODEL.split("| threat |").skip(1) {
        for row in table.lines().skip(2).take_while(|line| line.starts_with('|')) {
            let cells: Vec<_> = row.trim_matches('|').split(" | ").collect();
            let [threat, answer, named] = cells[..] else { panic!("three cells: {row}") };
            assert!(!threat.trim().is_empty() && !answer.trim().is_empty(), "{row}");
            let quoted: Vec<_> = named.split('`').skip(1).step_by(2).collect();
            assert!(!quoted.is_empty(), "no test is named: {row}");
            for name in quoted {
                assert!(tests.contains(name), "there is no test {name}: {row}");
            }
            threats += 1;
        }
    }
    assert!(threats >= 50, "only {threats} threats were read");
}

/// The names of all tests of the workspace.
fn tests() -> BTreeSet<String> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut tests = BTreeSet::new();
    for folder in ["relay", "shared", "frontend", "tests", "xtask"] {
        for file in rust_files(&root.join(folder)) {
            let text = fs::read_to_string(&file).expect("a source file");
            // In a proptest the attribute is on a function inside of a macro: it looks the same.
            for part in text.split("test").filter(|part| part.starts_with([']', '(', '_'])) {
                let next = part.split_once("fn ").map(|(between, rest)| (between, rest.split('(').next()));
                if let Some((between, Some(name))) = next
                    && between.len() < 200
                {
                    tests.insert(name.trim().to_owned());
                }
            }
        }
    }
    tests
}

fn rust_files(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for entry in fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            if path.file_name().is_some_and(|name| name != "target") {
                files.extend(rust_files(&path));
            }
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            files.push(path);
        }
    }
    files
}
