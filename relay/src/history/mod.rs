//! Every run of every block, in a database of its own.
//!
//! Whoever ends a run only adds it to a bounded buffer; a thread takes everything that is there four times a second and
//! writes it in one transaction. So a full or slow disk costs history, and says so, but never a run. Readers have
//! connections of their own, which do not keep the thread from writing.

mod buffer;
mod chunk;
mod csv;
mod dropped;
mod limits;
mod page;
mod run;
mod schema;
mod trend;
mod values;
mod writer;

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::thread;

use cipdeck_shared::api::{HistoryHealth, HistoryPage, HistoryState, HistoryTrend};
use rusqlite::{Connection, OptionalExtension};
use tokio::sync::{Semaphore, watch};

use self::buffer::Buffer;
pub(crate) use self::buffer::Recorder;
pub(crate) use self::csv::{HEADER as CSV_HEADER, line as csv_line};
use self::dropped::Dropped;
use self::limits::Limits;
pub(crate) use self::page::{Asked, Place};
use self::schema::from_sql;
pub(crate) use self::trend::Chart;
use self::writer::{Shared, Writer};
use crate::runner::lock;
use crate::settings::HistorySettings;
use crate::wall_clock;

/// Name of the database in the data folder.
const DATABASE: &str = "history.sqlite";

/// Readers at a time: one who asks for much must not take the whole machine.
const READERS: usize = 2;

/// Handle to the history. Clones share it.
#[derive(Clone, Debug)]
pub(crate) struct History(Arc<Inner>);

#[derive(Debug)]
struct Inner {
    settings: HistorySettings,
    file: Option<File>,
}

/// What there is when runs are kept.
#[derive(Debug)]
struct File {
    path: PathBuf,
    buffer: Arc<Buffer>,
    shared: Arc<Shared>,
    readers: Arc<Semaphore>,
    /// TRUE when the thread has ended.
    ended: watch::Receiver<bool>,
}

/// Why there is no answer.
#[derive(Debug, thiserror::Error)]
pub(crate) enum HistoryError {
    /// SQLite says no.
    #[error("the history cannot be read: {0}")]
    Sqlite(#[from] rusqlite::Error),
    /// The relay is stopping.
    #[error("the history is closed")]
    Closed,
}

impl History {
    /// Starts the thread, which opens or makes the database in `folder`. Without a folder nothing is kept. Whatever is
    /// wrong with the file or the disk, the relay starts.
    pub(crate) async fn open(folder: Option<&Path>, settings: HistorySettings) -> Self {
        let folder = folder.filter(|_| settings.enabled);
        let file = match folder {
            Some(folder) => start(folder.join(DATABASE), Limits::of(&settings)).await,
            None => None,
        };
        Self(Arc::new(Inner { settings, file }))
    }

    /// Where runs are handed over.
    pub(crate) fn recorder(&self) -> Recorder {
        Recorder(self.0.file.as_ref().map(|file| Arc::clone(&file.buffer)))
    }

    /// Runs, the newest first, at most so many, before a place.
    pub(crate) async fn page(
        &self,
        asked: Asked,
        limit: usize,
        before: Option<Place>,
    ) -> Result<HistoryPage, HistoryError> {
        self.read(HistoryPage::default, move |connection, pending| {
            page::page(connection, pending, &asked, (limit, before))
        })
        .await
    }

    /// Runs of one block, summed up.
    pub(crate) async fn trend(&self, chart: Chart) -> Result<HistoryTrend, HistoryError> {
        let (block, (from, to)) = (chart.block, chart.between);
        let empty = move || HistoryTrend {
            block,
            from: wall_clock::of_micros(from),
            to: wall_clock::of_micros(to),
            bucket_us: to - from,
            value: None,
            values: Vec::new(),
            buckets: Vec::new(),
            complete: true,
            dropped: Vec::new(),
        };
        self.read(empty, move |connection, pending| trend::trend(connection, pending, chart)).await
    }

