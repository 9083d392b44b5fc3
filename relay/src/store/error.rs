//! What can go wrong with the database.

use crate::project::FilesError;

/// Why a block could not be read or written.
#[derive(Debug, thiserror::Error)]
pub(crate) enum StoreError {
    /// The folder cannot be made.
    #[error("cannot make the data folder: {0}")]
    Folder(#[source] std::io::Error),
    /// Another process has it open.
    #[error("another relay uses this data folder")]
    InUse,
    /// The thread for the database cannot be started.
    #[error("cannot start the database's thread: {0}")]
    Thread(#[source] std::io::Error),
    /// SQLite says no.
    #[error("the database failed: {0}")]
    Sqlite(#[source] rusqlite::Error),
    /// A newer cipdeck has written it.
    #[error("the database has version {found}, this cipdeck knows {known}: use a newer cipdeck")]
    TooNew {
        /// What the file says.
        found: usize,
        /// What we can read.
        known: usize,
    },
    /// A configuration that is no JSON any more.
    #[error("something that was stored cannot be read: {0}")]
    Json(#[from] serde_json::Error),
    /// The files of the project.
    #[error("{0}")]
    Files(#[source] FilesError),
    /// A project that does not fit beside what is there.
    #[error("{0}")]
    TooMany(String),
    /// The system gives no random numbers.
    #[error("{0}")]
    Secrets(String),
    /// More than four billion blocks.
    #[error("all ids are used up")]
    NoIds,
    /// The writer thread has ended.
    #[error("the database is closed")]
    Closed,
}

impl From<rusqlite::Error> for StoreError {
    fn from(error: rusqlite::Error) -> Self {
        match error.sqlite_error_code() {
            Some(rusqlite::ErrorCode::DatabaseBusy | rusqlite::ErrorCode::DatabaseLocked) => Self::InUse,
            _ => Self::Sqlite(error),
        }
    }
}
