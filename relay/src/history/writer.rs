//! The thread that writes: everything that has ended meanwhile in one transaction, then what has become too much or
//! too old goes.

use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::path::PathBuf;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex};
use std::time::{Duration, SystemTime};

use cipdeck_shared::api::HistoryLoss;
use cipdeck_shared::config::BlockId;
use rusqlite::{Connection, Transaction};

use super::buffer::{Buffer, Span};
use super::chunk::Chunk;
use super::dropped::Dropped;
use super::limits::Limits;
use super::run::Run;
use super::schema::{self, Aside, Opened, to_sql};
use crate::runner::lock;
use crate::store::StoreError;
use crate::wall_clock;

/// How long runs wait for others before they are written together. `kill -9` loses them, so this is much less than the
/// second that it may cost.
const PACE: Duration = Duration::from_millis(250);

/// How often the thread looks at the clock while nothing ends.
const IDLE: Duration = Duration::from_mins(1);

/// Requests whose number is remembered.
const MAX_REQUESTS: usize = 4_096;

/// A request's last use is written down when the one that is written down is so many batches old.
const USED_EVERY: u64 = 10_000;

/// What readers need to know of the thread.
#[derive(Debug, Default)]
pub(super) struct Shared {
    /// Losses that are not written down yet.
    pub(super) pending: Mutex<Vec<Dropped>>,
    /// Why nothing can be written at this moment.
    pub(super) problem: Mutex<Option<String>>,
    /// Runs lost since the start, other than by a limit.
    pub(super) lost: AtomicU64,
}

/// The database, and what the thread remembers of it.
#[derive(Debug)]
pub(super) struct Writer {
    path: PathBuf,
    limits: Limits,
    shared: Arc<Shared>,
    open: Option<Open>,
    /// Why the file is to be set aside.
    spoiled: Option<String>,
}

#[derive(Debug)]
struct Open {
    connection: Connection,
    batch: u64,
    requests: HashMap<Arc<[u8]>, Known>,
}

/// A request that has a number.
#[derive(Clone, Copy, Debug)]
struct Known {
    id: i64,
    used: u64,
}

impl Writer {
    /// Opens the file, if that is possible now; otherwise with the next runs.
    pub(super) fn new(path: PathBuf, limits: Limits, shared: Arc<Shared>) -> Self {
        let mut writer = Self { path, limits, shared, open: None, spoiled: None };
        let opened = writer.opened().map(drop);
        writer.note(opened.as_ref().err());
        writer
    }

    /// Writes until the buffer is closed.
    pub(super) fn run(mut self, buffer: &Buffer) {
        let mut empty = Vec::new();
        loop {
            let taken = buffer.take(IDLE, PACE, empty);
            if let Some(span) = taken.lost {
                self.lose(HistoryLoss::Queue, span, None);
            }
            self.write(&taken.runs);
            if taken.closed {
                break;
            }
            empty = taken.runs;
            empty.clear();
        }
    }

    /// Writes runs, or writes down that they are lost.
    pub(super) fn write(&mut self, runs: &[Run]) {
        let result = self.try_write(runs);
        if let Err(error) = &result {
            if let Some(span) = Span::of_all(runs) {
                self.lose(HistoryLoss::Disk, span, Some(error.to_string()));
            }
            if schema::is_corrupt(error) {
                (self.open, self.spoiled) = (None, Some(error.to_string()));
            }
            if let Some(open) = &mut self.open {
                // The numbers may have been rolled back.
                open.requests.clear();
            }
        }
        self.note(result.as_ref().err());
    }

    fn try_write(&mut self, runs: &[Run]) -> Result<(), StoreError> {
        let (shared, limits) = (Arc::clone(&self.shared), self.limits);
        let open = self.opened()?;
        let pending = lock(&shared.pending).clone();
        if !runs.is_empty() || !pending.is_empty() {
            open.write(runs, &pending)?;
            // Only this thread adds to them.
            lock(&shared.pending).clear();
        }
        let now = wall_clock::micros(SystemTime::now());
        limits.enforce(&mut open.connection, now)?;
        Ok(())
    }

    fn opened(&mut self) -> Result<&mut Open, StoreError> {
        if self.open.is_none() {
            let Opened { connection, aside } = match self.spoiled.take() {
                Some(why) => schema::open_anew(&self.path, why)?,
                None => schema::open(&self.path)?,
            };
            if let Some(aside) = aside {
                self.set_aside(&aside);
            }
            let batch =
                connection.query_row("SELECT ifnull(max(batch), 0) FROM chunk", (), |row| row.get(0))?;
            self.open = Some(Open { connection, batch: schema::from_sql(batch), requests: HashMap::new() });
        }
        self.open.as_mut().ok_or(StoreError::Closed)
    }

