//! Good and bad over time, one stripe per bucket: a failure among a thousand successes has to be seen.

use cipdeck_shared::api::{HistoryBucket, HistoryTrend};
use yew::prelude::*;

use super::chart::{LEFT, WIDTH, across, buckets, fixed, times};
use crate::office::i18n::tr;

const HEIGHT: f64 = 60.0;
/// Of the stripes.
const TALL: f64 = 32.0;

/// Green where all was well, red from the bottom as high as the part that failed, at least a visible piece.
pub(super) fn strip(trend: &HistoryTrend) -> Html {
    let width = ((WIDTH - LEFT) / buckets(trend)).max(2.0);
    let (runs, failed) =
        trend.buckets.iter().fold((0, 0), |(runs, failed), it| (runs + it.runs, failed + it.failed));
    let stripe = |it: &HistoryBucket| {
        let x = fixed(across(trend, it.index) - width / 2.0);
        let bad = bad_height(it);
        html! { <>
            <rect class="good" x={x.clone()} y="4" width={fixed(width)} height={fixed(TALL)} />
            if bad > 0.0 {
                <rect class="bad" {x} y={fixed(4.0 + TALL - bad)} width={fixed(width)} height={fixed(bad)} />
            }
        </> }
    };
    let words = tr!("chart.strip", runs = runs, failed = failed);
    html! {
        <figure class="chart" data-test="strip">
            <figcaption>{ words.clone() }</figcaption>
            <svg viewBox={format!("0 0 {WIDTH} {HEIGHT}")} role="img" aria-label={words}>
                { for trend.buckets.iter().map(stripe) }
                { times(trend, HEIGHT) }
            </svg>
        </figure>
    }
}

fn bad_height(it: &HistoryBucket) -> f64 {
    if it.failed == 0 {
        return 0.0;
    }
    #[expect(clippy::cast_precision_loss, reason = "a part of a height")]
    let part = it.failed as f64 / it.runs.max(1) as f64;
    (part * TALL).max(TALL / 4.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_failure_among_many_is_seen() {
        let bucket = |runs, failed| HistoryBucket { index: 0, runs, failed, reply_us: None, value: None };
        assert!(bad_height(&bucket(1_000, 0)) < 0.1);
        assert!((bad_height(&bucket(4, 4)) - TALL).abs() < 0.1);
        assert!(bad_height(&bucket(1_000, 1)) >= 8.0);
    }
}
