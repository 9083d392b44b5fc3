//! The folder on the disk: read once, and written file by file, each whole or not at all.

use std::collections::BTreeMap;
use std::fs::{self, File, Metadata, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use super::error::FilesError;
use super::walk::Walk;

/// A folder and the text of its files as they were read or written last, by path with `/`.
#[derive(Debug)]
pub(crate) struct Folder {
    root: PathBuf,
    known: BTreeMap<String, String>,
}

/// Files as they should be: their text, or nothing.
pub(super) type Changes = BTreeMap<String, Option<String>>;

/// What was changed on the disk, and what was there before.
#[derive(Debug)]
pub(super) struct Undo(Vec<(String, Option<String>)>);

impl Folder {
    /// Reads what could belong to a project. A folder that is not there is made.
    pub(crate) fn open(root: &Path) -> Result<Self, FilesError> {
        let unreadable = |error| FilesError::Unreadable(root.display().to_string(), error);
        fs::create_dir_all(root).map_err(unreadable)?;
        let Walk { known, errors, .. } = Walk::through(root);
        if errors.is_empty() {
            Ok(Self { root: root.to_owned(), known })
        } else {
            Err(FilesError::Wrong(errors))
        }
    }

    /// The files of a folder that is there; nothing is made.
    pub(crate) fn look(root: &Path) -> Result<BTreeMap<String, String>, FilesError> {
        let unreadable = |error| FilesError::Unreadable(root.display().to_string(), error);
        fs::read_dir(root).map_err(unreadable)?;
        Self::open(root).map(|folder| folder.known)
    }

    /// Writes files into a folder that has none yet.
    pub(crate) fn fill(self, files: BTreeMap<String, String>) -> Result<(), FilesError> {
        if !self.known.is_empty() {
            return Err(FilesError::NotEmpty(self.root.display().to_string()));
        }
        self.apply(&files.into_iter().map(|(path, text)| (path, Some(text))).collect()).map(drop)
    }

    /// What is known of the files.
    pub(crate) const fn files(&self) -> &BTreeMap<String, String> {
        &self.known
    }

    /// What people might call it.
    pub(super) fn name(&self) -> String {
        let root = fs::canonicalize(&self.root).unwrap_or_else(|_| self.root.clone());
        root.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default()
    }

    /// Makes the files so: all of them or none. Nothing is overwritten that is not as it is known.
    pub(super) fn apply(&self, changes: &Changes) -> Result<Undo, FilesError> {
        for path in changes.keys() {
            self.is_as_known(path)?;
        }
        let mut undo = Undo(Vec::new());
        // What is new first: whatever happens in between, nothing is missing.
        let (new, gone): (Vec<_>, Vec<_>) = changes.iter().partition(|(_, text)| text.is_some());
        for (path, text) in new.into_iter().chain(gone) {
            let done = match text {
                Some(text) => self.write(path, text),
                None => self.remove(path),
            };
            if let Err(source) = done {
                self.undo(undo);
                return Err(FilesError::Write { file: path.clone(), source });
            }
            undo.0.push((path.clone(), self.known.get(path).cloned()));
        }
        Ok(undo)
    }

    /// Makes the files as they were.
    pub(super) fn undo(&self, undo: Undo) {
        for (path, text) in undo.0.into_iter().rev() {
            let done = match &text {
                Some(text) => self.write(&path, text),
                None => self.remove(&path),
            };
            if let Err(error) = done {
                tracing::error!(%error, file = path, "a file of the project could not be put back");
            }
        }
    }

    /// The files are so from now on.
    pub(super) fn adopt(&mut self, changes: Changes) {
        for (path, text) in changes {
            match text {
                Some(text) => drop(self.known.insert(path, text)),
                None => drop(self.known.remove(&path)),
            }
        }
    }

    fn is_as_known(&self, path: &str) -> Result<(), FilesError> {
        let conflict = |how| FilesError::Conflict { file: path.to_owned(), how };
        let file = self.at(path);
        // Neither the file nor its folders may have become links.
        let mut above = file.parent();
        while let Some(folder) = above.filter(|folder| **folder != *self.root) {
            if fs::symlink_metadata(folder).is_ok_and(|metadata| !metadata.is_dir()) {
                return Err(conflict("is behind a link, or behind something else that is no folder,"));
            }
            above = folder.parent();
        }
        let there = match fs::symlink_metadata(&file) {
            Ok(metadata) if !metadata.is_file() => {
                return Err(conflict("has become something else than a file"));
            }
            Ok(_) => {
                Some(fs::read(&file).map_err(|source| FilesError::Write { file: path.to_owned(), source })?)
            }
            Err(error) if error.kind() == io::ErrorKind::NotFound => None,
            Err(source) => return Err(FilesError::Write { file: path.to_owned(), source }),
        };
        match (there, self.known.get(path)) {
            (None, None) => Ok(()),
            (Some(bytes), Some(text)) if bytes == text.as_bytes() => Ok(()),
            (Some(_), Some(_)) => Err(conflict("was changed by somebody else")),
            (None, Some(_)) => Err(conflict("was removed by somebody else")),
            (Some(_), None) => Err(conflict("was made by somebody else")),
        }
    }

    /// Writes a file beside and puts it in its place, so that nobody ever sees half of it.
    fn write(&self, path: &str, text: &str) -> io::Result<()> {
        let file = self.at(path);
        let folder = file.parent().unwrap_or(&self.root);
        fs::create_dir_all(folder)?;
        writable(&fs::metadata(folder)?)?;
        let there = fs::metadata(&file).ok();
        if let Some(there) = &there {
            writable(there)?;
        }
        let name = file.file_name().map(|name| name.to_string_lossy()).unwrap_or_default();
        let beside = folder.join(format!(".{name}.new"));
        let done = write_all(&beside, text, there.as_ref()).and_then(|()| fs::rename(&beside, &file));
        if done.is_err() {
            let _ = fs::remove_file(&beside);
        }
        done?;
        settle(folder)
    }

    fn remove(&self, path: &str) -> io::Result<()> {
        let file = self.at(path);
        let folder = file.parent().unwrap_or(&self.root);
        writable(&fs::metadata(folder)?)?;
        fs::remove_file(&file)?;
        settle(folder)?;
        if path.starts_with("groups/") {
            // The folder of a target without groups. It stays if it is not empty.
            let _ = fs::remove_dir(folder);
        }
        Ok(())
    }

    fn at(&self, path: &str) -> PathBuf {
        path.split('/').fold(self.root.clone(), |at, step| at.join(step))
    }
}

fn write_all(path: &Path, text: &str, like: Option<&Metadata>) -> io::Result<()> {
    match fs::remove_file(path) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(error),
        _ => {}
    }
    let mut file = OpenOptions::new().write(true).create_new(true).open(path)?;
    if let Some(like) = like {
        file.set_permissions(like.permissions())?;
    }
    file.write_all(text.as_bytes())?;
    file.sync_all()
}

/// A name in a folder lasts only when the folder is written, too. Windows has no such thing.
fn settle(folder: &Path) -> io::Result<()> {
    if cfg!(unix) { File::open(folder)?.sync_all() } else { Ok(()) }
}

/// Whoever has made something read-only means it, and root as well.
fn writable(metadata: &Metadata) -> io::Result<()> {
    // On Windows the mark of a folder means something else.
    let counts = cfg!(unix) || metadata.is_file();
    if counts && metadata.permissions().readonly() {
        return Err(io::Error::new(io::ErrorKind::PermissionDenied, "it is read-only"));
    }
    Ok(())
}
