//! The thread that owns the database.

use std::path::{Path, PathBuf};
use std::thread;

use rusqlite::Connection;
use tokio::sync::{mpsc, oneshot};

use super::lock::Lock;
use super::{StoreError, schema};
use crate::private;

/// Work that waits. More of it makes the askers wait, not the memory grow.
const QUEUE: usize = 64;

enum Work {
    Call(Box<dyn FnOnce(&mut Connection) + Send>),
    Close(oneshot::Sender<()>),
}

/// Handle to the thread.
#[derive(Clone, Debug)]
pub(super) struct Writer(mpsc::Sender<Work>);

impl Writer {
    /// Starts the thread, which opens the database.
    pub(super) async fn start(path: Option<PathBuf>) -> Result<Self, StoreError> {
        let (sender, mut work) = mpsc::channel::<Work>(QUEUE);
        let (opened, is_open) = oneshot::channel();
        let run = move || {
            let (mut connection, lock) = match open(path.as_deref()) {
                Ok(opened) => opened,
                Err(error) => {
                    let _ = opened.send(Err(error));
                    return;
                }
            };
            let _ = opened.send(Ok(()));
            let closed = loop {
                match work.blocking_recv() {
                    Some(Work::Call(call)) => call(&mut connection),
                    Some(Work::Close(closed)) => break Some(closed),
                    None => break None,
                }
            };
            if let Err((_, error)) = connection.close() {
                tracing::error!(%error, "the database was not closed properly");
            }
            drop(lock);
            if let Some(closed) = closed {
                let _ = closed.send(());
            }
        };
        thread::Builder::new().name("store".to_owned()).spawn(run).map_err(StoreError::Thread)?;
        is_open.await.map_err(|_| StoreError::Closed)??;
        Ok(Self(sender))
    }

    /// Runs on the thread, after everything that was asked for before.
    pub(super) async fn call<T: Send + 'static>(
        &self,
        call: impl FnOnce(&mut Connection) -> Result<T, StoreError> + Send + 'static,
    ) -> Result<T, StoreError> {
        let (sender, result) = oneshot::channel();
        let work = Box::new(move |connection: &mut Connection| {
            // Nobody may wait any more; the work is done all the same.
            let _ = sender.send(call(connection));
        });
        self.0.send(Work::Call(work)).await.map_err(|_| StoreError::Closed)?;
        result.await.map_err(|_| StoreError::Closed)?
    }

    /// Returns when the thread has closed the database.
    pub(super) async fn close(&self) {
        let (sender, closed) = oneshot::channel();
        if self.0.send(Work::Close(sender)).await.is_ok() {
            let _ = closed.await;
        }
    }
}

fn open(path: Option<&Path>) -> Result<(Connection, Option<Lock>), StoreError> {
    let lock = path.and_then(Path::parent).map(Lock::take).transpose()?;
    let mut connection = match path {
        Some(path) => {
            private::file(path).map_err(StoreError::Folder)?;
            Connection::open(path)?
        }
        None => Connection::open_in_memory()?,
    };
    schema::prepare(&mut connection)?;
    Ok((connection, lock))
}
