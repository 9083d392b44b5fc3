//! What polling costs a device, in numbers that a person can judge.

use alloc::collections::VecDeque;

use crate::engine::time::Instant;

/// What polling costs a device.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Load {
    /// Requests since the beginning.
    pub requests: u64,
    /// Requests of the last round of due groups.
    pub requests_per_cycle: u32,
    /// How long that round took, µs: from its beginning to its last answer.
    pub cycle_us: u64,
    /// How late it began, µs.
    pub lateness_us: u64,
    /// Periods that were left out because the one before was not done, or nobody asked.
    pub skipped_periods: u64,
    /// Variables that are bad at the moment.
    pub bad_items: u32,
    /// Whether the last round had to wait for `max_requests_per_s`.
    pub is_limited: bool,
    /// Requests of the second before [`Poller::poll_request`](super::Poller::poll_request) was called last.
    pub last_second: u32,
}

/// Counts as the poller goes.
#[derive(Debug, Default)]
pub(super) struct Meter {
    pub(super) load: Load,
    /// The round under way.
    round: Option<Round>,
    /// When the requests of the last second were sent.
    sent: VecDeque<Instant>,
}

#[derive(Debug)]
struct Round {
    begun: Instant,
    requests: u32,
    limited: bool,
}

/// More than this in a second is not counted one by one.
const MAX_SENT: usize = 20_000;

impl Meter {
    /// Groups are due, the most delayed one for so long.
    pub(super) fn begin(&mut self, now: Instant, late_us: u64) {
        let lateness = if self.round.is_some() { self.load.lateness_us.max(late_us) } else { late_us };
        self.load.lateness_us = lateness;
        self.round.get_or_insert(Round { begun: now, requests: 0, limited: false });
    }

    pub(super) fn limited(&mut self) {
        if let Some(round) = &mut self.round {
            round.limited = true;
        }
    }

    pub(super) fn sent(&mut self, now: Instant) {
        self.load.requests += 1;
        if let Some(round) = &mut self.round {
            round.requests += 1;
        }
        if self.sent.len() < MAX_SENT {
            self.sent.push_back(now);
        }
        self.tick(now);
    }

    /// Forgets what is longer ago than a second.
    pub(super) fn tick(&mut self, now: Instant) {
        while self.sent.front().is_some_and(|first| now.micros_since(*first) >= SECOND) {
            self.sent.pop_front();
        }
        self.load.last_second = u32::try_from(self.sent.len()).unwrap_or(u32::MAX);
    }

    /// Nothing is left to ask.
    pub(super) fn end(&mut self, now: Instant) {
        if let Some(round) = self.round.take() {
            self.load.requests_per_cycle = round.requests;
            self.load.cycle_us = now.micros_since(round.begun);
            self.load.is_limited = round.limited;
        }
    }
}

/// µs
const SECOND: u64 = 1_000_000;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_round_counts_its_requests_and_its_time() {
        let mut meter = Meter::default();
        meter.begin(Instant(1_000), 7);
        meter.sent(Instant(1_000));
        meter.begin(Instant(1_500), 3);
        meter.sent(Instant(2_000));
        meter.limited();
        meter.end(Instant(2_600));
        let expected = Load {
            requests: 2,
            requests_per_cycle: 2,
            cycle_us: 1_600,
            lateness_us: 7,
            is_limited: true,
            last_second: 2,
            ..Load::default()
        };
        assert_eq!(meter.load, expected);
        meter.sent(Instant(900_000));
        meter.tick(Instant(1_002_000));
        assert_eq!(meter.load.last_second, 1);
        meter.tick(Instant(9_000_000));
        assert_eq!(meter.load.last_second, 0);
    }
}
