//! The last numbers of one variable, as they were seen here.

use std::collections::VecDeque;

/// One number and when it was seen, in ms of [`crate::browser::now_ms`]; `None` where there was none to see.
pub type Point = (f64, Option<f64>);

/// Points in the order of their times; the oldest go first.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Series(VecDeque<Point>);

/// At ten values a second, an hour.
const CAPACITY: usize = 36_000;

impl Series {
    /// One more. A number that stays as it was is kept once, with its newest time beside the first.
    pub fn push(&mut self, at_ms: f64, number: Option<f64>) {
        let number = number.filter(|number| number.is_finite());
        let stays = self.0.len() >= 2 && self.0.iter().rev().take(2).all(|(_, last)| *last == number);
        if stays {
            self.0.pop_back();
        } else if self.0.len() == CAPACITY {
            self.0.pop_front();
        }
        self.0.push_back((at_ms, number));
    }

    /// Those in a time, and one before it, so that the line comes in from the edge.
    pub fn within(&self, from_ms: f64, to_ms: f64) -> impl Iterator<Item = Point> {
        let first = self.0.partition_point(|(at, _)| *at < from_ms).saturating_sub(1);
        self.0.iter().skip(first).copied().take_while(move |(at, _)| *at <= to_ms)
    }

    /// The number that held at a time.
    pub fn at(&self, at_ms: f64) -> Option<f64> {
        let next = self.0.partition_point(|(at, _)| *at <= at_ms);
        self.0.get(next.checked_sub(1)?)?.1
    }
}

/// Lines to draw: of each column of a drawing the first, the smallest, the biggest and the last number. A gap begins a
/// new line.
pub(super) fn lines(points: impl Iterator<Item = Point>, column_ms: f64) -> Vec<Vec<(f64, f64)>> {
    let mut lines = Vec::new();
    let mut line: Vec<(f64, f64)> = Vec::new();
    let mut column: Vec<(f64, f64)> = Vec::new();
    for (at, number) in points {
        let is_next = column.first().is_some_and(|(first, _)| at - first >= column_ms);
        if is_next || number.is_none() {
            thin(&mut column, &mut line);
        }
        match number {
            Some(number) => column.push((at, number)),
            None if !line.is_empty() => lines.push(std::mem::take(&mut line)),
            None => {}
        }
    }
    thin(&mut column, &mut line);
    if !line.is_empty() {
        lines.push(line);
    }
    lines
}

/// Moves the telling points of a column to its line.
fn thin(column: &mut Vec<(f64, f64)>, line: &mut Vec<(f64, f64)>) {
    if column.len() <= 4 {
        line.append(column);
        return;
    }
    let least = column.iter().enumerate().min_by(|one, other| one.1.1.total_cmp(&other.1.1));
    let most = column.iter().enumerate().max_by(|one, other| one.1.1.total_cmp(&other.1.1));
    let mut places = [0, least.map_or(0, |it| it.0), most.map_or(0, |it| it.0), column.len() - 1];
    places.sort_unstable();
    let mut before = None;
    for place in places {
        if before.replace(place) != Some(place) {
            line.extend(column.get(place));
        }
    }
    column.clear();
}

#[cfg(test)]
mod tests {
    use super::*;

    fn series(points: &[Point]) -> Series {
        let mut series = Series::default();
        for (at, number) in points {
            series.push(*at, *number);
        }
        series
    }

    #[test]
    fn a_number_that_stays_is_two_points() {
        let series = series(&[(0.0, Some(1.0)), (1.0, Some(1.0)), (2.0, Some(1.0)), (3.0, Some(2.0))]);
        let all: Vec<_> = series.within(0.0, 9.0).collect();
        assert_eq!(all, [(0.0, Some(1.0)), (2.0, Some(1.0)), (3.0, Some(2.0))]);
    }

    #[test]
    fn a_line_comes_in_from_the_edge() {
        let series = series(&[(0.0, Some(1.0)), (10.0, Some(2.0)), (20.0, Some(3.0)), (30.0, Some(4.0))]);
        let seen: Vec<_> = series.within(15.0, 25.0).map(|(at, _)| at).collect();
        assert_eq!(seen, [10.0, 20.0]);
        assert_eq!((series.at(-1.0), series.at(10.0), series.at(19.9)), (None, Some(2.0), Some(2.0)));
    }

    #[test]
    fn what_is_no_number_is_a_gap() {
        let series = series(&[(0.0, Some(1.0)), (1.0, Some(f64::NAN)), (2.0, Some(3.0))]);
        assert_eq!(series.at(1.5), None);
        assert_eq!(lines(series.within(0.0, 9.0), 0.1), [vec![(0.0, 1.0)], vec![(2.0, 3.0)]]);
    }

    #[test]
    fn a_column_keeps_its_extremes() {
        let points =
            (0..100).map(|n: u8| (f64::from(n), Some(if n == 50 { 99.0 } else { f64::from(n % 7) })));
        let all = lines(points, 1_000.0);
        assert!(all.len() == 1 && all[0].len() <= 4, "{all:?}");
        assert!(all[0].iter().any(|(_, number)| *number > 98.0));
        assert!(lines(std::iter::empty(), 1.0).is_empty());
    }

    #[test]
    fn the_oldest_go_first() {
        let mut series = Series::default();
        for n in 0..40_000_u32 {
            series.push(f64::from(n), Some(f64::from(n)));
        }
        assert_eq!(series.0.len(), CAPACITY);
        assert_eq!(series.at(3_999.0), None);
    }
}
