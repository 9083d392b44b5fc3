//! `audit.head`: the newest record that is certainly on the disk, kept beside the records, so that records that were
//! cut off at the end are missed.

use std::fs::{self, File};
use std::io::{self, Write};
use std::path::Path;

use serde::{Deserialize, Serialize};

use super::line::Hash;
use crate::owner;

/// Its name in the data folder.
pub(super) const HEAD: &str = "audit.head";

/// The newest durable record.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Head {
    /// 0 before the first.
    pub(super) seq: u64,
    pub(super) hash: Hash,
    /// A break that nobody has accepted yet.
    pub(super) broken: Option<Unaccepted>,
}

/// A break that a person with access to the machine has to look at.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Unaccepted {
    /// The record `chain_broken`.
    pub(super) seq: u64,
    /// What is broken, in words.
    pub(super) what: String,
}

#[derive(Serialize, Deserialize)]
struct Stored {
    seq: u64,
    hash: String,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    broken: Option<Unaccepted>,
}

impl Head {
    /// Before the first record.
    pub(super) const NONE: Self = Self { seq: 0, hash: Hash::ZERO, broken: None };

    /// The head in this folder; `None` without one, an error in words for one that cannot be used.
    pub(super) fn read(folder: &Path) -> Result<Option<Self>, String> {
        let bytes = match fs::read(folder.join(HEAD)) {
            Ok(bytes) => bytes,
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
            Err(error) => return Err(format!("{HEAD} cannot be read: {error}")),
        };
        let unusable = || format!("{HEAD} holds no sequence number and hash");
        let stored: Stored = serde_json::from_slice(&bytes).map_err(|_| unusable())?;
        let hash = stored.hash.parse().map_err(|()| unusable())?;
        Ok(Some(Self { seq: stored.seq, hash, broken: stored.broken }))
    }

    /// Replaces the head in this folder: the old one or the new one is there at any time.
    pub(super) fn write(&self, folder: &Path) -> io::Result<()> {
        let stored = Stored { seq: self.seq, hash: self.hash.to_string(), broken: self.broken.clone() };
        let new = folder.join("audit.head.new");
        let mut file = File::create(&new)?;
        file.write_all(&serde_json::to_vec(&stored)?)?;
        file.write_all(b"\n")?;
        file.sync_all()?;
        // Written by a command of root, it must not be out of the relay's reach.
        owner::give(&new, &fs::metadata(folder)?)?;
        fs::rename(new, folder.join(HEAD))
    }
}
