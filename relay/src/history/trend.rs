//! The runs of a block over time, summed up for a chart.

use cipdeck_shared::api::{HistoryBucket, HistoryRange, HistoryTrend, HistoryValue};
use cipdeck_shared::config::BlockId;
use rusqlite::Connection;

use super::dropped::{self, Dropped};
use super::page::Asked;
use super::run::Run;
use super::values::Values;
use crate::wall_clock;

/// Runs that are summed up for one answer.
const MAX_RUNS: u64 = 1_000_000;

/// Names that are listed.
const MAX_NAMES: usize = 64;

/// What a chart shows.
#[derive(Clone, Debug)]
pub(crate) struct Chart {
    pub(crate) block: BlockId,
    /// µs since 1970; the end is later than the beginning.
    pub(crate) between: (u64, u64),
    /// How many buckets there may be, at least 1.
    pub(crate) points: u32,
    /// The name of the value; the first one that has numbers if `None`.
    pub(crate) value: Option<String>,
}

/// What is known of one bucket.
#[derive(Clone, Debug, Default)]
struct Bucket {
    runs: u64,
    failed: u64,
    reply_us: Sum,
    value: Sum,
}

/// Numbers, summed up.
#[derive(Clone, Copy, Debug, Default)]
struct Sum {
    count: u64,
    total: f64,
    min: f64,
    max: f64,
}

impl Sum {
    fn add(&mut self, number: f64) {
        let first = self.count == 0;
        self.count += 1;
        self.total += number;
        self.min = if first { number } else { self.min.min(number) };
        self.max = if first { number } else { self.max.max(number) };
    }

    #[expect(clippy::cast_precision_loss, reason = "at most MAX_RUNS")]
    fn range(self) -> Option<HistoryRange> {
        // The sum of huge numbers may be more than a number can be; JSON has no word for that.
        let mean = (self.total / self.count as f64).clamp(self.min, self.max);
        (self.count > 0).then_some(HistoryRange { min: self.min, mean, max: self.max })
    }
}

/// Sums up.
pub(super) fn trend(
    connection: &Connection,
    pending: &[Dropped],
    chart: Chart,
) -> rusqlite::Result<HistoryTrend> {
    let (from, to) = chart.between;
    let bucket_us = (to - from).div_ceil(u64::from(chart.points)).max(1);
    let mut summing = Summing { from, bucket_us, chosen: chart.value, ..Summing::default() };
    let asked = Asked { block: Some(chart.block), between: chart.between, q: None };
    let mut seen = 0;
    asked.chunks(connection, u64::MAX, |stored| {
        for run in stored.runs().filter(|run| asked.wants(run)) {
            summing.add(&run);
            seen += 1;
        }
        seen < MAX_RUNS
    })?;
    let view = |(index, bucket): (u32, Bucket)| HistoryBucket {
        index,
        runs: bucket.runs,
        failed: bucket.failed,
        reply_us: bucket.reply_us.range(),
        value: bucket.value.range(),
    };
    Ok(HistoryTrend {
        block: chart.block,
        from: wall_clock::of_micros(from),
        to: wall_clock::of_micros(to),
        bucket_us,
        value: summing.chosen,
        values: summing.names,
        buckets: (0..).zip(summing.buckets).filter(|(_, bucket)| bucket.runs > 0).map(view).collect(),
        complete: seen < MAX_RUNS,
        dropped: dropped::between(connection, pending, chart.between)?,
    })
}

#[derive(Debug, Default)]
struct Summing {
    from: u64,
    bucket_us: u64,
    chosen: Option<String>,
    names: Vec<String>,
    values: Values,
    buckets: Vec<Bucket>,
}

impl Summing {
    fn add(&mut self, run: &Run) {
        let at = usize::try_from((run.at_us - self.from) / self.bucket_us).unwrap_or(usize::MAX);
        // The end itself belongs to the last bucket; `points` bounds how many there are.
        if self.buckets.len() <= at {
            self.buckets.resize(at + 1, Bucket::default());
        }
        let values = self.values.of(run);
        let number = self.number(&values);
        let Some(bucket) = self.buckets.get_mut(at) else { return };
        bucket.runs += 1;
        bucket.failed += u64::from(!run.q);
        #[expect(clippy::cast_precision_loss, reason = "µs of a reply")]
        if let Some(reply_us) = run.reply_us {
            bucket.reply_us.add(reply_us as f64);
        }
        if let Some(number) = number {
            bucket.value.add(number);
        }
    }

    fn number(&mut self, values: &[HistoryValue]) -> Option<f64> {
        let mut chosen = None;
        for value in values {
            let Some(number) = value.number else { continue };
            if self.names.len() < MAX_NAMES && !self.names.contains(&value.name) {
                self.names.push(value.name.clone());
            }
            if self.chosen.get_or_insert_with(|| value.name.clone()) == &value.name {
                chosen = chosen.or(Some(number));
            }
        }
        chosen
    }
}
