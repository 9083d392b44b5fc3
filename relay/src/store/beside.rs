//! What is kept beside the database, with every change of it: the files of a project.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, OnceLock};

use cipdeck_shared::config::project::{self as files, Project};
use rusqlite::{Connection, Transaction};

use super::project::change;
use super::{Store, StoreError};
use crate::project::{self, Folder, How, Mirror, Outcome, Touched};
use crate::runner::lock;
use crate::store::{Scope, load_project};

/// The files of the project, if there is one.
#[derive(Clone, Debug, Default)]
pub(super) struct Beside(Arc<OnceLock<Mutex<Mirror>>>);

impl Beside {
    /// Writes the files of what was touched and ends the transaction: both, or neither.
    pub(super) fn commit(&self, transaction: Transaction<'_>, touched: &[Touched]) -> Result<(), StoreError> {
        match self.0.get() {
            Some(mirror) => lock(mirror).commit(transaction, touched),
            None => Ok(transaction.commit()?),
        }
    }
}

impl Store {
    /// The folder is the truth: what is stored becomes what it says, and from now on it is kept with every change. Where it
    /// is kept already it has been read again. A preview tells what that would do.
    pub(crate) async fn join(
        &self,
        folder: Folder,
        read: files::Read,
        is_preview: bool,
    ) -> Result<Outcome, StoreError> {
        let beside = self.1.clone();
        self.0
            .call(move |connection| {
                if is_preview {
                    return Mirror::look(connection, &folder, &read.project);
                }
                let (mirror, outcome) = Mirror::join(connection, folder, &read)?;
                match beside.0.get() {
                    Some(there) => *lock(there) = mirror,
                    None => drop(beside.0.set(Mutex::new(mirror))),
                }
                Ok(outcome)
            })
            .await
    }

    /// What the last change was called that was written to several files and stored: [`Folder::repair`] needs it.
    pub(crate) async fn last_change(&self) -> Result<Option<String>, StoreError> {
        self.0.call(|connection| change(connection)).await
    }

    /// The files of the project: those of the folder, where there is one.
    pub(crate) async fn files(&self) -> Result<BTreeMap<String, String>, StoreError> {
        let beside = self.1.clone();
        self.0
            .call(move |connection| {
                if let Some(mirror) = beside.0.get() {
                    return Ok(lock(mirror).files());
                }
                let stored = load_project(connection, Scope::All)?;
                Ok(files::files(&project::project_of(&stored)))
            })
            .await
    }

    /// Takes in a project, or tells what that would do.
    pub(crate) async fn merge(&self, project: Project, is_preview: bool) -> Result<Outcome, StoreError> {
        let beside = self.1.clone();
        self.0
            .call(move |connection: &mut Connection| {
                let transaction = connection.transaction()?;
                let outcome = project::merge(&transaction, &project, How::Import)?;
                if !is_preview {
                    beside.commit(transaction, &outcome.touched)?;
                }
                Ok(outcome)
            })
            .await
    }
}
