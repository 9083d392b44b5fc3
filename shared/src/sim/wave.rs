//! Something that moves smoothly, without a floating point library.

use crate::engine::time::Instant;

/// A sine of the given period, from -1000 to 1000. Bhaskara's approximation: at most 0.2 % off.
pub(super) fn wave(now: Instant, period_millis: u64) -> i16 {
    let period = period_millis.max(1);
    let degrees = (now.0 / 1_000 % period) * 360 / period;
    let half = degrees % 180;
    let product = half * (180 - half);
    let height = i16::try_from(4_000 * product / (40_500 - product)).unwrap_or(0);
    if degrees < 180 { height } else { -height }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_wave_goes_up_and_down_once_a_period() {
        let rows = [(0, 0), (1_000, 1_000), (2_000, 0), (3_000, -1_000), (4_000, 0), (5_000, 1_000)];
        for (millis, height) in rows {
            assert_eq!(wave(Instant(millis * 1_000), 4_000), height, "{millis} ms");
        }
        assert!(wave(Instant(u64::MAX), 4_000) <= 1_000);
        assert_eq!(wave(Instant(0), 0), 0);
    }
}
