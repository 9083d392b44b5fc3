//! Runs of one block with one request, packed.
//!
//! A run is: flags | µs since the one before, zigzag | what the flags name. Numbers are LEB128. A reply that equals the
//! one before is not repeated: a value that stays costs 10 bytes a run.

use std::sync::Arc;

use cipdeck_shared::config::BlockId;
use cipdeck_shared::engine::CauseKind;

use super::buffer::Span;
use super::run::{Run, What};

const Q: u8 = 1;
const REPLY_US: u8 = 1 << 1;
const ELAPSED_US: u8 = 1 << 2;
const STATUS: u8 = 1 << 3;
const CAUSE: u8 = 1 << 4;
const RESPONSE: u8 = 1 << 5;
const SAME_RESPONSE: u8 = 1 << 6;

const MAY_HAVE_ACTED: u8 = 1;
const HAS_ACTED: u8 = 1 << 1;

/// A chunk that is not added to any more: readers unpack whole chunks.
const FULL: usize = 32 * 1024;

/// A chunk that is being filled.
#[derive(Debug)]
pub(super) struct Chunk {
    pub(super) block: BlockId,
    pub(super) request: Arc<[u8]>,
    pub(super) span: Span,
    pub(super) failed: u64,
    pub(super) data: Vec<u8>,
    at_us: u64,
    response: Option<Arc<[u8]>>,
}

impl Chunk {
    /// With its first run.
    pub(super) fn new(run: &Run) -> Self {
        let mut chunk = Self {
            block: run.block,
            request: Arc::clone(&run.request),
            span: Span { runs: 0, ..Span::of(run.at_us) },
            failed: 0,
            data: Vec::new(),
            at_us: 0,
            response: None,
        };
        chunk.add(run);
        chunk
    }

    /// Whether a run of the same block belongs here.
    pub(super) fn takes(&self, run: &Run) -> bool {
        self.data.len() < FULL && (Arc::ptr_eq(&self.request, &run.request) || self.request == run.request)
    }

    /// Adds a run that [`Chunk::takes`].
    pub(super) fn add(&mut self, run: &Run) {
        let flags_at = self.data.len();
        let mut flags = 0;
        self.data.push(0);
        // Wraps around: the clock may be put anywhere.
        zigzag(&mut self.data, run.at_us.wrapping_sub(self.at_us).cast_signed());
        if run.q {
            flags |= Q;
        }
        for (flag, value) in [(REPLY_US, run.reply_us), (ELAPSED_US, run.elapsed_us)] {
            if let Some(value) = value {
                flags |= flag;
                number(&mut self.data, value);
            }
        }
        let status = [run.error_id, run.sub_error_id, run.ext_error_id];
        if status != [0; 3] {
            flags |= STATUS;
            for id in status {
                number(&mut self.data, id.into());
            }
        }
        if let Some(What { kind, may_have_acted, has_acted }) = &run.cause {
            flags |= CAUSE;
            let may = if *may_have_acted { MAY_HAVE_ACTED } else { 0 };
            self.data.push(may | if *has_acted { HAS_ACTED } else { 0 });
            text(&mut self.data, kind.word().as_bytes());
        }
        match &run.response {
            Some(response) if self.response.as_ref() == Some(response) => flags |= SAME_RESPONSE,
            Some(response) => {
                flags |= RESPONSE;
                text(&mut self.data, response);
                self.response = Some(Arc::clone(response));
            }
            None => {}
        }
        if let Some(byte) = self.data.get_mut(flags_at) {
            *byte = flags;
        }
        self.at_us = run.at_us;
        let span = Span { runs: self.span.runs, ..self.span.and(Span::of(run.at_us)) };
        self.span = Span { runs: span.runs + 1, ..span };
        self.failed += u64::from(!run.q);
    }
}

/// Runs in the order in which they ended, until the end or the first byte that makes no sense.
#[derive(Debug)]
pub(super) struct Runs<'a> {
    block: BlockId,
    request: Arc<[u8]>,
    rest: &'a [u8],
    at_us: u64,
    response: Option<Arc<[u8]>>,
}

impl<'a> Runs<'a> {
    /// The runs of a chunk's data.
    pub(super) const fn of(block: BlockId, request: Arc<[u8]>, data: &'a [u8]) -> Self {
        Self { block, request, rest: data, at_us: 0, response: None }
    }

    fn byte(&mut self) -> Option<u8> {
        let (byte, rest) = self.rest.split_first()?;
        self.rest = rest;
        Some(*byte)
    }

    fn number(&mut self) -> Option<u64> {
        let mut value = 0;
        for shift in (0..64).step_by(7) {
            let byte = self.byte()?;
            value |= u64::from(byte & 0x7F) << shift;
            if byte & 0x80 == 0 {
                return Some(value);
            }
        }
        None
    }

    fn small(&mut self) -> Option<u16> {
        u16::try_from(self.number()?).ok()
    }

