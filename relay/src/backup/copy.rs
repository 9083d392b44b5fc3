//! Copies of the parts of a data folder, each as of one moment, while a relay may be writing.

use std::fs::{self, File};
use std::io::{self, Read, Seek, SeekFrom};
use std::path::Path;
use std::time::Duration;

use rusqlite::{Connection, OpenFlags};

use super::{BackupError, make_file, make_folder};

/// How long a database may be busy: a checkpoint, or a relay that starts.
const PATIENCE: Duration = Duration::from_secs(10);

/// Bytes that are read at once when the end of a line is looked for.
const STEP: u64 = 64 * 1024;

/// Copies a database as of one transaction. Writers are not kept waiting.
pub(super) fn database(from: &Path, to: &Path) -> Result<(), BackupError> {
    let failed = |source| BackupError::Sqlite { path: from.to_owned(), source };
    let flags = OpenFlags::SQLITE_OPEN_READ_WRITE | OpenFlags::SQLITE_OPEN_NO_MUTEX;
    let connection = Connection::open_with_flags(from, flags).map_err(failed)?;
    connection.busy_timeout(PATIENCE).map_err(failed)?;
    let target = to.to_string_lossy();
    connection.execute("VACUUM INTO ?1", [target.as_ref()]).map_err(failed)?;
    Ok(())
}

/// Copies the records that are whole. The head has to be copied before: what is appended meanwhile comes after it.
pub(super) fn records(from: &Path, to: &Path) -> Result<(), BackupError> {
    let mut source = File::open(from).map_err(BackupError::at(from))?;
    let end = last_line_end(&mut source).map_err(BackupError::at(from))?;
    source.seek(SeekFrom::Start(0)).map_err(BackupError::at(from))?;
    let mut target = make_file(to).map_err(BackupError::at(to))?;
    io::copy(&mut source.take(end), &mut target).map_err(BackupError::at(to))?;
    Ok(())
}

/// Copies a small file, which is replaced and never changed.
pub(super) fn file(from: &Path, to: &Path) -> Result<(), BackupError> {
    if let Some(folder) = to.parent()
        && !folder.exists()
    {
        make_folder(folder).map_err(BackupError::at(folder))?;
    }
    let bytes = fs::read(from).map_err(BackupError::at(from))?;
    let mut target = make_file(to).map_err(BackupError::at(to))?;
    io::Write::write_all(&mut target, &bytes).map_err(BackupError::at(to))
}

/// Behind the last line feed.
fn last_line_end(file: &mut File) -> io::Result<u64> {
    let mut start = file.metadata()?.len();
    while start > 0 {
        let step = STEP.min(start);
        start -= step;
        file.seek(SeekFrom::Start(start))?;
        let mut bytes = Vec::new();
        file.take(step).read_to_end(&mut bytes)?;
        if let Some(at) = bytes.iter().rposition(|byte| *byte == b'\n') {
            return Ok(start + at as u64 + 1);
        }
    }
    Ok(0)
}
