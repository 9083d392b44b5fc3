//! A consistent copy of the data folder in one file, and the way back. docs/OPERATION.md says how to use it.
//!
//! The file is a tar archive, so that people can look into it. It holds hashes of passwords and the key of the relay's
//! certificate: nobody else can read it, and it is made and used at the relay's machine only.

mod copy;
mod make;
mod restore;

#[cfg(test)]
mod tests;

use std::fs::{self, File, OpenOptions};
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use cipdeck_shared::config::write_hex;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

pub(crate) use self::make::make;
pub(crate) use self::restore::restore;

/// The first file of the archive: what is in it.
const MANIFEST: &str = "backup.json";

/// What a data folder is made of; `relay.lock` and the write-ahead logs belong to a running relay.
const FILES: [&str; 8] = [
    "cipdeck.sqlite",
    "history.sqlite",
    "audit.head",
    "audit.jsonl",
    "read-only",
    "tls/cert.pem",
    "tls/key.pem",
    "tls/about.json",
];

/// Why there is no backup, or nothing was restored.
#[derive(Debug, thiserror::Error)]
pub(crate) enum BackupError {
    /// No relay has ever used the folder.
    #[error("there is no relay's database in {}: name its folder with --data", .0.display())]
    NoDatabase(PathBuf),
    /// Nothing is overwritten.
    #[error("{} is there already: nothing is overwritten", .0.display())]
    Exists(PathBuf),
    /// A file cannot be read or written.
    #[error("{}: {source}", path.display())]
    Io {
        /// Which file.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// A database cannot be copied.
    #[error("{}: {source}", path.display())]
    Sqlite {
        /// Which database.
        path: PathBuf,
        /// Why.
        source: rusqlite::Error,
    },
    /// It is not one, or is damaged.
    #[error("this is no backup that can be used: {0}")]
    Damaged(String),
}

impl BackupError {
    /// Says which file an error is about.
    fn at(path: &Path) -> impl FnOnce(io::Error) -> Self + use<> {
        let path = path.to_owned();
        move |source| Self::Io { path, source }
    }
}

/// What an archive holds.
#[derive(Debug, Serialize, Deserialize)]
struct Manifest {
    /// The version of cipdeck that made it.
    cipdeck: String,
    /// When (RFC 3339).
    at: String,
    files: Vec<Entry>,
}

#[derive(Debug, PartialEq, Eq, Serialize, Deserialize)]
struct Entry {
    name: String,
    bytes: u64,
    sha256: String,
}

/// A name that a data folder may hold, and no way out of it.
fn is_known(name: &str) -> bool {
    let is_broken_audit = || {
        let day = name.strip_prefix("audit-broken-").and_then(|rest| rest.strip_suffix(".jsonl"));
        day.is_some_and(|day| day.bytes().all(|byte| byte.is_ascii_alphanumeric() || byte == b'-'))
    };
    FILES.contains(&name) || is_broken_audit()
}

/// A new folder for this user alone.
fn make_folder(path: &Path) -> io::Result<()> {
    let mut builder = fs::DirBuilder::new();
    #[cfg(unix)]
    std::os::unix::fs::DirBuilderExt::mode(&mut builder, 0o700);
    builder.create(path)
}

/// A new file for this user alone.
fn make_file(path: &Path) -> io::Result<File> {
    let mut options = OpenOptions::new();
    options.write(true).create_new(true);
    #[cfg(unix)]
    std::os::unix::fs::OpenOptionsExt::mode(&mut options, 0o600);
    options.open(path)
}

/// Hashes what is read through it.
struct Hashed<R> {
    inner: R,
    hash: Sha256,
}

impl<R> Hashed<R> {
    fn new(inner: R) -> Self {
        Self { inner, hash: Sha256::new() }
    }

    /// Of everything that was read.
    fn sha256(self) -> String {
        write_hex(&self.hash.finalize())
    }
}

impl<R: Read> Read for Hashed<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let read = self.inner.read(buffer)?;
        self.hash.update(buffer.get(..read).unwrap_or_default());
        Ok(read)
    }
}

/// A folder that is gone, with everything in it, unless it is kept.
struct Staging {
    path: PathBuf,
    is_kept: bool,
}

impl Staging {
    fn make(path: PathBuf) -> Result<Self, BackupError> {
        match make_folder(&path) {
            Ok(()) => Ok(Self { path, is_kept: false }),
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => Err(BackupError::Exists(path)),
            Err(source) => Err(BackupError::Io { path, source }),
        }
    }
}

impl Drop for Staging {
    fn drop(&mut self) {
        if !self.is_kept {
            // What cannot be removed is in the way of the next attempt, which says so.
            let _ = fs::remove_dir_all(&self.path);
        }
    }
}

/// The path with something behind its name.
fn beside(path: &Path, ending: &str) -> PathBuf {
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(ending);
    path.with_file_name(name)
}
