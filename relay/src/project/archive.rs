//! A project as one file: a zip archive, as every system opens it.

use std::collections::BTreeMap;
use std::io::{Cursor, Read, Write};

use cipdeck_shared::config::project::{MAX_PROJECT_BYTES, MAX_PROJECT_FILE, MAX_PROJECT_FILES, PROJECT_HEAD};
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipArchive, ZipWriter};

use super::walk::{is_json, text};

/// Bytes of an archive that is sent to us. Our own limit: packed, a project is a tenth of its size.
pub(crate) const MAX_ARCHIVE: usize = 16 * 1024 * 1024;

/// Why an archive is not taken.
#[derive(Debug, thiserror::Error)]
pub(crate) enum ArchiveError {
    /// Not a zip archive, or a broken one.
    #[error("this is not a zip archive that can be read: {0}")]
    Zip(String),
    /// One file of it.
    #[error("{file:?} in the archive {why}")]
    File {
        /// Which file.
        file: String,
        /// What about it.
        why: String,
    },
    /// Too much of something.
    #[error(
        "the archive has too much in it: at most {MAX_PROJECT_FILES} files, {MAX_PROJECT_FILE} bytes each, {MAX_PROJECT_BYTES} together"
    )]
    TooMuch,
}

/// The files as an archive; the same files give the same bytes.
pub(crate) fn pack(files: &BTreeMap<String, String>) -> Result<Vec<u8>, ArchiveError> {
    let packed = || {
        let mut archive = ZipWriter::new(Cursor::new(Vec::new()));
        // Without a time: a project knows none.
        let options = SimpleFileOptions::default()
            .compression_method(CompressionMethod::Deflated)
            .last_modified_time(zip::DateTime::default())
            .unix_permissions(0o644);
        for (path, text) in files {
            archive.start_file(path.as_str(), options)?;
            archive.write_all(text.as_bytes())?;
        }
        archive.finish().map(Cursor::into_inner)
    };
    packed().map_err(|error| ArchiveError::Zip(error.to_string()))
}

/// The files of an archive, and the names of those that cannot belong to a project.
pub(crate) fn unpack(bytes: &[u8]) -> Result<(BTreeMap<String, String>, Vec<String>), ArchiveError> {
    let broken = |error: zip::result::ZipError| ArchiveError::Zip(error.to_string());
    let mut archive = ZipArchive::new(Cursor::new(bytes)).map_err(broken)?;
    if archive.has_duplicate_names() {
        return Err(ArchiveError::Zip("two files have the same name".to_owned()));
    }
    // Folders and what is none of the project's count, too.
    if archive.len() > 2 * MAX_PROJECT_FILES {
        return Err(ArchiveError::TooMuch);
    }
    let (mut files, mut ignored) = (BTreeMap::new(), Vec::new());
    let mut room = MAX_PROJECT_BYTES;
    for place in 0..archive.len() {
        let entry = archive.by_index_data(place).map_err(broken)?;
        let name = entry.name().map_err(broken)?.into_owned();
        let wrong = |why: &str| ArchiveError::File { file: name.clone(), why: why.to_owned() };
        check_path(&name).map_err(wrong)?;
        if entry.unix_mode().is_some_and(|mode| mode & 0o170_000 == 0o120_000) {
            return Err(wrong("is a link, and a project has none"));
        }
        if entry.encrypted() {
            return Err(wrong("is encrypted"));
        }
        if name.ends_with('/') {
            continue;
        }
        if !is_json(&name) || name.split('/').any(|step| step.starts_with('.')) {
            ignored.push(name);
            continue;
        }
        let mut bytes = Vec::new();
        let file = archive.by_index(place).map_err(broken)?;
        // What the archive says of sizes is not believed.
        let most = MAX_PROJECT_FILE.min(room) as u64 + 1;
        file.take(most)
            .read_to_end(&mut bytes)
            .map_err(|error| wrong(&format!("cannot be read: {error}")))?;
        if bytes.len() as u64 == most || files.len() == MAX_PROJECT_FILES {
            return Err(ArchiveError::TooMuch);
        }
        room -= bytes.len();
        let text = text(bytes)
            .map_err(|place| wrong(&format!("is not UTF-8, from {}:{} on", place.line, place.column)))?;
        files.insert(name, text);
    }
    Ok((without_wrapping(files), ignored))
}