    /// How much there is, and what is missing.
    pub(crate) async fn state(&self) -> Result<HistoryState, HistoryError> {
        let HistorySettings { max_mb, max_days, .. } = self.0.settings;
        let enabled = self.0.file.is_some();
        let problem = self.0.file.as_ref().and_then(|file| lock(&file.shared.problem).clone());
        let state = HistoryState { enabled, problem, max_mb, max_days, ..HistoryState::default() };
        let failed = HistoryState { problem: state.problem.clone(), ..state.clone() };
        let read = self.read(HistoryState::default, state_of).await;
        match read {
            Ok(HistoryState { runs, bytes, oldest, newest, dropped, .. }) => {
                Ok(HistoryState { runs, bytes, oldest, newest, dropped, ..state })
            }
            // It has said already what is wrong.
            Err(HistoryError::Sqlite(_)) if failed.problem.is_some() => Ok(failed),
            Err(error) => Err(error),
        }
    }

    /// Whether it works.
    pub(crate) fn health(&self) -> HistoryHealth {
        let Some(file) = &self.0.file else { return HistoryHealth::default() };
        let recording = lock(&file.shared.problem).is_none();
        HistoryHealth { recording, lost: file.shared.lost.load(Ordering::Relaxed) }
    }

    /// How many runs wait to be written.
    pub(crate) fn waiting(&self) -> usize {
        self.0.file.as_ref().map_or(0, |file| file.buffer.len())
    }

    /// Whether runs should be kept at all.
    pub(crate) fn is_on(&self) -> bool {
        self.0.file.is_some()
    }

    /// Returns when everything that was handed over has been written, or is known to be lost.
    pub(crate) async fn close(&self) {
        if let Some(file) = &self.0.file {
            file.buffer.close();
            // An error: the thread is gone.
            let _ = file.ended.clone().wait_for(|ended| *ended).await;
        }
    }

    async fn read<T: Send + 'static>(
        &self,
        nothing: impl FnOnce() -> T,
        call: impl FnOnce(&Connection, &[Dropped]) -> rusqlite::Result<T> + Send + 'static,
    ) -> Result<T, HistoryError> {
        let Some(file) = &self.0.file else { return Ok(nothing()) };
        let reader = Arc::clone(&file.readers).acquire_owned().await.map_err(|_| HistoryError::Closed)?;
        let (path, pending) = (file.path.clone(), lock(&file.shared.pending).clone());
        let read = tokio::task::spawn_blocking(move || {
            // Held to the end, also when nobody waits any more.
            let _reader = reader;
            let mut connection = schema::open_to_read(&path)?;
            // One moment for everything.
            let transaction = connection.transaction()?;
            call(&transaction, &pending)
        });
        Ok(read.await.map_err(|_| HistoryError::Closed)??)
    }
}

async fn start(path: PathBuf, limits: Limits) -> Option<File> {
    let (buffer, shared) = (Arc::new(Buffer::default()), Arc::new(Shared::default()));
    let (ends, ended) = watch::channel(false);
    let (opens, opened) = tokio::sync::oneshot::channel();
    let run = {
        let (path, buffer, shared) = (path.clone(), Arc::clone(&buffer), Arc::clone(&shared));
        move || {
            let writer = Writer::new(path, limits, shared);
            let _ = opens.send(());
            writer.run(&buffer);
            ends.send_replace(true);
        }
    };
    if let Err(error) = thread::Builder::new().name("history".to_owned()).spawn(run) {
        tracing::error!(%error, "no thread for the history: nothing is kept");
        return None;
    }
    // Whether it could be opened or not: it is tried again with each batch.
    let _ = opened.await;
    Some(File { path, buffer, shared, readers: Arc::new(Semaphore::new(READERS)), ended })
}

fn state_of(connection: &Connection, pending: &[Dropped]) -> rusqlite::Result<HistoryState> {
    let runs = connection.query_row("SELECT runs FROM total", (), |row| row.get(0).map(from_sql))?;
    let time = |statement: &str| {
        let time = connection.query_row(statement, (), |row| row.get(0).map(from_sql)).optional();
        time.map(|time| time.map(wall_clock::of_micros))
    };
    Ok(HistoryState {
        runs,
        bytes: limits::used(connection)?,
        oldest: time("SELECT first_us FROM chunk ORDER BY id LIMIT 1")?,
        newest: time("SELECT last_us FROM chunk ORDER BY id DESC LIMIT 1")?,
        dropped: dropped::between(connection, pending, (0, u64::MAX))?,
        ..HistoryState::default()
    })
}

#[cfg(test)]
mod tests;
