//! Who did what, from where, and what a device answered: `audit.jsonl`, append-only and hash-chained. docs/AUDIT.md
//! describes the records.
//!
//! A record is written through to the operating system before [`Audit::append`] returns, so that the end of this process
//! loses none; a thread brings it to the disk within a second. When nothing can be recorded, nothing is written to a
//! device: the caller asks first, and takes an error for a no.

mod accept;
mod chain;
mod head;
mod keeper;
mod line;
mod log;
mod medium;
mod page;
mod record;
mod verify;

#[cfg(test)]
mod tests;

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{self, JoinHandle};

use cipdeck_shared::api::{AuditHead, AuditState};

pub(crate) use self::accept::{pending, request as accept};
use self::head::Head;
use self::keeper::Shared;
use self::log::Log;
pub(crate) use self::medium::FILE;
use self::medium::{InMemory, OnDisk};
pub(crate) use self::page::Filter;
pub(crate) use self::record::{Event, Record};
pub(crate) use self::verify::{verify_file, verify_folder};
use crate::metrics::Metrics;
use crate::private;

/// Why something was not recorded. Nothing may be written to a device then.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub(crate) enum AuditError {
    /// The disk says no.
    #[error("the audit cannot be written ({0}): writes to devices are stopped until it can")]
    Failed(String),
    /// What was recorded was changed, and nobody has accepted that.
    #[error(
        "the audit is broken ({0}): writes to devices are stopped until somebody at the relay's machine has looked at it \
         and runs `cipdeck audit accept`"
    )]
    Broken(String),
    /// The data folder cannot be used at all.
    #[error("the audit cannot be opened: {0}")]
    Unusable(String),
}

/// The audit. Clones share it; the last one waits for the disk when it is dropped.
#[derive(Clone)]
pub(crate) struct Audit(Arc<Handle>);

struct Handle {
    metrics: Metrics,
    shared: Arc<Shared>,
    stopped: Arc<AtomicBool>,
    keeper: Option<JoinHandle<()>>,
}

impl Audit {
    /// Opens or makes the audit in this folder; without one it lives in memory. A broken chain is no error: the relay
    /// works, but writes nothing.
    pub(crate) fn open(folder: Option<&Path>) -> Result<Self, AuditError> {
        let Some(folder) = folder else { return Ok(Self::in_memory()) };
        let unusable = |error: std::io::Error| AuditError::Unusable(format!("{}: {error}", folder.display()));
        private::folder(folder).map_err(unusable)?;
        let shared = Shared::new(open_log(folder).map_err(unusable)?, Some(folder.to_owned()));
        // Before the first write, so that a crash in the first second does not look like a lost head.
        keeper::take_care(&shared, folder);
        let stopped = Arc::new(AtomicBool::new(false));
        let run = {
            let (shared, stopped, folder) = (Arc::clone(&shared), Arc::clone(&stopped), folder.to_owned());
            move || keeper::keep(&shared, &folder, || stopped.load(Ordering::Acquire))
        };
        let keeper = thread::Builder::new().name("audit".to_owned()).spawn(run).map_err(unusable)?;
        Ok(Self(Arc::new(Handle { metrics: Metrics::default(), shared, stopped, keeper: Some(keeper) })))
    }

    fn in_memory() -> Self {
        let log = Log::new(Box::<InMemory>::default(), Head::NONE, true);
        Self(Arc::new(Handle {
            metrics: Metrics::default(),
            shared: Shared::new(log, None),
            stopped: Arc::default(),
            keeper: None,
        }))
    }

    /// Records. Costs one small write; may be called under a lock.
    pub(crate) fn append(&self, record: &Record) -> Result<(), AuditError> {
        self.0.metrics.event(record.event());
        let result = self.0.shared.log().append(record);
        self.0.shared.wake();
        result
    }

    /// The counters of the relay that this audit belongs to.
    pub(crate) fn metrics(&self) -> &Metrics {
        &self.0.metrics
    }

    /// May a write to a device be recorded, as far as is known?
    pub(crate) fn is_writable(&self) -> bool {
        self.0.shared.log().trouble().is_none()
    }

    /// How it is, for the page.
    pub(crate) fn state(&self) -> AuditState {
        let log = self.0.shared.log();
        let (head, trouble) = (log.head(), log.trouble());
        AuditState {
            records: head.seq,
            writable: trouble.is_none(),
            trouble: trouble.map(|trouble| trouble.to_string()),
            verified: log.is_verified() && log.broken().is_none(),
            head: AuditHead { seq: head.seq, hash: head.hash.to_string() },
        }
    }

    /// The file, and how many of its bytes are whole records by now; `None` in memory.
    pub(crate) fn file(&self) -> Option<(PathBuf, u64)> {
        let folder = self.0.shared.folder.as_ref()?;
        Some((folder.join(FILE), self.0.shared.log().medium().length()))
    }

    /// The records as they would stand in a file; `None` when they do.
    pub(crate) fn memory(&self) -> Option<Vec<u8>> {
        self.0.shared.log().medium().memory()
    }
}

impl core::fmt::Debug for Audit {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("Audit").field("folder", &self.0.shared.folder).finish_non_exhaustive()
    }
}

impl Drop for Handle {
    fn drop(&mut self) {
        self.stopped.store(true, Ordering::Release);
        // Under the lock, so that the thread cannot miss it between its question and its sleep.
        drop(self.shared.log());
        self.shared.wake();
        if let Some(keeper) = self.keeper.take() {
            let _ = keeper.join();
        }
    }
}

/// The end of what is there; broken off and begun anew when that cannot be trusted.
fn open_log(folder: &Path) -> std::io::Result<Log> {
    let found = verify::at_start(folder)?;
    let head = found.head;
    match found.chain {
        Ok(chain) => {
            let last = chain.last.as_ref().map_or((head.seq, head.hash), |link| (link.seq, link.hash));
            let medium = OnDisk::open(folder, chain.end)?;
            // The head may be half a second behind; the end of a file knows nothing of its beginning.
            let broken = if found.is_whole { chain.broken } else { head.broken };
            let end = Head { seq: last.0, hash: last.1, broken };
            Ok(Log::new(Box::new(medium), end, found.is_whole))
        }
        Err(found) => {
            let length = fs::metadata(folder.join(FILE)).map_or(0, |file| file.len());
            let mut log = Log::new(Box::new(OnDisk::open(folder, length)?), head, true);
            if let Err(why) = log.break_off(&found.to_string()) {
                log.fail(&why);
            }
            Ok(log)
        }
    }
}
