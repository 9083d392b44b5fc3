//! Reading records for people: newest first, filtered, a page at a time.

use std::fs::File;
use std::io::{self, Cursor, Read, Seek, SeekFrom};

use cipdeck_shared::api::{AuditPage, AuditRecord};
use serde::Deserialize;
use utoipa::IntoParams;

use super::Audit;

/// Records of a page unless told otherwise, and at most.
const LIMIT: usize = 100;
const MAX_LIMIT: usize = 1_000;

/// Bytes that one page looks through at most; the next page goes on where it ended.
const MAX_LOOKED_AT: u64 = 16 * 1024 * 1024;

/// Bytes that are read at once.
const STEP: u64 = 64 * 1024;

/// Which records a page shows.
#[derive(Clone, Debug, Default, PartialEq, Eq, Deserialize, IntoParams)]
#[serde(deny_unknown_fields)]
#[into_params(parameter_in = Query)]
pub(crate) struct Filter {
    /// One event, by its word.
    pub(crate) event: Option<String>,
    /// One actor.
    pub(crate) actor: Option<String>,
    /// One block, by its id or its name.
    pub(crate) block: Option<String>,
    /// RFC 3339, or its beginning; this moment and later ones.
    pub(crate) from: Option<String>,
    /// RFC 3339, or its beginning; this moment and earlier ones.
    pub(crate) to: Option<String>,
    /// How many; 100 without, 1,000 at most.
    pub(crate) limit: Option<usize>,
    /// Only records with a smaller number.
    pub(crate) before: Option<u64>,
}

impl Audit {
    /// Reads a page. It reads the disk: call it where that may take a while.
    pub(crate) fn page(&self, filter: &Filter) -> io::Result<AuditPage> {
        if let Some((path, length)) = self.file() {
            return read(File::open(path)?, length, filter);
        }
        let bytes = self.memory().unwrap_or_default();
        let length = bytes.len() as u64;
        read(Cursor::new(bytes), length, filter)
    }
}

fn read(mut file: impl Read + Seek, length: u64, filter: &Filter) -> io::Result<AuditPage> {
    let end = match filter.before {
        Some(before) => offset_of(&mut file, length, before)?,
        None => length,
    };
    let limit = filter.limit.unwrap_or(LIMIT).clamp(1, MAX_LIMIT);
    let mut records = Vec::new();
    let mut lines = Backwards { file, start: end, pending: Vec::new() };
    while let Some(line) = lines.next()? {
        // What is broken is told by the verification; a page shows what can be read.
        let Ok(record) = serde_json::from_slice::<AuditRecord>(&line) else { continue };
        let seq = record.seq;
        if filter.from.as_ref().is_some_and(|from| record.at < *from) {
            return Ok(AuditPage { records, more: None });
        }
        if filter.takes(&record) {
            records.push(record);
        }
        if records.len() == limit || end - lines.start > MAX_LOOKED_AT {
            let more = Some(seq).filter(|_| lines.has_more());
            return Ok(AuditPage { records, more });
        }
    }
    Ok(AuditPage { records, more: None })
}

impl Filter {
    fn takes(&self, record: &AuditRecord) -> bool {
        let is = |wanted: &Option<String>, value: &str| wanted.as_ref().is_none_or(|wanted| wanted == value);
        let member = |key: &str| record.members.get(key).and_then(|value| value.as_str());
        is(&self.event, &record.event)
            && is(&self.actor, &record.actor)
            && self
                .block
                .as_ref()
                .is_none_or(|block| [member("block"), member("name")].contains(&Some(block.as_str())))
            && self.to.as_ref().is_none_or(|to| record.at <= *to || record.at.starts_with(to.as_str()))
    }
}

/// The lines of a file, the last one first.
struct Backwards<R> {
    file: R,
    /// Everything from here on is in `pending` or was returned.
    start: u64,
    /// Read, not returned; begins at `start`.
    pending: Vec<u8>,
}

impl<R: Read + Seek> Backwards<R> {
    fn next(&mut self) -> io::Result<Option<Vec<u8>>> {
        loop {
            let text = self.pending.strip_suffix(b"\n").unwrap_or(&self.pending);
            if let Some(at) = text.iter().rposition(|byte| *byte == b'\n') {
                let line = self.pending.split_off(at + 1);
                return Ok(Some(line));
            }
            if self.start == 0 {
                let line = std::mem::take(&mut self.pending);
                return Ok(Some(line).filter(|line| !line.is_empty()));
            }
            let step = STEP.min(self.start);
            self.start -= step;
            self.file.seek(SeekFrom::Start(self.start))?;
            let mut bytes = Vec::new();
            (&mut self.file).take(step).read_to_end(&mut bytes)?;
            bytes.append(&mut self.pending);
            self.pending = bytes;
        }
    }

