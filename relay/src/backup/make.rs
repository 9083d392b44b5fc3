//! Making a backup.

use std::fs::{self, File};
use std::io;
use std::path::Path;

use super::{
    BackupError, Entry, FILES, Hashed, MANIFEST, Manifest, Staging, beside, copy, is_known, make_file,
};
use crate::wall_clock;

/// Copies a data folder into a new file; a relay may be using the folder. Returns how many bytes the file has.
pub(crate) fn make(data: &Path, file: &Path, with_history: bool) -> Result<u64, BackupError> {
    if !data.join("cipdeck.sqlite").exists() {
        return Err(BackupError::NoDatabase(data.to_owned()));
    }
    if file.exists() {
        return Err(BackupError::Exists(file.to_owned()));
    }
    let staging = Staging::make(beside(file, ".parts"))?;
    let mut entries = Vec::new();
    for name in names(data, with_history)? {
        let (from, to) = (data.join(&name), staging.path.join(&name));
        match name.as_str() {
            "cipdeck.sqlite" | "history.sqlite" => copy::database(&from, &to)?,
            name if name.starts_with("audit") && name != "audit.head" => copy::records(&from, &to)?,
            _ => copy::file(&from, &to)?,
        }
        entries.push(entry(name, &to)?);
    }
    let manifest =
        Manifest { cipdeck: env!("CARGO_PKG_VERSION").to_owned(), at: wall_clock::now(), files: entries };
    let new = staging.path.join("archive");
    pack(&staging.path, &manifest, &new).map_err(BackupError::at(&new))?;
    put(&new, file)?;
    fs::metadata(file).map(|file| file.len()).map_err(BackupError::at(file))
}

/// Gives the archive its name, which nobody else has taken meanwhile: a link, unlike a new name, replaces nothing.
fn put(new: &Path, file: &Path) -> Result<(), BackupError> {
    match fs::hard_link(new, file) {
        Ok(()) => Ok(()),
        Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {
            Err(BackupError::Exists(file.to_owned()))
        }
        // Some file systems have no links.
        Err(_) => fs::rename(new, file).map_err(BackupError::at(file)),
    }
}

/// What there is to copy, the head of the audit before its records.
fn names(data: &Path, with_history: bool) -> Result<Vec<String>, BackupError> {
    let mut names: Vec<String> = FILES.iter().map(ToString::to_string).collect();
    for entry in fs::read_dir(data).map_err(BackupError::at(data))? {
        let name = entry.map_err(BackupError::at(data))?.file_name().into_string().unwrap_or_default();
        if is_known(&name) && !names.contains(&name) {
            names.push(name);
        }
    }
    names.retain(|name| data.join(name).is_file() && (with_history || name != "history.sqlite"));
    Ok(names)
}

fn entry(name: String, path: &Path) -> Result<Entry, BackupError> {
    let mut file = Hashed::new(File::open(path).map_err(BackupError::at(path))?);
    let bytes = io::copy(&mut file, &mut io::sink()).map_err(BackupError::at(path))?;
    Ok(Entry { name, bytes, sha256: file.sha256() })
}

fn pack(folder: &Path, manifest: &Manifest, to: &Path) -> io::Result<()> {
    let mut archive = tar::Builder::new(make_file(to)?);
    let text = serde_json::to_vec_pretty(manifest)?;
    archive.append_data(&mut header(text.len() as u64), MANIFEST, text.as_slice())?;
    for entry in &manifest.files {
        let file = File::open(folder.join(&entry.name))?;
        archive.append_data(&mut header(entry.bytes), &entry.name, file)?;
    }
    archive.into_inner()?.sync_all()
}

fn header(bytes: u64) -> tar::Header {
    let mut header = tar::Header::new_gnu();
    header.set_size(bytes);
    header.set_mode(0o600);
    header
}
