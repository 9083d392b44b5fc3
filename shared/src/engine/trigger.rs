//! When a block whose IN is TRUE triggers again.

use crate::plan::TriggerType;

use super::time::{Instant, Millis};

/// The periodic part of `TriggerType`: start to start, missed periods are skipped, errors do not stop it.
#[derive(Clone, Copy, Debug, Default)]
pub struct Trigger {
    kind: Option<TriggerType>,
    next: Option<Instant>,
}

impl Trigger {
    /// IN went TRUE and the first message starts now.
    pub fn start(&mut self, kind: TriggerType, now: Instant) {
        self.kind = Some(kind);
        self.next = match kind {
            TriggerType::Every(period) => Some(now + Millis(period.into())),
            // `Fast` is set again at the end of each message.
            TriggerType::Once | TriggerType::Fast => None,
        };
    }

    /// IN went FALSE.
    pub const fn stop(&mut self) {
        self.kind = None;
        self.next = None;
    }

    /// A message has ended.
    pub fn ended(&mut self, now: Instant) {
        if self.kind == Some(TriggerType::Fast) {
            self.next = Some(now + Millis(1));
        }
    }

    /// The type has changed, or is there at last, while IN is TRUE.
    pub fn change(&mut self, kind: TriggerType, busy: bool, now: Instant) {
        if self.kind != Some(kind) {
            self.start(kind, now);
            if !busy {
                self.ended(now);
            }
        }
    }

    /// Not before this: the target is known to be down.
    pub fn hold_back(&mut self, until: Instant) {
        self.next = self.next.map(|next| next.max(until));
    }

    /// When to look again.
    pub const fn next(&self) -> Option<Instant> {
        self.next
    }

    /// Whether it is time; if so, the next time is set, on the grid of the period.
    pub fn take(&mut self, now: Instant) -> bool {
        let Some(due) = self.next.filter(|next| *next <= now) else { return false };
        self.next = match self.kind {
            Some(TriggerType::Every(period)) => {
                let period = u64::from(period) * 1_000;
                let missed = now.micros_since(due) / period;
                Some(Instant(due.0 + (missed + 1) * period))
            }
            _ => None,
        };
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn periods_run_start_to_start_and_missed_ones_are_skipped() {
        let mut trigger = Trigger::default();
        trigger.start(TriggerType::Every(100), Instant(0));
        assert!(!trigger.take(Instant(99_999)));
        assert!(trigger.take(Instant(100_500)), "late by half a millisecond");
        assert_eq!(trigger.next(), Some(Instant(200_000)), "the grid does not drift");
        assert!(trigger.take(Instant(470_000)));
        assert_eq!(trigger.next(), Some(Instant(500_000)), "300 and 400 are skipped");
    }

    #[test]
    fn fast_is_the_next_millisecond_after_the_end() {
        let mut trigger = Trigger::default();
        trigger.start(TriggerType::Fast, Instant(0));
        assert_eq!(trigger.next(), None);
        trigger.ended(Instant(5_300));
        assert_eq!(trigger.next(), Some(Instant(6_300)));
        assert!(trigger.take(Instant(6_300)));
        assert_eq!(trigger.next(), None);
    }

    #[test]
    fn once_never_comes_again_and_a_stop_ends_all() {
        let mut trigger = Trigger::default();
        trigger.start(TriggerType::Once, Instant(0));
        trigger.ended(Instant(1));
        assert_eq!(trigger.next(), None);
        trigger.start(TriggerType::Every(2), Instant(0));
        trigger.stop();
        assert!(!trigger.take(Instant(u64::MAX)));
    }

    #[test]
    fn back_off_only_ever_delays() {
        let mut trigger = Trigger::default();
        trigger.start(TriggerType::Every(100), Instant(0));
        trigger.hold_back(Instant(5_000_000));
        assert!(!trigger.take(Instant(4_999_999)));
        assert!(trigger.take(Instant(5_000_000)));
        trigger.hold_back(Instant(0));
        assert_eq!(trigger.next(), Some(Instant(5_100_000)));
    }
}
