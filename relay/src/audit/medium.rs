//! Where the lines are kept: a file, or memory.

use std::fs::{self, File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::{owner, wall_clock};

/// The name of the records in the data folder.
pub(crate) const FILE: &str = "audit.jsonl";

/// What lines are appended to.
pub(super) trait Medium: Send {
    /// Appends all of it or nothing.
    fn append(&mut self, bytes: &[u8]) -> Result<(), AppendError>;
    /// Keeps what there is under another name, which is returned, and begins an empty one.
    fn set_aside(&mut self) -> io::Result<String>;
    /// What has to be synchronised with the disk.
    fn file(&self) -> Option<Arc<File>>;
    /// How many bytes have been appended.
    fn length(&self) -> u64;
    /// A copy of memory; a file is read by its path.
    fn memory(&self) -> Option<Vec<u8>>;
}

/// Why nothing was appended.
#[derive(Debug)]
pub(super) enum AppendError {
    /// The disk says no: full, read-only, broken.
    Failed(io::Error),
    /// Somebody else has touched what is there.
    Touched(String),
}

/// `audit.jsonl`. Each append is one `write`, so that the end of this process loses nothing.
#[derive(Debug)]
pub(super) struct OnDisk {
    folder: PathBuf,
    path: PathBuf,
    file: Arc<File>,
    length: u64,
    /// A write was cut short and the rest of it could not be removed yet.
    ragged: bool,
}

impl OnDisk {
    /// Opens or makes the file, which ends after `length` bytes from now on.
    pub(super) fn open(folder: &Path, length: u64) -> io::Result<Self> {
        let path = folder.join(FILE);
        let file = open(&path)?;
        owner::give(&path, &fs::metadata(folder)?)?;
        if file.metadata()?.len() != length {
            file.set_len(length)?;
        }
        Ok(Self { folder: folder.to_owned(), path, file: Arc::new(file), length, ragged: false })
    }

    /// The file under our name is the one that we write, and nobody else has.
    fn check(&self) -> Result<(), AppendError> {
        let there = match fs::metadata(&self.path) {
            Ok(there) => there,
            Err(error) if error.kind() == io::ErrorKind::NotFound => {
                return Err(AppendError::Touched(format!("{FILE} was removed while the relay ran")));
            }
            Err(error) => return Err(AppendError::Failed(error)),
        };
        if !is_same(&there, &self.file.metadata().map_err(AppendError::Failed)?) {
            return Err(AppendError::Touched(format!("{FILE} was replaced while the relay ran")));
        }
        if there.len() != self.length {
            return Err(AppendError::Touched(format!(
                "{FILE} has {} bytes instead of {}: it was changed while the relay ran",
                there.len(),
                self.length
            )));
        }
        Ok(())
    }
}

impl Medium for OnDisk {
    fn append(&mut self, bytes: &[u8]) -> Result<(), AppendError> {
        if self.ragged {
            self.file.set_len(self.length).map_err(AppendError::Failed)?;
            self.ragged = false;
        }
        self.check()?;
        match (&*self.file).write_all(bytes) {
            Ok(()) => {
                self.length += bytes.len() as u64;
                Ok(())
            }
            Err(error) => {
                self.ragged = self.file.set_len(self.length).is_err();
                Err(AppendError::Failed(error))
            }
        }
    }

    fn set_aside(&mut self) -> io::Result<String> {
        let kept = set_aside(&self.folder)?;
        *self = Self::open(&self.folder, 0)?;
        Ok(kept)
    }

    fn file(&self) -> Option<Arc<File>> {
        Some(Arc::clone(&self.file))
    }

    fn length(&self) -> u64 {
        self.length
    }

    fn memory(&self) -> Option<Vec<u8>> {
        None
    }
}

/// Gives the file in this folder another name, which is returned; empty when there is none.
pub(super) fn set_aside(folder: &Path) -> io::Result<String> {
    let day: String = wall_clock::now().chars().take(19).filter(char::is_ascii_alphanumeric).collect();
    let name = (1..1_000)
        .map(|number| match number {
            1 => format!("audit-broken-{day}.jsonl"),
            number => format!("audit-broken-{day}-{number}.jsonl"),
        })
        .find(|name| !folder.join(name).exists())
        .unwrap_or_default();
    match fs::rename(folder.join(FILE), folder.join(&name)) {
        Ok(()) => Ok(name),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(String::new()),
        Err(error) => Err(error),
    }
}

fn open(path: &Path) -> io::Result<File> {
    let mut options = OpenOptions::new();
    options.append(true).create(true);
    #[cfg(unix)]
    std::os::unix::fs::OpenOptionsExt::mode(&mut options, 0o600);
    options.open(path)
}

#[cfg(unix)]
fn is_same(one: &fs::Metadata, other: &fs::Metadata) -> bool {
    use std::os::unix::fs::MetadataExt;
    (one.dev(), one.ino()) == (other.dev(), other.ino())
}

#[cfg(not(unix))]
fn is_same(_: &fs::Metadata, _: &fs::Metadata) -> bool {
    // Here an open file cannot be replaced.
    true
}

/// For relays without a data folder.
#[derive(Debug, Default)]
pub(super) struct InMemory(Vec<u8>);

impl Medium for InMemory {
    fn append(&mut self, bytes: &[u8]) -> Result<(), AppendError> {
        self.0.extend_from_slice(bytes);
        Ok(())
    }

    fn set_aside(&mut self) -> io::Result<String> {
        self.0.clear();
        Ok(String::new())
    }

    fn file(&self) -> Option<Arc<File>> {
        None
    }

    fn length(&self) -> u64 {
        self.0.len() as u64
    }

    fn memory(&self) -> Option<Vec<u8>> {
        Some(self.0.clone())
    }
}