/// A name that stays inside of wherever it is put, on every system.
fn check_path(path: &str) -> Result<(), &'static str> {
    let path = path.strip_suffix('/').unwrap_or(path);
    let is_step = |step: &str| !matches!(step, "" | "." | "..");
    if path.split('/').all(is_step) && !path.contains(['\\', ':']) && !path.contains(char::is_control) {
        Ok(())
    } else {
        Err("has a path that leaves the project, or that some system cannot have")
    }
}

/// Archives of version control put everything into one folder.
fn without_wrapping(files: BTreeMap<String, String>) -> BTreeMap<String, String> {
    let first =
        files.keys().next().and_then(|path| path.split_once('/')).map(|(folder, _)| format!("{folder}/"));
    let Some(folder) = first.filter(|folder| files.contains_key(&format!("{folder}{PROJECT_HEAD}"))) else {
        return files;
    };
    let inside: Option<BTreeMap<_, _>> = files
        .iter()
        .map(|(path, text)| Some((path.strip_prefix(&folder)?.to_owned(), text.clone())))
        .collect();
    inside.unwrap_or(files)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn files(all: &[(&str, &str)]) -> BTreeMap<String, String> {
        all.iter().map(|(path, text)| ((*path).to_owned(), (*text).to_owned())).collect()
    }

    fn archive(all: &[(&str, &[u8])]) -> Vec<u8> {
        let mut archive = ZipWriter::new(Cursor::new(Vec::new()));
        for (path, bytes) in all {
            archive.start_file(*path, SimpleFileOptions::default()).unwrap();
            archive.write_all(bytes).unwrap();
        }
        archive.finish().unwrap().into_inner()
    }

    #[test]
    fn what_is_packed_is_unpacked_and_always_the_same_bytes() {
        let there = files(&[("cipdeck.json", "{\"project\":1}"), ("blocks/ä.json", "{}")]);
        let packed = pack(&there).unwrap();
        assert_eq!(pack(&there).unwrap(), packed);
        assert_eq!(unpack(&packed).unwrap(), (there, Vec::new()));
    }

    #[test]
    fn the_one_folder_of_an_archive_of_version_control_is_no_part_of_it() {
        let packed = archive(&[
            ("plant-main/cipdeck.json", b"{}"),
            ("plant-main/blocks/x.json", b"1"),
            ("plant-main/README.md", b"x"),
        ]);
        let (found, ignored) = unpack(&packed).unwrap();
        assert_eq!(found, files(&[("cipdeck.json", "{}"), ("blocks/x.json", "1")]));
        assert_eq!(ignored, ["plant-main/README.md"]);
    }

    #[test]
    fn what_could_do_harm_is_refused_by_name() {
        for path in
            ["../x.json", "/etc/x.json", "blocks/../../x.json", "C:/x.json", "blocks\\x.json", "a//b.json"]
        {
            let refused = unpack(&archive(&[(path, b"{}")])).unwrap_err().to_string();
            assert!(refused.contains("leaves the project"), "{path}: {refused}");
        }
        let mut linked = ZipWriter::new(Cursor::new(Vec::new()));
        linked.add_symlink("blocks/x.json", "/etc/passwd", SimpleFileOptions::default()).unwrap();
        let refused = unpack(&linked.finish().unwrap().into_inner()).unwrap_err().to_string();
        assert!(refused.contains("is a link"), "{refused}");
        let refused = unpack(&archive(&[("blocks/x.json", b"{\n \"\xFF\"")])).unwrap_err().to_string();
        assert!(refused.contains("is not UTF-8, from 2:3 on"), "{refused}");
        for bytes in [&b""[..], b"PK", b"no archive at all", &pack(&files(&[("a.json", "x")])).unwrap()[..40]]
        {
            assert!(matches!(unpack(bytes), Err(ArchiveError::Zip(_))), "{bytes:?}");
        }
    }

    #[test]
    fn a_bomb_does_not_go_off() {
        let zeros = vec![b' '; MAX_PROJECT_FILE + 1];
        let one = archive(&[("blocks/x.json", &zeros)]);
        assert!(one.len() < 100_000, "{}", one.len());
        assert!(matches!(unpack(&one), Err(ArchiveError::TooMuch)));
        let many: Vec<_> = (0..9).map(|number| format!("blocks/{number}.json")).collect();
        let all: Vec<_> = many.iter().map(|path| (path.as_str(), &zeros[..MAX_PROJECT_FILE])).collect();
        assert!(matches!(unpack(&archive(&all)), Err(ArchiveError::TooMuch)));
    }
}