    fn text(&mut self) -> Option<&'a [u8]> {
        let length = usize::try_from(self.number()?).ok()?;
        let (text, rest) = self.rest.split_at_checked(length)?;
        self.rest = rest;
        Some(text)
    }

    fn cause(&mut self) -> Option<What> {
        let acted = self.byte()?;
        let word = String::from_utf8_lossy(self.text()?).into_owned();
        let (may_have_acted, has_acted) = (acted & MAY_HAVE_ACTED != 0, acted & HAS_ACTED != 0);
        Some(What { kind: CauseKind::from(word), may_have_acted, has_acted })
    }

    fn run(&mut self) -> Option<Run> {
        let flags = self.byte()?;
        let delta = self.number()?;
        let delta = (delta >> 1).cast_signed() ^ -(delta & 1).cast_signed();
        self.at_us = self.at_us.wrapping_add(delta.cast_unsigned());
        let has = |flag| flags & flag != 0;
        let reply_us = if has(REPLY_US) { Some(self.number()?) } else { None };
        let elapsed_us = if has(ELAPSED_US) { Some(self.number()?) } else { None };
        let [error_id, sub_error_id, ext_error_id] =
            if has(STATUS) { [self.small()?, self.small()?, self.small()?] } else { [0; 3] };
        let cause = if has(CAUSE) { Some(self.cause()?) } else { None };
        if has(RESPONSE) {
            self.response = Some(self.text()?.into());
        }
        let response = if has(RESPONSE) || has(SAME_RESPONSE) { self.response.clone() } else { None };
        Some(Run {
            block: self.block,
            at_us: self.at_us,
            q: has(Q),
            error_id,
            sub_error_id,
            ext_error_id,
            cause,
            reply_us,
            elapsed_us,
            request: Arc::clone(&self.request),
            response,
        })
    }
}

impl Iterator for Runs<'_> {
    type Item = Run;

    fn next(&mut self) -> Option<Run> {
        let run = self.run();
        if run.is_none() {
            self.rest = &[];
        }
        run
    }
}

fn number(out: &mut Vec<u8>, mut value: u64) {
    while value >= 0x80 {
        out.push(u8::try_from(value & 0x7F).unwrap_or_default() | 0x80);
        value >>= 7;
    }
    out.push(u8::try_from(value).unwrap_or_default());
}

fn zigzag(out: &mut Vec<u8>, value: i64) {
    number(out, (value << 1 ^ value >> 63).cast_unsigned());
}

fn text(out: &mut Vec<u8>, bytes: &[u8]) {
    number(out, bytes.len() as u64);
    out.extend_from_slice(bytes);
}

#[cfg(test)]
mod tests {
    use super::super::run::{a_refused_run, a_run};
    use super::*;

    fn packed(runs: &[Run]) -> Chunk {
        let mut chunk = Chunk::new(&runs[0]);
        for run in &runs[1..] {
            assert!(chunk.takes(run));
            chunk.add(run);
        }
        chunk
    }

    fn unpacked(chunk: &Chunk) -> Vec<Run> {
        Runs::of(chunk.block, Arc::clone(&chunk.request), &chunk.data).collect()
    }

    #[test]
    fn runs_come_back_as_they_were() {
        let lost = What { kind: CauseKind::Timeout, may_have_acted: true, has_acted: false };
        let own =
            What { kind: CauseKind::Other("of_tomorrow".into()), may_have_acted: false, has_acted: true };
        let runs = [
            a_run(7, 1_795_300_285_000_000),
            a_run(7, 1_795_300_285_001_000),
            // The clock was put back.
            a_refused_run(7, 5),
            Run { response: None, reply_us: None, cause: Some(lost), ..a_refused_run(7, u64::MAX) },
            Run { cause: Some(own), elapsed_us: None, ext_error_id: 0xFFFF, ..a_refused_run(7, 0) },
            a_run(7, 6),
            Run { response: Some(Arc::from([])), reply_us: Some(u64::MAX), ..a_run(7, 6) },
        ];
        let chunk = packed(&runs);
        assert_eq!(unpacked(&chunk), runs);
        assert_eq!(chunk.span, Span { runs: 7, first_us: 0, last_us: u64::MAX });
        assert_eq!(chunk.failed, 3);
    }

    #[test]
    fn a_value_that_stays_costs_few_bytes() {
        let runs: Vec<Run> = (0..100).map(|number| a_run(7, number * 1_000)).collect();
        let chunk = packed(&runs);
        assert!(chunk.data.len() <= 10 * runs.len(), "{} bytes", chunk.data.len());
        assert_eq!(unpacked(&chunk), runs);
    }

    #[test]
    fn another_request_and_a_full_chunk_need_a_new_one() {
        let chunk = packed(&[a_run(7, 1)]);
        let other = Run { request: Arc::from([0x0E, 3, 0x20, 1, 0x24, 1, 0x30, 2]), ..a_run(7, 2) };
        assert!(!chunk.takes(&other));
        let long = Run { response: Some(vec![1; FULL].into()), ..a_run(7, 2) };
        assert!(!packed(&[a_run(7, 1), long]).takes(&a_run(7, 3)));
    }

    #[test]
    fn bytes_that_are_cut_or_changed_end_the_runs_and_nothing_else() {
        let chunk = packed(&[a_run(7, 1), a_refused_run(7, 2), a_run(7, 3)]);
        let all = unpacked(&chunk);
        for end in 0..chunk.data.len() {
            let read: Vec<Run> =
                Runs::of(chunk.block, Arc::clone(&chunk.request), &chunk.data[..end]).collect();
            assert_eq!(read, all[..read.len()], "{end}");
        }
        for at in 0..chunk.data.len() {
            for value in 0..=255 {
                let mut data = chunk.data.clone();
                data[at] = value;
                let _ = Runs::of(chunk.block, Arc::clone(&chunk.request), &data).count();
            }
        }
    }
}
