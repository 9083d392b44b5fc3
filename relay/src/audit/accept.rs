//! `audit.accept`: left by `cipdeck audit accept`, taken up by the relay, which alone appends records.

use std::fs;
use std::io;
use std::path::Path;

use serde::{Deserialize, Serialize};

use super::head::{Head, Unaccepted};

const REQUEST: &str = "audit.accept";

#[derive(Serialize, Deserialize)]
struct Request {
    /// The break that was looked at, and no other.
    broken: Unaccepted,
    /// The account of this machine.
    by: String,
}

/// Asks the relay of this folder to go on after the break that it has found; what was broken. `None`: it has found none.
pub(crate) fn request(folder: &Path, by: &str) -> Result<Option<String>, String> {
    let Some(broken) = unaccepted(folder)? else { return Ok(None) };
    let what = broken.what.clone();
    let text =
        serde_json::to_vec(&Request { broken, by: by.to_owned() }).map_err(|error| error.to_string())?;
    let new = folder.join("audit.accept.new");
    let written = fs::write(&new, text).and_then(|()| fs::rename(&new, folder.join(REQUEST)));
    written.map_err(|error: io::Error| format!("{}: {error}", folder.join(REQUEST).display()))?;
    Ok(Some(what))
}

/// The break that the relay of this folder waits with.
pub(crate) fn pending(folder: &Path) -> Result<Option<String>, String> {
    unaccepted(folder).map(|broken| broken.map(|broken| broken.what))
}

fn unaccepted(folder: &Path) -> Result<Option<Unaccepted>, String> {
    Head::read(folder).map(|head| head.and_then(|head| head.broken))
}

/// Who has accepted this break, if somebody has.
pub(super) fn requested(folder: &Path, broken: &Unaccepted) -> Option<String> {
    let request: Request = serde_json::from_slice(&fs::read(folder.join(REQUEST)).ok()?).ok()?;
    (request.broken == *broken).then_some(request.by)
}

/// The request was taken up.
pub(super) fn forget(folder: &Path) {
    if let Err(error) = fs::remove_file(folder.join(REQUEST)) {
        tracing::warn!(%error, "{REQUEST} cannot be removed");
    }
}
