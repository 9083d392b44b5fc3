//! The file: opened, brought up to date, or set aside.

use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

use rusqlite::{Connection, ErrorCode, OpenFlags};

use crate::private;
use crate::store::{StoreError, migrate};
use crate::wall_clock;

/// One entry per version; `user_version` counts them.
const MIGRATIONS: [&str; 1] = [include_str!("migrations/0001_history.sql")];

/// How long a reader may keep the file from being rearranged.
const PATIENCE: Duration = Duration::from_secs(1);

/// Bytes of the write-ahead log that are kept for the next time.
const MAX_LOG: i64 = 16 * 1024 * 1024;

/// A connection that writes, and where a file went that could not be used.
#[derive(Debug)]
pub(super) struct Opened {
    pub(super) connection: Connection,
    pub(super) aside: Option<Aside>,
}

/// A file that could not be used.
#[derive(Clone, Debug)]
pub(super) struct Aside {
    pub(super) to: PathBuf,
    pub(super) why: String,
}

/// Opens or makes the database. A file that cannot be read, or that a newer cipdeck has written, is set aside: history
/// is not worth keeping a plant's relay from starting.
pub(super) fn open(path: &Path) -> Result<Opened, StoreError> {
    match prepare(path) {
        Ok(connection) => Ok(Opened { connection, aside: None }),
        Err(error) if is_broken(&error) => open_anew(path, error.to_string()),
        Err(error) => Err(error),
    }
}

/// Sets the file aside and makes a new one.
pub(super) fn open_anew(path: &Path, why: String) -> Result<Opened, StoreError> {
    let to = set_aside(path).map_err(StoreError::Folder)?;
    tracing::error!(file = %path.display(), aside = %to.display(), error = why, "the history cannot be used and was set aside");
    Ok(Opened { connection: prepare(path)?, aside: Some(Aside { to, why }) })
}

/// A connection that only reads, beside the one that writes.
pub(super) fn open_to_read(path: &Path) -> rusqlite::Result<Connection> {
    let flags = OpenFlags::SQLITE_OPEN_READ_ONLY | OpenFlags::SQLITE_OPEN_NO_MUTEX;
    let connection = Connection::open_with_flags(path, flags)?;
    connection.busy_timeout(PATIENCE)?;
    Ok(connection)
}

/// Whether the file itself is the problem when it is opened, and not the disk.
fn is_broken(error: &StoreError) -> bool {
    match error {
        StoreError::TooNew { .. } => true,
        // A table that is missing, or one too many: somebody else's database.
        StoreError::Sqlite(error) if error.sqlite_error_code() == Some(ErrorCode::Unknown) => true,
        error => is_corrupt(error),
    }
}

/// Whether SQLite has found bytes that make no sense.
pub(super) fn is_corrupt(error: &StoreError) -> bool {
    let StoreError::Sqlite(error) = error else { return false };
    matches!(error.sqlite_error_code(), Some(ErrorCode::DatabaseCorrupt | ErrorCode::NotADatabase))
}

fn prepare(path: &Path) -> Result<Connection, StoreError> {
    private::file(path).map_err(StoreError::Folder)?;
    let mut connection = Connection::open(path)?;
    connection.busy_timeout(PATIENCE)?;
    // Takes effect in a new file only.
    connection.pragma_update(None, "auto_vacuum", "INCREMENTAL")?;
    connection.pragma_update(None, "journal_mode", "WAL")?;
    connection.pragma_update(None, "journal_size_limit", MAX_LOG)?;
    // A power failure may cost the last seconds, `kill -9` nothing that was committed.
    connection.pragma_update(None, "synchronous", "NORMAL")?;
    migrate(&mut connection, &MIGRATIONS)?;
    // A table that is missing or a page that is broken at the beginning shows here, not at the first write.
    connection.query_row("SELECT runs FROM total", (), |_| Ok(()))?;
    connection.query_row("SELECT max(id), max(batch) FROM chunk", (), |_| Ok(()))?;
    Ok(connection)
}

fn set_aside(path: &Path) -> std::io::Result<PathBuf> {
    let stamp = wall_clock::micros(SystemTime::now());
    let name = |suffix: &str| {
        let mut name = path.file_name().unwrap_or_default().to_os_string();
        name.push(suffix);
        path.with_file_name(name)
    };
    let aside = name(&format!(".aside-{stamp}"));
    std::fs::rename(path, &aside)?;
    // The log belongs to the file; with another one it would be another accident.
    for suffix in ["-wal", "-shm"] {
        let _ = std::fs::rename(name(suffix), name(&format!(".aside-{stamp}{suffix}")));
    }
    Ok(aside)
}

/// SQLite counts with a sign.
pub(super) fn to_sql(number: u64) -> i64 {
    i64::try_from(number).unwrap_or(i64::MAX)
}

/// What [`to_sql`] has written.
pub(super) fn from_sql(number: i64) -> u64 {
    u64::try_from(number).unwrap_or_default()
}