    fn has_more(&self) -> bool {
        self.start > 0 || !self.pending.is_empty()
    }
}

/// Where the first record with this number or a greater one begins.
fn offset_of(file: &mut (impl Read + Seek), length: u64, seq: u64) -> io::Result<u64> {
    // Between `low` and `high`; lines before `low` have smaller numbers.
    let (mut low, mut high) = (0, length);
    while low < high {
        let middle = low + (high - low) / 2;
        let Some((number, start, end)) = record_after(file, low, middle, length)? else {
            high = middle;
            continue;
        };
        if number < seq {
            low = end;
        } else if start == low {
            return Ok(low);
        } else {
            high = middle.min(start);
        }
    }
    Ok(low)
}

/// The first record that begins at `at` or later: its number, and where it begins and ends. `low` begins a line.
fn record_after(
    file: &mut (impl Read + Seek),
    low: u64,
    at: u64,
    length: u64,
) -> io::Result<Option<(u64, u64, u64)>> {
    let mut start = at;
    if at > low {
        // The line that `at` is in belongs to what is before, unless it begins here.
        start = at - 1 + line(file, at - 1, length)?.len() as u64;
    }
    let text = line(file, start, length)?;
    let number = serde_json::from_slice::<AuditRecord>(&text).ok().map(|record| record.seq);
    Ok(number.map(|number| (number, start, start + text.len() as u64)))
}

/// The bytes from `at` to the end of their line.
fn line(file: &mut (impl Read + Seek), at: u64, length: u64) -> io::Result<Vec<u8>> {
    use std::io::{BufRead, BufReader};
    file.seek(SeekFrom::Start(at))?;
    let mut text = Vec::new();
    BufReader::with_capacity(1024, file.take(length.saturating_sub(at))).read_until(b'\n', &mut text)?;
    Ok(text)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::audit::{Event, Record};

    fn audit(records: u64) -> Audit {
        let audit = Audit::open(None).unwrap();
        for number in 0..records {
            let event = if number % 3 == 0 { Event::WriteDenied } else { Event::SignIn };
            let actor = if number % 2 == 0 { "anna" } else { "ben" };
            // Of many lengths, some longer than a step.
            let text = "x".repeat(usize::try_from(number * 131 % 900).unwrap());
            let record =
                Record::new(event, actor, "10.0.0.7").with("block", format!("b{number}")).with("text", text);
            audit.append(&record).unwrap();
        }
        audit
    }

    #[test]
    fn pages_follow_each_other_without_a_gap() {
        let audit = audit(500);
        let (mut seen, mut before) = (Vec::new(), None);
        loop {
            let page = audit.page(&Filter { limit: Some(7), before, ..Filter::default() }).unwrap();
            seen.extend(page.records.iter().map(|record| record.seq));
            before = page.more;
            if before.is_none() {
                break;
            }
        }
        assert_eq!(seen, (1..=500).rev().collect::<Vec<_>>());
    }

    #[test]
    fn every_number_finds_its_place() {
        let audit = audit(40);
        for before in 0..=42 {
            let page = audit.page(&Filter { before: Some(before), ..Filter::default() }).unwrap();
            let first = page.records.first().map_or(0, |record| record.seq);
            assert_eq!(first, before.saturating_sub(1).min(40), "before {before}");
        }
    }

    #[test]
    fn a_filter_leaves_out_what_does_not_match() {
        let audit = audit(30);
        let count = |filter: Filter| audit.page(&filter).unwrap().records.len();
        let word = |text: &str| Some(text.to_owned());
        assert_eq!(count(Filter { event: word("write_denied"), ..Filter::default() }), 10);
        assert_eq!(count(Filter { actor: word("ben"), ..Filter::default() }), 15);
        assert_eq!(count(Filter { event: word("write_denied"), actor: word("ben"), ..Filter::default() }), 5);
        assert_eq!(count(Filter { block: word("b7"), ..Filter::default() }), 1);
        assert_eq!(count(Filter { from: word("2200"), ..Filter::default() }), 0);
        assert_eq!(count(Filter { to: word("2001"), ..Filter::default() }), 0);
        let today = audit.page(&Filter::default()).unwrap().records[0].at[..10].to_owned();
        assert_eq!(count(Filter { from: Some(today.clone()), to: Some(today), ..Filter::default() }), 30);
    }
}
