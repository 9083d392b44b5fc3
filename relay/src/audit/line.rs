//! One line of the file: a JSON object whose last member is the SHA-256 of everything before it.
//!
//! The hash is taken over the line's own bytes without that member, so that no rule about the order or the spelling of
//! JSON is needed to check it.

use core::fmt;

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};
use sha2::{Digest, Sha256};

use super::record::Record;
use crate::wall_clock;

/// What stands between the hashed bytes and the hash.
const HASH_MEMBER: &[u8] = b",\"hash\":\"";

/// Hexadecimal digits of a hash.
const DIGITS: usize = 64;

/// SHA-256 of one record.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) struct Hash([u8; 32]);

impl Hash {
    /// What stands before the first record.
    pub(super) const ZERO: Self = Self([0; 32]);

    fn of(bytes: &[u8]) -> Self {
        Self(Sha256::digest(bytes).into())
    }
}

impl fmt::Display for Hash {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.iter().try_for_each(|byte| write!(f, "{byte:02x}"))
    }
}

impl fmt::Debug for Hash {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl std::str::FromStr for Hash {
    type Err = ();

    /// 64 lower-case digits and nothing else: a hash has one spelling.
    fn from_str(text: &str) -> Result<Self, ()> {
        let digits = text.as_bytes();
        if digits.len() != DIGITS {
            return Err(());
        }
        let value = |digit: u8| match digit {
            b'0'..=b'9' => Ok(digit - b'0'),
            b'a'..=b'f' => Ok(digit - b'a' + 10),
            _ => Err(()),
        };
        let mut hash = [0; 32];
        for (byte, pair) in hash.iter_mut().zip(digits.chunks_exact(2)) {
            if let [high, low] = pair {
                *byte = value(*high)? << 4 | value(*low)?;
            }
        }
        Ok(Self(hash))
    }
}

/// A new line, its line feed included, and its hash.
pub(super) struct Written {
    pub(super) bytes: Vec<u8>,
    pub(super) hash: Hash,
}

/// Writes the line of a record.
pub(super) fn write(seq: u64, record: &Record, prev: Hash) -> Written {
    let line = Line {
        seq,
        at: wall_clock::now(),
        event: record.event().word(),
        actor: record.actor(),
        from: record.from(),
        members: record.members(),
        prev: prev.to_string(),
    };
    // Keys are text, which is all that could fail.
    let mut bytes = serde_json::to_vec(&line).unwrap_or_default();
    let hash = Hash::of(&bytes);
    bytes.pop();
    bytes.extend_from_slice(HASH_MEMBER);
    bytes.extend_from_slice(hash.to_string().as_bytes());
    bytes.extend_from_slice(b"\"}\n");
    Written { bytes, hash }
}

#[derive(Serialize)]
struct Line<'a> {
    seq: u64,
    at: String,
    event: &'a str,
    actor: &'a str,
    from: &'a str,
    #[serde(flatten)]
    members: &'a Map<String, Value>,
    prev: String,
}

/// What the chain needs of a line.
#[derive(Clone, Debug)]
pub(super) struct Link {
    pub(super) seq: u64,
    pub(super) at: String,
    pub(super) event: String,
    /// With `chain_broken`: what is broken.
    pub(super) what: Option<String>,
    pub(super) prev: Hash,
    pub(super) hash: Hash,
}

/// Reads a line, without its line feed; the error says what is wrong with it.
pub(super) fn read(line: &[u8]) -> Result<Link, &'static str> {
    let no_record = "this line is not a record";
    let end = line.strip_suffix(b"\"}").ok_or(no_record)?;
    let (start, digits) = end.split_at_checked(end.len().wrapping_sub(DIGITS)).ok_or(no_record)?;
    let body = start.strip_suffix(HASH_MEMBER).ok_or(no_record)?;
    let hash: Hash =
        str::from_utf8(digits).ok().and_then(|text| text.parse().ok()).ok_or("its hash cannot be read")?;
    let mut hashed = body.to_vec();
    hashed.push(b'}');
    if Hash::of(&hashed) != hash {
        return Err("its content does not match its hash");
    }
    let parsed: Parsed = serde_json::from_slice(&hashed).map_err(|_| no_record)?;
    let prev = parsed.prev.parse().map_err(|()| "the hash of the record before cannot be read")?;
    Ok(Link { seq: parsed.seq, at: parsed.at, event: parsed.event, what: parsed.what, prev, hash })
}

#[derive(Deserialize)]
struct Parsed {
    seq: u64,
    at: String,
    event: String,
    #[serde(default)]
    what: Option<String>,
    prev: String,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::audit::Event;

    #[test]
    fn a_line_reads_back_and_its_hash_is_that_of_sha256sum() {
        let record = Record::new(Event::WriteDenied, "anna", "10.0.0.7")
            .with("block", "b7")
            .with("why", "no \"window\"\n");
        let written = write(3, &record, Hash::ZERO);
        let text = written.bytes.strip_suffix(b"\n").unwrap();
        let link = read(text).unwrap();
        assert_eq!((link.seq, link.event.as_str(), link.prev), (3, "write_denied", Hash::ZERO));
        assert_eq!(link.hash, written.hash);
        let value: Value = serde_json::from_slice(text).unwrap();
        assert_eq!(value["why"], "no \"window\"\n");
        assert_eq!(value["hash"], written.hash.to_string());
        // printf '%s' abc | sha256sum
        let abc = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
        assert_eq!(Hash::of(b"abc").to_string(), abc);
        assert_eq!(abc.parse(), Ok(Hash::of(b"abc")));
        assert_eq!(abc.to_uppercase().parse::<Hash>(), Err(()));
    }

    #[test]
    fn what_is_no_record_is_said_so() {
        for line in ["", "}", "{}", "\"}", "{\"seq\":1}", "x,\"hash\":\"\"}"] {
            assert_eq!(read(line.as_bytes()).unwrap_err(), "this line is not a record", "{line}");
        }
    }
}
