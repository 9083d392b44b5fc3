//! One relay at a time: a second one would run the same blocks again.
//!
//! A lock of its own and not SQLite's exclusive mode, so that a backup can read the database meanwhile.

use std::fs::{File, TryLockError};
use std::path::Path;
use std::thread;
use std::time::{Duration, Instant};

use super::StoreError;
use crate::private;

/// Its name in the data folder. The file stays; who holds it is known to the operating system, which takes it back from
/// a process that ends in whatever way.
const LOCK: &str = "relay.lock";

/// How long a relay that is just ending may still hold it.
const PATIENCE: Duration = Duration::from_secs(1);

/// How often it is tried again.
const PACE: Duration = Duration::from_millis(10);

/// Held as long as this is kept.
#[derive(Debug)]
pub(super) struct Lock(#[expect(dead_code, reason = "dropping it gives it back")] File);

impl Lock {
    /// Takes the lock of a data folder, which is made if it is not there.
    pub(super) fn take(folder: &Path) -> Result<Self, StoreError> {
        let path = folder.join(LOCK);
        private::file(&path).map_err(StoreError::Folder)?;
        let file = File::options().write(true).open(path).map_err(StoreError::Folder)?;
        let deadline = Instant::now() + PATIENCE;
        loop {
            match file.try_lock() {
                Ok(()) => return Ok(Self(file)),
                Err(TryLockError::WouldBlock) if Instant::now() < deadline => thread::sleep(PACE),
                Err(TryLockError::WouldBlock) => return Err(StoreError::InUse),
                Err(TryLockError::Error(error)) => return Err(StoreError::Folder(error)),
            }
        }
    }
}
