//! Blocks, devices, users, tokens and lists in SQLite, on one writer thread: SQLite has one writer, so the code says so.
//!
//! Nothing that was acknowledged is lost, not even by `kill -9`: WAL with `synchronous = FULL`.

mod access;
mod allow;
mod beside;
mod blocks;
mod error;
mod lock;
mod plant;
mod project;
mod schema;
mod writer;

use std::path::Path;

pub(crate) use self::access::{PassKind, StoredPass, StoredUser};
pub(crate) use self::allow::StoredLists;
use self::beside::Beside;
pub(crate) use self::blocks::Change;
pub(crate) use self::error::StoreError;
pub(crate) use self::plant::{Fresh, StoredPlant};
pub(crate) use self::project::{
    Scope, StoredBlock, StoredGroup, StoredProject, StoredTarget, Table, load_project, put_change, put_head,
};
pub(crate) use self::schema::migrate;
use self::writer::Writer;

/// Handle to the database. Clones share it.
#[derive(Clone, Debug)]
pub(crate) struct Store(Writer, Beside);

impl Store {
    /// Opens or makes the database; without a path it lives in memory.
    pub(crate) async fn open(path: Option<&Path>) -> Result<Self, StoreError> {
        let writer = Writer::start(path.map(Path::to_owned)).await?;
        Ok(Self(writer, Beside::default()))
    }

    /// Waits until everything that was asked for has been written, and closes the database for all handles.
    pub(crate) async fn close(&self) {
        self.0.close().await;
    }
}
