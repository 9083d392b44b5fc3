//! Reading what is on the disk: at the start, and for `cipdeck audit verify`.

use std::fs::{self, File};
use std::io::{self, BufRead, BufReader, Seek, SeekFrom};
use std::path::Path;

use super::chain::{self, Begin, Break, Chain};
use super::head::{HEAD, Head};
use super::medium::FILE;

/// A file up to this size is read to its end before the relay starts.
const SMALL: u64 = 4 * 1024 * 1024;

/// Of a bigger one this much.
const TAIL: u64 = 1024 * 1024;

/// What the relay finds when it starts.
pub(super) struct Found {
    pub(super) chain: Result<Chain, Break>,
    /// Where a new chain goes on if this one is broken.
    pub(super) head: Head,
    /// Everything was read, not only the end.
    pub(super) is_whole: bool,
}

/// Looks at the folder's audit before anything is appended.
pub(super) fn at_start(folder: &Path) -> io::Result<Found> {
    let head = Head::read(folder);
    let known = head.clone().ok().flatten();
    let go_on = known.clone().unwrap_or(Head::NONE);
    let (chain, is_whole) = match File::open(folder.join(FILE)) {
        Ok(file) => {
            let length = file.metadata()?.len();
            let chain = read(file, length, known.as_ref())?;
            (chain, length <= SMALL)
        }
        Err(error) if error.kind() == io::ErrorKind::NotFound => (missing(known.as_ref()), true),
        Err(error) => return Err(error),
    };
    let newest = chain.as_ref().ok().and_then(|chain| chain.last.as_ref()).map_or(0, |link| link.seq);
    let chain = match head {
        Err(what) => Err(Break::without_line(what)),
        Ok(None) if newest > 0 => Err(Break::without_line(format!("{HEAD} is missing"))),
        Ok(_) => chain,
    };
    // Numbers go on after the newest record that is known, so that none is used twice.
    let head = Head { seq: go_on.seq.max(newest), ..go_on };
    Ok(Found { chain, head, is_whole })
}

fn read(mut file: File, length: u64, head: Option<&Head>) -> io::Result<Result<Chain, Break>> {
    if length <= SMALL {
        return chain::follow(BufReader::new(file), Begin::First, head);
    }
    file.seek(SeekFrom::Start(length - TAIL))?;
    let mut reader = BufReader::new(file);
    let skipped = reader.skip_until(b'\n')? as u64;
    let chain = chain::follow(reader, Begin::Anywhere, head)?;
    Ok(chain.map(|chain| Chain { end: chain.end + length - TAIL + skipped, ..chain }))
}

fn missing(head: Option<&Head>) -> Result<Chain, Break> {
    match head {
        Some(head) if head.seq > 0 => Err(Break::without_line(format!("{FILE} is missing"))),
        _ => Ok(Chain::default()),
    }
}

/// A chain that holds.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Verified {
    /// How many records.
    pub(crate) records: u64,
    /// When the first and the last of them were recorded.
    pub(crate) span: Option<(String, String)>,
    /// What a person should know besides.
    pub(crate) notes: Vec<String>,
}

/// Reads the audit of a data folder; a relay may be running. The error says what is broken.
pub(crate) fn verify_folder(folder: &Path) -> io::Result<Result<Verified, String>> {
    // First the head: what is appended meanwhile comes after it.
    let head = match Head::read(folder) {
        Ok(head) => head,
        Err(what) => return Ok(Err(what)),
    };
    let chain = match File::open(folder.join(FILE)) {
        Ok(file) => chain::follow(BufReader::new(file), Begin::First, head.as_ref())?,
        Err(error) if error.kind() == io::ErrorKind::NotFound && head.is_some() => missing(head.as_ref()),
        Err(error) => return Err(error),
    };
    Ok(match chain {
        Err(found) => Err(found.to_string()),
        Ok(chain) if chain.records > 0 && head.is_none() => {
            Err(format!("{HEAD} is missing: whether records at the end are missing cannot be told"))
        }
        Ok(chain) => judge(chain),
    })
}

/// Reads an exported file.
pub(crate) fn verify_file(path: &Path) -> io::Result<Result<Verified, String>> {
    if path.file_name().is_some_and(|name| name == FILE)
        && let Some(folder) = path.parent()
        && fs::exists(folder.join(HEAD))?
    {
        return verify_folder(folder);
    }
    let chain = chain::follow(BufReader::new(File::open(path)?), Begin::First, None)?;
    Ok(chain.map_err(|found| found.to_string()).and_then(|chain| {
        let mut verified = judge(chain)?;
        let note = format!("without {HEAD}: whether records at the end are missing cannot be told");
        verified.notes.push(note);
        Ok(verified)
    }))
}

fn judge(chain: Chain) -> Result<Verified, String> {
    if let Some(broken) = chain.broken {
        return Err(format!(
            "record {} tells of a break that nobody has accepted: {}",
            broken.seq, broken.what
        ));
    }
    let mut notes = Vec::new();
    if let Some(first) = chain.last.as_ref().map(|last| last.seq + 1 - chain.records)
        && first > 1
    {
        notes.push(format!("begins with record {first}, after a break that was accepted"));
    }
    if chain.unfinished > 0 {
        notes.push(format!("{} bytes of a record that was never finished follow", chain.unfinished));
    }
    let last = chain.last.map(|link| link.at);
    Ok(Verified { records: chain.records, span: chain.since.zip(last), notes })
}
