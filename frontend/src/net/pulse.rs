//! Whether the relay is still there: a socket whose other end has gone without a word looks as one over which nothing has
//! to be said. A machine without a clock; times are milliseconds of any one clock.

/// When a sign of life was seen last.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pulse {
    seen_ms: f64,
    looked_ms: f64,
}

impl Pulse {
    /// The relay has said something just now.
    pub(super) const fn new(now_ms: f64) -> Self {
        Self { seen_ms: now_ms, looked_ms: now_ms }
    }

    /// The relay has said something, or answered.
    pub(super) const fn seen(&mut self, now_ms: f64) {
        self.seen_ms = now_ms;
    }

    /// Whether there was no sign of life for too long. To be asked every [`LOOK_MS`], when the relay is asked for one, too.
    pub(super) fn is_lost(&mut self, now_ms: f64) -> bool {
        // Nobody has looked for a while: the computer has slept. What was not heard then says nothing.
        if now_ms - self.looked_ms > 2.0 * f64::from(LOOK_MS) {
            self.seen_ms = now_ms;
        }
        self.looked_ms = now_ms;
        now_ms - self.seen_ms > SILENT_MS
    }
}

/// ms between two looks.
pub(super) const LOOK_MS: u32 = 5_000;

/// ms without a sign of life: three questions without an answer.
const SILENT_MS: f64 = 14_000.0;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn three_questions_without_an_answer_are_too_many() {
        let mut pulse = Pulse::new(1_000.0);
        let looks = [6_000.0, 11_000.0, 16_000.0, 21_000.0].map(|now| pulse.is_lost(now));
        assert_eq!(looks, [false, false, true, true]);
    }

    #[test]
    fn whoever_answers_or_says_anything_is_there() {
        let mut pulse = Pulse::new(0.0);
        for look in 1..100 {
            let now = f64::from(look * LOOK_MS);
            assert!(!pulse.is_lost(now), "{now}");
            if look % 2 == 0 {
                pulse.seen(now + 10.0);
            }
        }
    }

    #[test]
    fn a_computer_that_slept_asks_first() {
        let mut pulse = Pulse::new(0.0);
        assert!(!pulse.is_lost(3_600_000.0), "nobody has asked since");
        assert!(!pulse.is_lost(3_605_000.0));
        assert!(!pulse.is_lost(3_610_000.0));
        assert!(pulse.is_lost(3_615_000.0), "and nobody has answered since");
    }
}