    fn set_aside(&self, aside: &Aside) {
        let now = wall_clock::micros(SystemTime::now());
        let name = aside.to.file_name().unwrap_or_default().to_string_lossy();
        let detail = format!("{}; the file is now {name}", aside.why);
        let dropped = Dropped {
            at_us: now,
            why: HistoryLoss::Corrupt,
            runs: None,
            first_us: 0,
            last_us: now,
            detail: Some(detail),
        };
        dropped.add_to(&mut lock(&self.shared.pending));
    }

    fn lose(&self, why: HistoryLoss, span: Span, detail: Option<String>) {
        self.shared.lost.fetch_add(span.runs, Ordering::Relaxed);
        let now = wall_clock::micros(SystemTime::now());
        let dropped = Dropped { detail, ..Dropped::new(now, why, span) };
        dropped.add_to(&mut lock(&self.shared.pending));
    }

    /// Says when it begins not to work, and when it works again; not each time.
    fn note(&self, error: Option<&StoreError>) {
        let mut problem = lock(&self.shared.problem);
        match error {
            Some(error) if problem.is_none() => {
                tracing::error!(file = %self.path.display(), %error, "the history cannot be written; runs go on");
            }
            None if problem.is_some() => tracing::info!("the history is being written again"),
            _ => {}
        }
        *problem = error.map(ToString::to_string);
    }

    #[cfg(test)]
    pub(super) fn connection(&mut self) -> &mut Connection {
        &mut self.opened().unwrap().connection
    }
}

impl Open {
    fn write(&mut self, runs: &[Run], pending: &[Dropped]) -> rusqlite::Result<()> {
        let batch = self.batch + 1;
        let transaction = self.connection.transaction()?;
        for dropped in pending {
            dropped.write(&transaction)?;
        }
        for chunk in chunks(runs) {
            let request = number_of(&transaction, &mut self.requests, &chunk.request, batch)?;
            transaction
                .prepare_cached(
                    "INSERT INTO chunk (batch, block, request, first_us, last_us, runs, failed, data) \
                     VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8)",
                )?
                .execute((
                    to_sql(batch),
                    chunk.block.0,
                    request,
                    to_sql(chunk.span.first_us),
                    to_sql(chunk.span.last_us),
                    to_sql(chunk.span.runs),
                    to_sql(chunk.failed),
                    &chunk.data,
                ))?;
        }
        transaction
            .prepare_cached("UPDATE total SET runs = runs + ?1")?
            .execute([to_sql(runs.len() as u64)])?;
        transaction.commit()?;
        self.batch = batch;
        Ok(())
    }
}

/// Runs by block and request, in the order in which they ended.
fn chunks(runs: &[Run]) -> Vec<Chunk> {
    let mut chunks: Vec<Chunk> = Vec::new();
    let mut last: HashMap<BlockId, usize> = HashMap::new();
    for run in runs {
        let open = last.get(&run.block).and_then(|at| chunks.get_mut(*at)).filter(|chunk| chunk.takes(run));
        if let Some(chunk) = open {
            chunk.add(run);
        } else {
            last.insert(run.block, chunks.len());
            chunks.push(Chunk::new(run));
        }
    }
    chunks
}

/// The number of a request, which is stored once.
fn number_of(
    transaction: &Transaction<'_>,
    known: &mut HashMap<Arc<[u8]>, Known>,
    request: &Arc<[u8]>,
    batch: u64,
) -> rusqlite::Result<i64> {
    if known.len() >= MAX_REQUESTS {
        known.clear();
    }
    let entry = known.entry(Arc::clone(request));
    if let Entry::Occupied(known) = &entry
        && known.get().used + USED_EVERY > batch
    {
        return Ok(known.get().id);
    }
    let id = transaction
        .prepare_cached(
            "INSERT INTO request (bytes, used) VALUES (?1, ?2) \
             ON CONFLICT (bytes) DO UPDATE SET used = excluded.used RETURNING id",
        )?
        .query_row((&**request, to_sql(batch)), |row| row.get(0))?;
    entry.insert_entry(Known { id, used: batch });
    Ok(id)
}

/// Requests that no chunk uses any more; `oldest` is the batch of the oldest chunk.
pub(super) fn forget_requests(transaction: &Transaction<'_>, oldest: u64) -> rusqlite::Result<()> {
    let unused = oldest.saturating_sub(USED_EVERY);
    transaction.prepare_cached("DELETE FROM request WHERE used < ?1")?.execute([to_sql(unused)])?;
    Ok(())
}
