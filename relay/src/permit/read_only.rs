//! The switch that stops all writes. It is a file beside the database: the interfaces can make it, and whoever is at the
//! relay's machine can remove it.

use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

/// The switch.
#[derive(Debug)]
pub(crate) struct ReadOnly {
    /// `None` keeps the switch in memory.
    marker: Option<PathBuf>,
    /// On, and no file says so.
    fallback: AtomicBool,
}

/// Name of the file in the data folder.
const MARKER: &str = "read-only";

const TEXT: &str = "The relay writes to no device while this file is here.\n";

impl ReadOnly {
    /// The switch of a data folder.
    pub(crate) fn of(folder: Option<&Path>) -> Self {
        Self { marker: folder.map(|folder| folder.join(MARKER)), fallback: AtomicBool::new(false) }
    }

    /// Whether writes stop. Asked of the file each time; a folder that cannot be read counts as on.
    pub(crate) fn is_on(&self) -> bool {
        self.fallback.load(Ordering::Relaxed)
            || self.marker.as_ref().is_some_and(|marker| marker.try_exists().unwrap_or(true))
    }

    /// Turns it on. There is no way back from here. An error says that it is on only until the relay ends.
    pub(crate) fn turn_on(&self) -> io::Result<()> {
        // In memory first: a disk that takes nothing must not keep anybody from stopping.
        self.fallback.store(true, Ordering::Relaxed);
        let Some(marker) = &self.marker else { return Ok(()) };
        match std::fs::write(marker, TEXT) {
            Err(error) if !marker.try_exists().unwrap_or(false) => Err(error),
            // The file alone decides, so that whoever is at the machine can remove it.
            _ => {
                self.fallback.store(false, Ordering::Relaxed);
                Ok(())
            }
        }
    }

    /// Turns it off: for local access only.
    pub(crate) fn turn_off(&self) -> io::Result<()> {
        self.fallback.store(false, Ordering::Relaxed);
        match self.marker.as_ref().map(std::fs::remove_file) {
            Some(Err(error)) if error.kind() != io::ErrorKind::NotFound => Err(error),
            _ => Ok(()),
        }
    }
}
