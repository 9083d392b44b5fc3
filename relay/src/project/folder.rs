//! The folder on the disk: read once, and written file by file, each whole or not at all.

use std::collections::BTreeMap;
use std::fs::{self, File, Metadata, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use super::error::FilesError;
use super::journal::{JOURNAL, Journal};
use super::walk::{BESIDE, Walk};

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
        fs::create_dir_all(root).map_err(|error| unreadable(root, error))?;
        for leftover in Walk::through(root).leftovers {
            let _ = fs::remove_file(leftover);
        }
        Self::read(root)
    }

    /// Reads what could belong to a project, of a folder that is there.
    pub(crate) fn read(root: &Path) -> Result<Self, FilesError> {
        fs::read_dir(root).map_err(|error| unreadable(root, error))?;
        if fs::symlink_metadata(root.join(JOURNAL)).is_ok() {
            return Err(FilesError::Unfinished);
        }
        let Walk { known, errors, .. } = Walk::through(root);
        if errors.is_empty() {
            Ok(Self { root: root.to_owned(), known })
        } else {
            Err(FilesError::Wrong(errors))
        }
    }

    /// Writes files into a folder that has none yet.
    pub(crate) fn fill(self, files: BTreeMap<String, String>) -> Result<(), FilesError> {
        if !self.known.is_empty() {
            return Err(FilesError::NotEmpty(self.root.display().to_string()));
        }
        let files = files.into_iter().map(|(path, text)| (path, Some(text))).collect();
        self.apply(&files, "unpacked")?;
        self.done();
        Ok(())
    }

    /// A change that was begun and not finished is taken back; one that the database has `stored` was finished but for its
    /// journal. Returns the files that it was about.
    pub(crate) fn repair(root: &Path, stored: Option<&str>) -> Result<Vec<String>, FilesError> {
        let broken = |source| FilesError::Journal { file: JOURNAL.to_owned(), source };
        let Some(journal) = Journal::read(root).map_err(broken)? else { return Ok(Vec::new()) };
        let mut folder = Self { root: root.to_owned(), known: BTreeMap::new() };
        if stored != Some(&*journal.change) {
            // Whatever somebody has done meanwhile is not undone with it.
            for (path, sides) in &journal.files {
                folder.adopt([(path.clone(), sides.before.clone())].into());
                if folder.is_as_known(path).is_err() {
                    folder.adopt([(path.clone(), sides.after.clone())].into());
                    folder.is_as_known(path).map_err(|_| FilesError::Torn { file: path.clone() })?;
                }
            }
            let mut before: Vec<_> =
                journal.files.iter().map(|(path, sides)| (path, &sides.before)).collect();
            // What is missing first, what is too much after it.
            before.sort_by_key(|(_, text)| text.is_none());
            for (path, text) in before {
                let done = match text {
                    Some(text) if folder.known.get(path) != Some(text) => folder.write(path, text),
                    None if folder.known.contains_key(path) => folder.remove(path),
                    _ => Ok(()),
                };
                done.map_err(|source| FilesError::Write { file: path.clone(), source })?;
            }
        }
        for path in journal.files.keys() {
            folder.sweep(path);
        }
        folder.clear_journal().map_err(broken)?;
        Ok(journal.files.into_keys().collect())
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

    /// Makes the files so: all of them or none. Nothing is overwritten that is not as it is known. What the database calls
    /// the `change` is left in a journal until it is [`done`](Self::done).
    pub(super) fn apply(&self, changes: &Changes, change: &str) -> Result<Undo, FilesError> {
        for path in changes.keys() {
            self.is_as_known(path)?;
        }
        // One file alone changes whole or not at all.
        if changes.len() > 1 {
            let journal = Journal::of(change, &self.known, changes);
            journal
                .text()
                .and_then(|text| self.write(JOURNAL, &text))
                .map_err(|source| FilesError::Write { file: JOURNAL.to_owned(), source })?;
        }
        let mut undo = Undo(Vec::new());
        for (path, text) in steps(changes) {
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

    /// The database has stored the change, too.
    pub(super) fn done(&self) {
        if let Err(error) = self.clear_journal() {
            tracing::error!(%error, file = JOURNAL, "the journal of the project could not be removed");
        }
    }

    /// Makes the files as they were.
    pub(super) fn undo(&self, undo: Undo) {
        let mut is_whole = true;
        for (path, text) in undo.0.into_iter().rev() {
            let done = match &text {
                Some(text) => self.write(&path, text),
                None => self.remove(&path),
            };
            if let Err(error) = done {
                is_whole = false;
                tracing::error!(%error, file = path, "a file of the project could not be put back");
            }
        }
        // Otherwise the next start tries again.
        if is_whole {
            self.done();
        }
    }

    fn clear_journal(&self) -> io::Result<()> {
        match fs::remove_file(self.root.join(JOURNAL)) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(()),
            Err(error) => Err(error),
            // Before anybody is told: it must not be there again after a power failure.
            Ok(()) => settle(&self.root),
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
        let beside = beside(&file);
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

    /// Removes what an interrupted change has left around a file: what was written beside it, and a folder without groups.
    fn sweep(&self, path: &str) {
        let file = self.at(path);
        let _ = fs::remove_file(beside(&file));
        if let Some(folder) = file.parent().filter(|_| path.starts_with("groups/")) {
            let _ = fs::remove_dir(folder);
        }
    }

    fn at(&self, path: &str) -> PathBuf {
        path.split('/').fold(self.root.clone(), |at, step| at.join(step))
    }
}

/// The changes in their order. What is new first: whatever happens in between, nothing is missing.
pub(super) fn steps(changes: &Changes) -> impl Iterator<Item = (&String, &Option<String>)> {
    let (new, gone): (Vec<_>, Vec<_>) = changes.iter().partition(|(_, text)| text.is_some());
    new.into_iter().chain(gone)
}

/// Where the new text of a file is written first.
fn beside(file: &Path) -> PathBuf {
    let name = file.file_stem().map(|name| name.to_string_lossy()).unwrap_or_default();
    file.with_file_name(format!(".{name}{BESIDE}"))
}

fn unreadable(root: &Path, error: io::Error) -> FilesError {
    FilesError::Unreadable(root.display().to_string(), error)
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
