//! A small chart: the mean as a line, smallest to biggest as a band, both axes, and the same as a table for those who
//! listen.

use cipdeck_shared::api::{HistoryRange, HistoryTrend};
use yew::prelude::*;

use crate::{
    browser,
    kit::{Scale, short},
    office::i18n::tr,
};

/// Width of the drawing; it is stretched to its place.
pub(super) const WIDTH: f64 = 720.0;
const HEIGHT: f64 = 160.0;
/// Room for the numbers.
pub(super) const LEFT: f64 = 64.0;
const RIGHT: f64 = 8.0;
const TOP: f64 = 8.0;
const BOTTOM: f64 = 24.0;

/// What is drawn: a title, and a range per bucket in this unit.
pub(super) struct Line<'a> {
    pub(super) title: AttrValue,
    pub(super) test: &'static str,
    pub(super) points: Vec<(u32, &'a HistoryRange)>,
    /// Divides what the relay gives: 1,000 makes ms of µs.
    pub(super) divisor: f64,
}

/// The place of a bucket's middle.
pub(super) fn across(trend: &HistoryTrend, index: u32) -> f64 {
    LEFT + (f64::from(index) + 0.5) / buckets(trend) * (WIDTH - LEFT - RIGHT)
}

/// How many buckets the time has, also those without runs.
pub(super) fn buckets(trend: &HistoryTrend) -> f64 {
    let span_ms = browser::ms_of(&trend.to) - browser::ms_of(&trend.from);
    #[expect(clippy::cast_precision_loss, reason = "a length of time")]
    let bucket_ms = trend.bucket_us as f64 / 1_000.0;
    (span_ms / bucket_ms).ceil().max(1.0)
}

/// The chart; nothing where there are no numbers.
pub(super) fn chart(trend: &HistoryTrend, line: &Line<'_>) -> Html {
    let of = |number: f64| number / line.divisor;
    let numbers = line.points.iter().flat_map(|(_, range)| [of(range.min), of(range.max)]);
    let Some(scale) = Scale::covering(numbers, HEIGHT - TOP - BOTTOM) else { return html! {} };
    let y = |number: f64| TOP + scale.down(of(number));
    let tick = |number: f64| {
        let at = TOP + scale.down(number);
        html! { <>
            <line class="grid" x1={LEFT.to_string()} x2={(WIDTH - RIGHT).to_string()} y1={fixed(at)} y2={fixed(at)} />
            <text class="num" x={(LEFT - 6.0).to_string()} y={fixed(at + 4.0)}>{ short(number) }</text>
        </> }
    };
    let mean: Vec<_> =
        line.points.iter().map(|(index, range)| (across(trend, *index), y(range.mean))).collect();
    let upper = line.points.iter().map(|(index, range)| (across(trend, *index), y(range.max)));
    let lower = line.points.iter().rev().map(|(index, range)| (across(trend, *index), y(range.min)));
    let band = path(&upper.chain(lower).collect::<Vec<_>>());
    html! {
        <figure class="chart" data-test={line.test}>
            <figcaption>{ &line.title }</figcaption>
            <svg viewBox={format!("0 0 {WIDTH} {HEIGHT}")} role="img" aria-label={spoken(line)}>
                { for scale.ticks(4).into_iter().map(tick) }
                <path class="band" d={format!("{band}Z")} />
                <path class="mean" d={path(&mean)} />
                { for mean.iter().map(|(x, y)| html! { <circle class="point" cx={fixed(*x)} cy={fixed(*y)} r="1.8" /> }) }
                { times(trend, HEIGHT) }
            </svg>
        </figure>
    }
}

/// Begin and end under a drawing.
pub(super) fn times(trend: &HistoryTrend, height: f64) -> Html {
    let y = fixed(height - 6.0);
    html! { <>
        <text class="time" x={LEFT.to_string()} y={y.clone()}>{ browser::date_and_time(&trend.from) }</text>
        <text class="time end" x={(WIDTH - RIGHT).to_string()} {y}>{ browser::date_and_time(&trend.to) }</text>
    </> }
}

/// The chart in a sentence.
fn spoken(line: &Line<'_>) -> AttrValue {
    let all = || line.points.iter().map(|(_, range)| range);
    let min = all().fold(f64::INFINITY, |least, range| least.min(range.min)) / line.divisor;
    let max = all().fold(f64::NEG_INFINITY, |most, range| most.max(range.max)) / line.divisor;
    let last = all().next_back().map_or(0.0, |range| range.mean) / line.divisor;
    tr!("chart.spoken", title = line.title, min = short(min), max = short(max), last = short(last))
}

fn path(points: &[(f64, f64)]) -> String {
    let steps = points.iter().enumerate().map(|(number, (x, y))| {
        format!("{}{} {}", if number == 0 { 'M' } else { 'L' }, fixed(*x), fixed(*y))
    });
    steps.collect()
}

/// A tenth of a pixel is enough.
pub(super) fn fixed(number: f64) -> String {
    format!("{number:.1}")
}
