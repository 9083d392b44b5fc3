//! What has ended and is not written yet. Bounded: whoever ends a run never waits, what does not fit is counted.

use std::sync::{Arc, Condvar, Mutex};
use std::time::{Duration, SystemTime};

use cipdeck_shared::config::BlockId;
use cipdeck_shared::engine::{BlockView, Exchange};

use super::run::Run;
use crate::runner::lock;
use crate::wall_clock;

/// Runs that wait, at most: over a second of the fastest relay.
const MAX_RUNS: usize = 65_536;

/// Bytes that wait, at most.
const MAX_BYTES: usize = 32 * 1024 * 1024;

/// Where runs are handed over. Without a history they go nowhere.
#[derive(Clone, Debug, Default)]
pub(crate) struct Recorder(pub(super) Option<Arc<Buffer>>);

impl Recorder {
    /// A message has ended just now. Never waits for the disk.
    pub(crate) fn record(&self, block: BlockId, view: &BlockView, exchange: &Exchange) {
        if let Some(buffer) = &self.0 {
            buffer.push(Run::new(block, wall_clock::micros(SystemTime::now()), view, exchange));
        }
    }
}

/// Between the runner and the thread that writes.
#[derive(Debug, Default)]
pub(crate) struct Buffer {
    waiting: Mutex<Waiting>,
    changed: Condvar,
}

#[derive(Debug, Default)]
struct Waiting {
    runs: Vec<Run>,
    bytes: usize,
    lost: Option<Span>,
    closed: bool,
}

/// How many runs, and when the earliest and the latest of them ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Span {
    pub(super) runs: u64,
    pub(super) first_us: u64,
    pub(super) last_us: u64,
}

impl Span {
    pub(super) const fn of(at_us: u64) -> Self {
        Self { runs: 1, first_us: at_us, last_us: at_us }
    }

    pub(super) fn of_all(runs: &[Run]) -> Option<Self> {
        runs.iter().map(|run| Self::of(run.at_us)).reduce(Self::and)
    }

    pub(super) fn and(self, other: Self) -> Self {
        Self {
            runs: self.runs + other.runs,
            first_us: self.first_us.min(other.first_us),
            last_us: self.last_us.max(other.last_us),
        }
    }
}

/// What was waiting.
#[derive(Debug, Default)]
pub(super) struct Taken {
    pub(super) runs: Vec<Run>,
    /// What did not fit.
    pub(super) lost: Option<Span>,
    /// Nothing more will come.
    pub(super) closed: bool,
}

impl Buffer {
    /// Adds a run, or counts it where there is no room.
    pub(super) fn push(&self, run: Run) {
        let mut waiting = lock(&self.waiting);
        let bytes = waiting.bytes + run.weight();
        if waiting.runs.len() >= MAX_RUNS || bytes > MAX_BYTES {
            let span = Span::of(run.at_us);
            waiting.lost = Some(waiting.lost.map_or(span, |lost| lost.and(span)));
            return;
        }
        waiting.bytes = bytes;
        waiting.runs.push(run);
        let count = waiting.runs.len();
        drop(waiting);
        // The first one wakes the thread; half of the room is a reason to hurry.
        if count == 1 || count == MAX_RUNS / 2 {
            self.changed.notify_one();
        }
    }

    /// Waits up to `idle` for the first run, then lets others join it for `pace`; `empty` is used as the next buffer.
    pub(super) fn take(&self, idle: Duration, pace: Duration, empty: Vec<Run>) -> Taken {
        let nothing = |waiting: &mut Waiting| waiting.runs.is_empty() && !waiting.closed;
        let few = |waiting: &mut Waiting| waiting.runs.len() < MAX_RUNS / 2 && !waiting.closed;
        let wait = |waiting, limit, until: &dyn Fn(&mut Waiting) -> bool| match self
            .changed
            .wait_timeout_while(waiting, limit, until)
        {
            Ok((waiting, _)) => waiting,
            // A panic elsewhere leaves whole runs behind.
            Err(poisoned) => poisoned.into_inner().0,
        };
        let mut waiting = wait(lock(&self.waiting), idle, &nothing);
        if !waiting.runs.is_empty() {
            waiting = wait(waiting, pace, &few);
        }
        waiting.bytes = 0;
        Taken {
            runs: std::mem::replace(&mut waiting.runs, empty),
            lost: waiting.lost.take(),
            closed: waiting.closed,
        }
    }

    /// How many runs wait.
    pub(super) fn len(&self) -> usize {
        lock(&self.waiting).runs.len()
    }

    /// The thread ends when it has written everything.
    pub(super) fn close(&self) {
        lock(&self.waiting).closed = true;
        self.changed.notify_one();
    }
}

#[cfg(test)]
mod tests {
    use super::super::run::a_run;
    use super::*;

    fn take(buffer: &Buffer) -> Taken {
        buffer.take(Duration::ZERO, Duration::ZERO, Vec::new())
    }

    #[test]
    fn what_does_not_fit_is_counted_and_there_is_room_again_when_it_was_taken() {
        let buffer = Buffer::default();
        let most = u64::try_from(MAX_RUNS).unwrap();
        (0..most + 3).for_each(|at| buffer.push(a_run(1, at)));
        let taken = take(&buffer);
        assert_eq!(taken.runs.len(), MAX_RUNS);
        assert_eq!(taken.lost, Some(Span { runs: 3, first_us: most, last_us: most + 2 }));
        buffer.push(a_run(1, 9));
        let taken = take(&buffer);
        assert_eq!((taken.runs.len(), taken.lost, taken.closed), (1, None, false));
    }

    #[test]
    fn long_answers_count_by_their_bytes() {
        let buffer = Buffer::default();
        let long = Run { response: Some(vec![0; 10_000].into()), ..a_run(1, 1) };
        (0..4_000).for_each(|_| buffer.push(long.clone()));
        let taken = take(&buffer);
        assert_eq!(taken.runs.len(), MAX_BYTES / long.weight());
        assert_eq!(taken.lost.map(|lost| lost.runs), Some(4_000 - u64::try_from(taken.runs.len()).unwrap()));
    }

    #[test]
    fn the_end_is_told_with_what_is_left() {
        let buffer = Buffer::default();
        buffer.push(a_run(1, 1));
        buffer.close();
        let taken = buffer.take(Duration::from_mins(1), Duration::from_mins(1), Vec::new());
        assert_eq!((taken.runs.len(), taken.closed), (1, true));
    }
}
