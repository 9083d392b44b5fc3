//! The folder as it is found.

use std::collections::BTreeMap;
use std::fs::{self, Metadata};
use std::io;
use std::path::{Path, PathBuf};

use cipdeck_shared::config::project::{
    MAX_PROJECT_BYTES, MAX_PROJECT_FILE, MAX_PROJECT_FILES, PROJECT_HEAD, Position, ProjectError,
    ProjectErrorKind,
};

/// Folders of a project.
const FOLDERS: [&str; 3] = ["blocks", "targets", "groups"];

/// Folders in folders that are looked into. Files belong at most two deep; what is deeper is told as misplaced.
const MAX_DEPTH: usize = 4;

/// How files end that are written beside others; they begin with a dot.
pub(super) const BESIDE: &str = ".json.new";

/// Reads the folder.
pub(super) struct Walk<'a> {
    root: &'a Path,
    pub(super) known: BTreeMap<String, String>,
    bytes: usize,
    pub(super) errors: Vec<ProjectError>,
    /// What was written beside a file and never put in its place: the relay was killed.
    pub(super) leftovers: Vec<PathBuf>,
}

impl<'a> Walk<'a> {
    /// Reads everything that could belong to a project.
    pub(super) fn through(root: &'a Path) -> Self {
        let mut walk =
            Self { root, known: BTreeMap::new(), bytes: 0, errors: Vec::new(), leftovers: Vec::new() };
        walk.top();
        walk
    }

    /// `cipdeck.json`, the folders of a project, and loose blocks; nothing else is touched.
    fn top(&mut self) {
        for (name, path) in self.entries(self.root, "") {
            if FOLDERS.contains(&name.as_str()) {
                self.any(&path, &name, 1);
            } else if path.extension().is_some_and(|ending| ending == "json") && !path.is_dir() {
                self.any(&path, &name, MAX_DEPTH);
            }
        }
        // Without a version loose blocks are the project; with one they are somebody else's.
        if self.known.contains_key(PROJECT_HEAD) {
            self.known.retain(|path, _| path == PROJECT_HEAD || path.contains('/'));
            let is_loose = |path: &str| path != PROJECT_HEAD && is_json(path) && !path.contains('/');
            self.errors.retain(|error| !is_loose(&error.file));
        }
    }

    fn any(&mut self, at: &Path, path: &str, depth: usize) {
        match fs::symlink_metadata(at) {
            Err(error) => self.error(path, ProjectErrorKind::Unreadable(error.to_string())),
            Ok(metadata) if metadata.is_symlink() => self.error(path, ProjectErrorKind::Link),
            Ok(metadata) if metadata.is_dir() && depth < MAX_DEPTH => {
                for (name, inner) in self.entries(at, path) {
                    self.any(&inner, &format!("{path}/{name}"), depth + 1);
                }
            }
            Ok(metadata) if metadata.is_dir() => {
                self.error(path, ProjectErrorKind::Misplaced("no folder belongs so deep into a project"));
            }
            Ok(metadata) if metadata.is_file() && is_json(path) => self.file(at, path, &metadata),
            Ok(_) if path.to_ascii_lowercase().ends_with(".json") => {
                self.error(
                    path,
                    ProjectErrorKind::Misplaced("names of files end with .json, in small letters"),
                );
            }
            Ok(_) => {}
        }
    }

    /// What is in a folder, without what is hidden, by name.
    fn entries(&mut self, at: &Path, path: &str) -> Vec<(String, PathBuf)> {
        let mut entries = Vec::new();
        let read = fs::read_dir(at).and_then(Iterator::collect::<io::Result<Vec<_>>>);
        match read {
            Err(error) => self.error(path, ProjectErrorKind::Unreadable(error.to_string())),
            Ok(found) => {
                for entry in found {
                    match entry.file_name().into_string() {
                        Ok(name) if name.starts_with('.') => {
                            if name.ends_with(BESIDE) {
                                self.leftovers.push(entry.path());
                            }
                        }
                        Ok(name) => entries.push((name, entry.path())),
                        Err(name) => {
                            let name = name.to_string_lossy();
                            self.error(&format!("{path}/{name}"), ProjectErrorKind::Path);
                        }
                    }
                }
            }
        }
        entries.sort();
        entries
    }

    fn file(&mut self, at: &Path, path: &str, metadata: &Metadata) {
        let length = usize::try_from(metadata.len()).unwrap_or(usize::MAX);
        self.bytes = self.bytes.saturating_add(length);
        let too = if length > MAX_PROJECT_FILE {
            Some(ProjectErrorKind::FileTooLong)
        } else if self.bytes > MAX_PROJECT_BYTES {
            Some(ProjectErrorKind::TooLong)
        } else if self.known.len() >= MAX_PROJECT_FILES {
            Some(ProjectErrorKind::TooManyFiles)
        } else {
            None
        };
        if let Some(too) = too {
            return self.error(path, too);
        }
        match fs::read(at).map(text) {
            Err(error) => self.error(path, ProjectErrorKind::Unreadable(error.to_string())),
            Ok(Err(position)) => {
                let (file, what) = (path.to_owned(), ProjectErrorKind::Encoding);
                self.errors.push(ProjectError { file, position: Some(position), what });
            }
            Ok(Ok(text)) => drop(self.known.insert(path.to_owned(), text)),
        }
    }

    fn error(&mut self, path: &str, what: ProjectErrorKind) {
        self.errors.push(ProjectError { file: path.to_owned(), position: None, what });
    }
}

/// Whether this is a file as a project has them.
pub(super) fn is_json(path: &str) -> bool {
    Path::new(path).extension().is_some_and(|ending| ending == "json")
}

/// UTF-8, or where it ends to be.
pub(super) fn text(bytes: Vec<u8>) -> Result<String, Position> {
    String::from_utf8(bytes).map_err(|error| {
        let good = error.as_bytes().get(..error.utf8_error().valid_up_to());
        let good = String::from_utf8_lossy(good.unwrap_or_default());
        let line = good.matches('\n').count() + 1;
        let column = good.rsplit('\n').next().unwrap_or_default().chars().count() + 1;
        Position { line, column }
    })
}
