//! What is behind the lock: the end of the chain, and whether writes to devices may go on.

use std::fs::File;
use std::sync::Arc;

use super::AuditError;
use super::head::{Head, Unaccepted};
use super::line::{self, Hash};
use super::medium::{AppendError, Medium};
use super::record::{Event, Record};

/// Records that a power failure could lose; the next one waits for the disk.
const MAX_UNSYNCED: u64 = 1_000;

/// The end of the chain.
pub(super) struct Log {
    medium: Box<dyn Medium>,
    seq: u64,
    hash: Hash,
    broken: Option<Unaccepted>,
    /// The first record of a new chain, while the disk does not take it.
    first: Option<Record>,
    failed: Option<Failed>,
    unsynced: u64,
    /// What `audit.head` says.
    kept: Option<Head>,
    /// The whole file has been read since the start.
    verified: bool,
}

/// Since when and why nothing can be recorded.
struct Failed {
    why: String,
    /// Records that were refused since then.
    refused: u64,
}

impl Log {
    /// Goes on after the record `head`.
    pub(super) fn new(medium: Box<dyn Medium>, head: Head, verified: bool) -> Self {
        let Head { seq, hash, broken } = head;
        Self { medium, seq, hash, broken, first: None, failed: None, unsynced: 0, kept: None, verified }
    }

    /// Records, or says why not. What allows a write is recorded only while the chain is whole.
    pub(super) fn append(&mut self, record: &Record) -> Result<(), AuditError> {
        if record.event().allows_a_write()
            && let Some(broken) = &self.broken
        {
            return Err(AuditError::Broken(broken.what.clone()));
        }
        let result = self.resume().and_then(|()| self.write(record));
        if let Err(AuditError::Failed(why)) = &result {
            let failed = self.failed.get_or_insert_with(|| {
                tracing::error!(error = %why, "the audit cannot be written: writes to devices are stopped");
                Failed { why: why.clone(), refused: 0 }
            });
            failed.refused += 1;
        }
        result
    }

    /// After a failure: records that it is over, if it is.
    pub(super) fn resume(&mut self) -> Result<(), AuditError> {
        let Some(failed) = &self.failed else { return Ok(()) };
        let record = Record::new(Event::AuditResumed, "relay", "")
            .with("why", failed.why.as_str())
            .with("not_recorded", failed.refused);
        self.write(&record)?;
        self.sync_now()?;
        self.failed = None;
        tracing::warn!("the audit can be written again");
        Ok(())
    }

    /// What is there is broken: keeps it under another name and begins a new chain that says so.
    pub(super) fn break_off(&mut self, what: &str) -> Result<(), AuditError> {
        tracing::error!(
            what,
            "the audit is broken: writes to devices are stopped until somebody runs `cipdeck audit accept`"
        );
        // Remembered first: writes stay stopped even if the new chain cannot begin.
        self.broken = Some(Unaccepted { seq: self.seq + 1, what: what.to_owned() });
        let kept_as = self.medium.set_aside().map_err(|error| AuditError::Failed(error.to_string()))?;
        let record = Record::new(Event::ChainBroken, "relay", "").with("what", what).with("kept_as", kept_as);
        self.first = Some(record);
        self.verified = true;
        self.begin().map_err(failed)?;
        self.sync_now()
    }

    /// A person has seen the break that the record `seq` tells of.
    pub(super) fn accept(&mut self, seq: u64, by: &str) -> Result<(), AuditError> {
        if self.broken.as_ref().is_none_or(|broken| broken.seq != seq) {
            return Ok(());
        }
        self.resume()?;
        self.write(&Record::new(Event::ChainAccepted, by, "").with("broken", seq))?;
        self.sync_now()?;
        // Something else may have been found while this was written.
        self.broken.take_if(|broken| broken.seq == seq);
        tracing::warn!(by, "the break of the audit was accepted: writes go on");
        Ok(())
    }

    fn write(&mut self, record: &Record) -> Result<(), AuditError> {
        if self.unsynced >= MAX_UNSYNCED {
            self.sync_now()?;
        }
        match self.begin().and_then(|()| self.append_line(record)) {
            Err(AppendError::Touched(what)) => {
                self.break_off(&what)?;
                if record.event().allows_a_write() {
                    return Err(AuditError::Broken(what));
                }
                self.append_line(record).map_err(failed)
            }
            result => result.map_err(failed),
        }
    }

    /// Writes the first record of a new chain, if it is not there yet.
    fn begin(&mut self) -> Result<(), AppendError> {
        let Some(first) = self.first.take() else { return Ok(()) };
        self.append_line(&first).inspect_err(|_| self.first = Some(first))
    }

    fn append_line(&mut self, record: &Record) -> Result<(), AppendError> {
        let line = line::write(self.seq + 1, record, self.hash);
        self.medium.append(&line.bytes)?;
        self.seq += 1;
        self.hash = line.hash;
        self.unsynced += 1;
        Ok(())
    }

    fn sync_now(&mut self) -> Result<(), AuditError> {
        if let Some(file) = self.medium.file() {
            file.sync_data().map_err(|error| AuditError::Failed(error.to_string()))?;
        }
        self.unsynced = 0;
        Ok(())
    }

    /// What has to be synchronised, outside of the lock, and the head to be kept afterwards; `None`: all is done.
    pub(super) fn begin_sync(&mut self) -> Option<(Arc<File>, Head)> {
        let (file, head) = (self.medium.file()?, self.head());
        if self.unsynced == 0 && self.kept.as_ref() == Some(&head) {
            return None;
        }
        self.unsynced = 0;
        self.kept = Some(head.clone());
        Some((file, head))
    }

    /// The disk did not take what was written.
    pub(super) fn fail(&mut self, why: &impl ToString) {
        let why = why.to_string();
        self.kept = None;
        tracing::error!(error = %why, "the audit cannot be written: writes to devices are stopped");
        self.failed.get_or_insert(Failed { why, refused: 0 });
    }

    /// The whole file was read up to here.
    pub(super) fn set_verified(&mut self) {
        self.verified = true;
    }

    pub(super) fn head(&self) -> Head {
        Head { seq: self.seq, hash: self.hash, broken: self.broken.clone() }
    }

    pub(super) fn medium(&self) -> &dyn Medium {
        &*self.medium
    }

    pub(super) const fn broken(&self) -> Option<&Unaccepted> {
        self.broken.as_ref()
    }

    pub(super) const fn is_dirty(&self) -> bool {
        self.unsynced > 0
    }

    pub(super) const fn is_verified(&self) -> bool {
        self.verified
    }

    /// Why writes are stopped, if they are.
    pub(super) fn trouble(&self) -> Option<AuditError> {
        let failed = self.failed.as_ref().map(|failed| AuditError::Failed(failed.why.clone()));
        failed.or_else(|| self.broken.as_ref().map(|broken| AuditError::Broken(broken.what.clone())))
    }
}

fn failed(error: AppendError) -> AuditError {
    AuditError::Failed(match error {
        AppendError::Failed(error) => error.to_string(),
        AppendError::Touched(what) => what,
    })
}
