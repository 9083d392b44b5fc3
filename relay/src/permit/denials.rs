//! Refused writes are recorded, but nobody fills the audit with them: a full disk would stop everybody's writes.

use std::collections::HashMap;
use std::sync::Mutex;
use std::time::Duration;

use tokio::time::Instant;

use crate::runner::lock;

/// How many refusals of each actor were recorded in this minute.
#[derive(Debug, Default)]
pub(super) struct Denials(Mutex<HashMap<String, Minute>>);

#[derive(Debug)]
struct Minute {
    began: Instant,
    recorded: u32,
    left_out: u64,
}

const MINUTE: Duration = Duration::from_mins(1);

/// Records of one actor in a minute.
const MOST: u32 = 100;

impl Denials {
    /// Whether one more is recorded, and how many were left out since the last one.
    pub(super) fn take(&self, actor: &str, now: Instant) -> Option<u64> {
        let mut minutes = lock(&self.0);
        minutes.retain(|_, minute| minute.left_out > 0 || now.duration_since(minute.began) < MINUTE);
        let fresh = || Minute { began: now, recorded: 0, left_out: 0 };
        let minute = minutes.entry(actor.to_owned()).or_insert_with(fresh);
        if now.duration_since(minute.began) >= MINUTE {
            (minute.began, minute.recorded) = (now, 0);
        }
        if minute.recorded >= MOST {
            minute.left_out += 1;
            return None;
        }
        minute.recorded += 1;
        Some(std::mem::take(&mut minute.left_out))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn refusals_are_recorded_up_to_a_hundred_a_minute_and_the_others_are_counted() {
        let (denials, now) = (Denials::default(), Instant::now());
        for _ in 0..MOST {
            assert_eq!(denials.take("anna", now), Some(0));
        }
        for _ in 0..7 {
            assert_eq!(denials.take("anna", now), None);
        }
        assert_eq!(denials.take("bert", now), Some(0), "each for themselves");
        assert_eq!(denials.take("anna", now + MINUTE), Some(7));
        assert_eq!(denials.take("anna", now + MINUTE), Some(0));
    }
}
