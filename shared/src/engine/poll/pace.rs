//! At most so many requests per second, evenly: what was not used is not saved up.

use crate::engine::time::Instant;

#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Pace {
    /// µs from one request to the next; 0 is no limit.
    interval: u64,
    /// Not before this.
    next: Instant,
}

impl Pace {
    pub(super) fn set(&mut self, requests_per_s: u32) {
        self.interval = 1_000_000_u64.checked_div(requests_per_s.into()).unwrap_or(0);
    }

    pub(super) fn allows(&self, now: Instant) -> bool {
        self.interval == 0 || self.next <= now
    }

    /// When the next request may be sent.
    pub(super) const fn next(&self) -> Instant {
        self.next
    }

    pub(super) fn sent(&mut self, now: Instant) {
        self.next = Instant(now.0.saturating_add(self.interval));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pause_earns_no_burst() {
        let mut pace = Pace::default();
        pace.set(10);
        assert!(pace.allows(Instant(5_000_000)));
        pace.sent(Instant(5_000_000));
        assert!(!pace.allows(Instant(5_099_999)));
        assert!(pace.allows(Instant(5_100_000)));
        pace.sent(Instant(60_000_000));
        assert!(!pace.allows(Instant(60_000_001)), "one, however long nobody asked");
    }

    #[test]
    fn no_limit_never_waits() {
        let mut pace = Pace::default();
        pace.set(0);
        pace.sent(Instant(7));
        assert!(pace.allows(Instant(7)));
    }
}
