//! Numbers to places on paper: pure, so that it can be tested.

/// From the smallest to the biggest number, along some length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scale {
    low: f64,
    high: f64,
    length: f64,
}

impl Scale {
    /// Covers these numbers, with a little room; a single number gets a range around it.
    pub fn covering(numbers: impl Iterator<Item = f64>, length: f64) -> Option<Self> {
        let (low, high) = numbers
            .filter(|number| number.is_finite())
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), number| {
                (low.min(number), high.max(number))
            });
        if low > high {
            return None;
        }
        let room = if high > low { (high - low) * 0.05 } else { (low.abs() * 0.1).max(1.0) };
        // What never goes below zero shall not seem to.
        let bottom = if low >= 0.0 { (low - room).max(0.0) } else { low - room };
        Some(Self { low: bottom, high: high + room, length })
    }

    /// The place of a number, from the end: paper counts downwards.
    pub fn down(&self, number: f64) -> f64 {
        self.length - (number - self.low) / (self.high - self.low) * self.length
    }

    /// Round numbers inside, about as many as asked for.
    pub fn ticks(&self, about: u32) -> Vec<f64> {
        let rough = (self.high - self.low) / f64::from(about.max(1));
        let magnitude = 10_f64.powf(rough.log10().floor());
        let step =
            [1.0, 2.0, 5.0, 10.0].map(|factor| factor * magnitude).into_iter().find(|step| *step >= rough);
        let step = step.unwrap_or(10.0 * magnitude);
        let first = (self.low / step).ceil();
        let fits = |tick: &f64| *tick <= self.high;
        (0..MOST_TICKS).map(|number| (first + f64::from(number)) * step).take_while(fits).collect()
    }
}

/// Against rounding that never ends.
const MOST_TICKS: u32 = 12;

/// A number as short as it can be read: `0.05`, `1200`, `1.2e9`.
pub fn short(number: f64) -> String {
    match number.abs() {
        0.0 => "0".to_owned(),
        0.001..1e7 => {
            let text = format!("{number:.3}");
            text.trim_end_matches('0').trim_end_matches('.').to_owned()
        }
        _ => format!("{number:.1e}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scale(numbers: &[f64]) -> Scale {
        Scale::covering(numbers.iter().copied(), 100.0).unwrap()
    }

    #[test]
    fn bigger_numbers_are_higher_up() {
        let scale = scale(&[0.0, 10.0]);
        assert!(scale.down(10.0) < scale.down(5.0) && scale.down(5.0) < scale.down(0.0));
        assert!((scale.down(0.0) - 100.0).abs() < 1e-9, "zero is the bottom where nothing is below it");
    }

    #[test]
    fn ticks_are_round_and_inside() {
        assert_eq!(scale(&[0.0, 10.0]).ticks(4), [0.0, 5.0, 10.0]);
        assert_eq!(scale(&[280.0, 950.0]).ticks(4), [400.0, 600.0, 800.0]);
        for numbers in [[5.0, 5.0], [-3.0, 4.0], [1e-9, 2e-9], [1e12, 3e12], [0.0, 0.0]] {
            let ticks = scale(&numbers).ticks(4);
            assert!((1..=8).contains(&ticks.len()), "{numbers:?}: {ticks:?}");
        }
    }

    #[test]
    fn nothing_has_no_scale() {
        assert_eq!(Scale::covering([].into_iter(), 100.0), None);
        assert_eq!(Scale::covering([f64::NAN].into_iter(), 100.0), None);
    }

    #[test]
    fn numbers_are_short() {
        for (number, text) in
            [(0.0, "0"), (0.05, "0.05"), (1_200.0, "1200"), (-2.5, "-2.5"), (1.2e9, "1.2e9")]
        {
            assert_eq!(short(number), text);
        }
    }
}
