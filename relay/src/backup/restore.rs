//! Going back to a backup.

use std::collections::BTreeSet;
use std::fs::{self, File};
use std::io::{self, BufReader, Read};
use std::path::Path;

use super::{
    BackupError, Entry, Hashed, MANIFEST, Manifest, Staging, beside, is_known, make_file, make_folder,
};
use crate::owner;

/// Longest list of files.
const MAX_MANIFEST: u64 = 1024 * 1024;

/// Fills a folder that is empty or not there from a backup, completely or not at all. Returns when the backup was made,
/// and by which version.
pub(crate) fn restore(file: &Path, data: &Path) -> Result<(String, String), BackupError> {
    let empty = match fs::read_dir(data) {
        Ok(mut entries) => match entries.next() {
            Some(_) => return Err(BackupError::Exists(data.to_owned())),
            None => Some(fs::metadata(data).map_err(BackupError::at(data))?),
        },
        Err(error) if error.kind() == io::ErrorKind::NotFound => None,
        Err(source) => return Err(BackupError::Io { path: data.to_owned(), source }),
    };
    if let Some(parent) = data.parent().filter(|parent| !parent.as_os_str().is_empty()) {
        fs::create_dir_all(parent).map_err(BackupError::at(parent))?;
    }
    let mut staging = Staging::make(beside(data, ".restoring"))?;
    let archive = File::open(file).map_err(BackupError::at(file))?;
    let manifest = unpack(BufReader::new(archive), &staging.path)?;
    if let Some(former) = empty {
        // It was made for a relay that runs as somebody else.
        owner::give(&staging.path, &former).map_err(BackupError::at(data))?;
        fs::remove_dir(data).map_err(BackupError::at(data))?;
    }
    fs::rename(&staging.path, data).map_err(BackupError::at(data))?;
    staging.is_kept = true;
    Ok((manifest.at, manifest.cipdeck))
}

fn unpack(archive: impl Read, folder: &Path) -> Result<Manifest, BackupError> {
    let unreadable = |error: io::Error| damaged(&format!("not an archive ({error})"));
    let mut archive = tar::Archive::new(archive);
    let mut entries = archive.entries().map_err(unreadable)?;
    let mut next = || entries.next().transpose().map_err(unreadable);
    let manifest = match next()? {
        Some(entry) if name(&entry).as_deref() == Some(MANIFEST) => manifest(entry)?,
        _ => return Err(damaged("it does not begin with backup.json")),
    };
    let mut left: BTreeSet<&str> = manifest.files.iter().map(|entry| entry.name.as_str()).collect();
    while let Some(entry) = next()? {
        let name = name(&entry).unwrap_or_default();
        let expected = manifest.files.iter().find(|entry| entry.name == name);
        // Each once, and nothing else: a name from elsewhere could lead out of the folder.
        let Some(expected) = expected.filter(|_| is_known(&name) && left.remove(name.as_str())) else {
            return Err(damaged(&format!("{name:?} does not belong there")));
        };
        take(entry, expected, folder)?;
    }
    match left.first() {
        Some(missing) => Err(damaged(&format!("{missing} is missing"))),
        None if !manifest.files.iter().any(|entry| entry.name == "cipdeck.sqlite") => {
            Err(damaged("it has no database"))
        }
        None => Ok(manifest),
    }
}

fn manifest(entry: impl Read) -> Result<Manifest, BackupError> {
    let mut text = Vec::new();
    let read = entry.take(MAX_MANIFEST).read_to_end(&mut text);
    read.map_err(|error| damaged(&error.to_string()))?;
    serde_json::from_slice(&text).map_err(|error| damaged(&format!("backup.json: {error}")))
}

/// Writes one file and compares it with what the list says.
fn take(entry: impl Read, expected: &Entry, folder: &Path) -> Result<(), BackupError> {
    let path = folder.join(&expected.name);
    if let Some(parent) = path.parent()
        && !parent.exists()
    {
        make_folder(parent).map_err(BackupError::at(parent))?;
    }
    let mut file = make_file(&path).map_err(BackupError::at(&path))?;
    let mut hashed = Hashed::new(entry);
    let bytes = io::copy(&mut hashed, &mut file).map_err(BackupError::at(&path))?;
    file.sync_all().map_err(BackupError::at(&path))?;
    let sha256 = hashed.sha256();
    if bytes != expected.bytes || sha256 != expected.sha256 {
        return Err(damaged(&format!("{} is not as it was", expected.name)));
    }
    Ok(())
}

/// The name of a plain file.
fn name(entry: &tar::Entry<'_, impl Read>) -> Option<String> {
    let path = entry.path().ok()?;
    path.to_str().filter(|_| entry.header().entry_type().is_file()).map(str::to_owned)
}

fn damaged(what: &str) -> BackupError {
    BackupError::Damaged(what.to_owned())
}
