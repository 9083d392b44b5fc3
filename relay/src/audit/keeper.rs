//! The thread behind the audit: brings records to the disk, keeps the head, tries again after a failure, and takes up
//! what `cipdeck audit accept` has left.

use std::fs;
use std::io::{BufReader, Read};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use super::accept;
use super::chain::{self, Begin};
use super::log::Log;
use super::medium::FILE;

/// How long a record may wait for the disk, and how often something that failed is tried again.
const PACE: Duration = Duration::from_millis(500);

/// What the thread and the handles share.
pub(super) struct Shared {
    log: Mutex<Log>,
    /// Something is to be done, or the end has come.
    news: Condvar,
    pub(super) folder: Option<PathBuf>,
}

impl Shared {
    pub(super) fn new(log: Log, folder: Option<PathBuf>) -> Arc<Self> {
        Arc::new(Self { log: Mutex::new(log), news: Condvar::new(), folder })
    }

    /// Each change of the log is complete before anything can panic, so that a poisoned lock is as good as another.
    pub(super) fn log(&self) -> MutexGuard<'_, Log> {
        self.log.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Wakes the thread.
    pub(super) fn wake(&self) {
        self.news.notify_all();
    }
}

/// Runs until `is_stopped`; then once more.
pub(super) fn keep(shared: &Shared, folder: &Path, is_stopped: impl Fn() -> bool) {
    if !shared.log().is_verified() {
        read_all(shared, folder, &is_stopped);
    }
    loop {
        let stopped = is_stopped();
        take_care(shared, folder);
        if stopped {
            return;
        }
        let mut log = shared.log();
        while !log.is_dirty() && log.trouble().is_none() && !is_stopped() {
            log = shared.news.wait(log).unwrap_or_else(PoisonError::into_inner);
        }
        if !is_stopped() {
            // Records of the same half second share one trip to the disk. The answer is of no interest.
            drop(shared.news.wait_timeout_while(log, PACE, |_| !is_stopped()));
        }
    }
}

/// Everything that can be done now.
pub(super) fn take_care(shared: &Shared, folder: &Path) {
    let mut log = shared.log();
    if let Some(broken) = log.broken()
        && let Some(by) = accept::requested(folder, broken)
    {
        let seq = broken.seq;
        match log.accept(seq, &by) {
            Ok(()) => accept::forget(folder),
            Err(error) => tracing::error!(%error, "the break of the audit could not be accepted"),
        }
    }
    // What is still wrong has been logged when it began.
    let _ = log.resume();
    let Some((file, head)) = log.begin_sync() else { return };
    drop(log);
    if let Err(error) = file.sync_data() {
        return shared.log().fail(&error);
    }
    if let Err(error) = head.write(folder) {
        tracing::warn!(%error, "audit.head cannot be written");
    }
}

/// A file that was too long to be read at the start is read now.
fn read_all(shared: &Shared, folder: &Path, is_stopped: &impl Fn() -> bool) {
    let length = shared.log().medium().length();
    let Ok(file) = fs::File::open(folder.join(FILE)) else { return };
    let reader = BufReader::with_capacity(64 * 1024, Stoppable { file: file.take(length), is_stopped });
    match chain::follow(reader, Begin::First, None) {
        Ok(Ok(_)) => shared.log().set_verified(),
        Ok(Err(found)) => {
            // An error is kept by the log and tried again.
            let mut log = shared.log();
            if let Err(why) = log.break_off(&found.to_string()) {
                log.fail(&why);
            }
        }
        Err(error) => tracing::warn!(%error, "the audit was not read to its end"),
    }
}

struct Stoppable<'a, F> {
    file: std::io::Take<fs::File>,
    is_stopped: &'a F,
}

impl<F: Fn() -> bool> Read for Stoppable<'_, F> {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        if (self.is_stopped)() {
            return Err(std::io::Error::other("the relay stops"));
        }
        self.file.read(buffer)
    }
}
