//! A change of several files is told on the disk before it begins, so that it can be taken back when the relay, or the
//! whole machine, ends in the middle of it.

use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::Path;

use cipdeck_shared::config::project::{MAX_PROJECT_BYTES, PROJECT_HEAD};
use cipdeck_shared::config::write_hex;
use serde::{Deserialize, Serialize};

use super::folder::Changes;
use super::walk::is_json;
use crate::store::StoreError;

/// Its file. Hidden, so that it is no part of the project; it is there as long as the change lasts.
pub(super) const JOURNAL: &str = ".cipdeck-change.json";

/// Bytes of it that are read: all files twice, and what JSON adds to them.
const MAX_JOURNAL: u64 = 4 * MAX_PROJECT_BYTES as u64;

/// A change of several files.
#[derive(Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Journal {
    /// What the database calls the change, once it has stored it.
    pub(super) change: String,
    pub(super) files: BTreeMap<String, Sides>,
}

/// The text of a file, or that there is none.
#[derive(Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Sides {
    pub(super) before: Option<String>,
    pub(super) after: Option<String>,
}

impl Journal {
    pub(super) fn of(change: &str, known: &BTreeMap<String, String>, changes: &Changes) -> Self {
        let sides = |path: &String, after: &Option<String>| Sides {
            before: known.get(path).cloned(),
            after: after.clone(),
        };
        let files = changes.iter().map(|(path, after)| (path.clone(), sides(path, after)));
        Self { change: change.to_owned(), files: files.collect() }
    }

    pub(super) fn text(&self) -> io::Result<String> {
        Ok(serde_json::to_string(self)?)
    }

    /// What a folder has, if it has one. Whoever can write there could have made it: it may say nothing about files that
    /// are none of the project's.
    pub(super) fn read(root: &Path) -> io::Result<Option<Self>> {
        let file = root.join(JOURNAL);
        let wrong = |why: &str| io::Error::new(io::ErrorKind::InvalidData, why);
        match fs::symlink_metadata(&file) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
            Err(error) => return Err(error),
            Ok(there) if !there.is_file() || there.len() > MAX_JOURNAL => {
                return Err(wrong("this is not what the relay has written"));
            }
            Ok(_) => {}
        }
        let journal: Self = serde_json::from_slice(&fs::read(&file)?)?;
        if journal.files.keys().all(|path| is_of_a_project(path)) {
            Ok(Some(journal))
        } else {
            Err(wrong("it speaks of files that are none of a project's"))
        }
    }
}

/// Whether a project has files like that.
fn is_of_a_project(path: &str) -> bool {
    let is_plain = |step: &str| !step.starts_with('.') && !step.contains(['\\', ':']);
    let is_file = |file: &str| is_plain(file) && is_json(file);
    match path.split('/').collect::<Vec<_>>()[..] {
        [PROJECT_HEAD] => true,
        ["blocks" | "targets", file] => is_file(file),
        ["groups", target, file] => !target.is_empty() && is_plain(target) && is_file(file),
        _ => false,
    }
}

/// Another one for each change, whatever database and folder it is about.
pub(super) fn name_of_a_change() -> Result<String, StoreError> {
    let mut bytes = [0; 16];
    let unknown = |error| StoreError::Secrets(format!("the system gives no random numbers: {error}"));
    getrandom::fill(&mut bytes).map_err(unknown)?;
    Ok(write_hex(&bytes))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_journal_speaks_of_nothing_but_files_of_the_project() {
        let root = tempfile::tempdir().unwrap();
        let write = |path: &str| {
            let sides = Sides { before: None, after: None };
            let journal = Journal { change: "x".to_owned(), files: [(path.to_owned(), sides)].into() };
            fs::write(root.path().join(JOURNAL), journal.text().unwrap()).unwrap();
            journal
        };
        for path in ["cipdeck.json", "blocks/a b.json", "targets/x.json", "groups/x/a.json"] {
            let journal = write(path);
            assert_eq!(Journal::read(root.path()).unwrap(), Some(journal), "{path}");
        }
        for path in [
            "",
            "x.json",
            "/etc/x.json",
            "../x.json",
            "blocks/../x.json",
            "blocks/.json",
            "blocks/.x.json",
            "blocks/x",
            "blocks/a\\b.json",
            "blocks/a/b.json",
            "groups/../x.json",
            "groups//x.json",
            "groups/x.json",
            ".git/config",
        ] {
            write(path);
            let refused = Journal::read(root.path()).unwrap_err().to_string();
            assert!(refused.contains("none of a project's"), "{path}: {refused}");
        }
    }
}
