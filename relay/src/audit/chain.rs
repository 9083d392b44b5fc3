//! Is the chain whole? Reads records and compares each with the one before.

use core::fmt;
use std::io::{self, BufRead, Read};

use super::Event;
use super::head::{Head, Unaccepted};
use super::line::{self, Hash, Link};

/// Longest line that is read.
const MAX_LINE: u64 = 1024 * 1024;

/// A chain without a break.
#[derive(Clone, Debug, Default)]
pub(crate) struct Chain {
    /// How many records were read.
    pub(super) records: u64,
    /// When the first of them was recorded.
    pub(super) since: Option<String>,
    /// The newest record.
    pub(super) last: Option<Link>,
    /// Bytes up to the end of the newest record, its line feed included.
    pub(super) end: u64,
    /// Bytes after it: a record that was never finished, and so never relied on.
    pub(super) unfinished: u64,
    /// An earlier break that nobody has accepted yet.
    pub(super) broken: Option<Unaccepted>,
}

/// What is wrong, and where.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Break {
    /// Counted from 1; 0 where no line is meant.
    line: u64,
    what: String,
}

impl Break {
    /// Wrong, but not at one line.
    pub(super) fn without_line(what: impl Into<String>) -> Self {
        Self { line: 0, what: what.into() }
    }
}

impl fmt::Display for Break {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.line {
            0 => f.write_str(&self.what),
            line => write!(f, "line {line}: {}", self.what),
        }
    }
}

/// Where reading begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Begin {
    /// At the first record.
    First,
    /// Anywhere: the first record that is read is believed to follow the one before.
    Anywhere,
}

/// Reads to the end. A broken chain is the inner error; the outer one is that of the disk.
pub(super) fn follow(
    mut reader: impl BufRead,
    begin: Begin,
    head: Option<&Head>,
) -> io::Result<Result<Chain, Break>> {
    let mut chain = Chain::default();
    let mut bytes = Vec::new();
    for number in 1.. {
        bytes.clear();
        let length = (&mut reader).take(MAX_LINE).read_until(b'\n', &mut bytes)? as u64;
        let broken = |what: String| Ok(Err(Break { line: number, what }));
        let Some(text) = bytes.strip_suffix(b"\n") else {
            if length == MAX_LINE {
                return broken("this line is not a record".to_owned());
            }
            // A whole record and then something else cannot come from a write that was cut short.
            if has_a_record_and_more(&bytes) {
                return broken("something else follows the record".to_owned());
            }
            chain.unfinished = length;
            break;
        };
        let link = match line::read(text) {
            Ok(link) => link,
            Err(what) => return broken(what.to_owned()),
        };
        if let Err(what) = follows(&chain, &link, begin) {
            return broken(what);
        }
        if head.is_some_and(|head| head.seq == link.seq && head.hash != link.hash) {
            return broken(format!("record {} is not the one that audit.head knows", link.seq));
        }
        chain.take(link, length);
    }
    let newest = chain.last.as_ref().map_or(0, |link| link.seq);
    Ok(match head {
        Some(head) if head.seq > newest => Err(Break::without_line(match head.seq - newest {
            1 => format!("record {} is missing at the end", head.seq),
            _ => format!("records {} to {} are missing at the end", newest + 1, head.seq),
        })),
        _ => Ok(chain),
    })
}

fn follows(chain: &Chain, link: &Link, begin: Begin) -> Result<(), String> {
    let seq = link.seq;
    match &chain.last {
        Some(last) if last.seq.checked_add(1) != Some(seq) => {
            Err(format!("record {seq} follows record {}: records are missing, doubled or moved", last.seq))
        }
        Some(last) if last.hash != link.prev => {
            Err(format!("record {seq} does not continue record {}", last.seq))
        }
        None if begin == Begin::First
            && link.event != Event::ChainBroken.word()
            && (seq != 1 || link.prev != Hash::ZERO) =>
        {
            Err(format!("the first record has the number {seq}: records are missing at the beginning"))
        }
        _ => Ok(()),
    }
}

impl Chain {
    fn take(&mut self, link: Link, length: u64) {
        if link.event == Event::ChainBroken.word() {
            self.broken = Some(Unaccepted { seq: link.seq, what: link.what.clone().unwrap_or_default() });
        } else if link.event == Event::ChainAccepted.word() {
            self.broken = None;
        }
        self.since.get_or_insert_with(|| link.at.clone());
        self.records += 1;
        self.end += length;
        self.last = Some(link);
    }
}

/// The line goes on after a whole record.
fn has_a_record_and_more(line: &[u8]) -> bool {
    line.windows(2).enumerate().any(|(at, pair)| {
        pair == b"\"}"
            && at + 2 < line.len()
            && line.get(..at + 2).is_some_and(|start| line::read(start).is_ok())
    })
}
