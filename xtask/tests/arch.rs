//! `cargo xtask arch` as people and CI call it.

use std::{
    path::{Path, PathBuf},
    process::{Command, Output},
};

fn arch(root: &Path) -> Output {
    Command::new(env!("CARGO_BIN_EXE_xtask")).arg("arch").arg(root).output().expect("xtask starts")
}

fn fixture(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests").join("fixtures").join(name)
}

#[test]
fn a_forbidden_import_fails_and_is_named_with_file_and_line() {
    let output = arch(&fixture("forbidden_import"));
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(!output.status.success(), "{said}");
    let place = Path::new("shared").join("src").join("wire").join("mod.rs");
    let expected = format!("{}:1: wire may import nothing, not crate::plan::Plan", place.display());
    assert!(said.contains(&expected), "{said}");
}

#[test]
fn the_same_crate_without_that_import_passes() {
    let output = arch(&fixture("allowed_imports"));
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}

#[test]
fn cipdeck_itself_passes() {
    let output = arch(Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap());
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}
