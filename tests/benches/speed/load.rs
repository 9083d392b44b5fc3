//! What is asked of a client, and what it did.

use std::net::SocketAddr;
use std::time::{Duration, Instant};

use clap::Args;
use serde::{Deserialize, Serialize};

use crate::way::{Way, number};

/// Each session sends one request after the other.
#[derive(Clone, Debug, Args)]
pub(crate) struct Load {
    /// How requests travel.
    #[arg(long, value_enum)]
    pub(crate) way: Way,
    /// One target per session.
    #[arg(long = "target", required = true)]
    pub(crate) targets: Vec<SocketAddr>,
    /// Before anything counts.
    #[arg(long, value_name = "MS", default_value_t = 100)]
    pub(crate) warm_up: u64,
    /// How long it counts.
    #[arg(long, value_name = "MS", default_value_t = 1_000)]
    pub(crate) measure: u64,
}

/// What all sessions of a client did while it counted.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub(crate) struct Sample {
    /// Requests that ended well, per second.
    pub(crate) per_second: f64,
    /// Median, µs.
    pub(crate) p50: f64,
    /// 99th percentile, µs.
    pub(crate) p99: f64,
    /// Processor time of the client, µs per request; warm-up included.
    pub(crate) cpu: f64,
}

/// When a session begins to count, and when it ends.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Window {
    start: Instant,
    end: Instant,
}

/// The durations of one session's requests.
#[derive(Debug, Default)]
pub(crate) struct Watch {
    /// ns each, of those that count.
    durations: Vec<u64>,
    all: u64,
}

impl Load {
    /// From now.
    pub(crate) fn window(&self) -> Window {
        let start = Instant::now() + Duration::from_millis(self.warm_up);
        Window { start, end: start + Duration::from_millis(self.measure) }
    }
}

impl Watch {
    /// A request that began at `since` has ended. The beginning of the next, unless the time is up.
    pub(crate) fn lap(&mut self, since: Instant, window: Window) -> Option<Instant> {
        let now = Instant::now();
        self.all += 1;
        if since >= window.start && now <= window.end {
            self.durations.push(u64::try_from((now - since).as_nanos()).unwrap_or(u64::MAX));
        }
        (now < window.end).then_some(now)
    }
}

/// All sessions together. `cpu` is the time that the process used.
pub(crate) fn sum(load: &Load, watches: Vec<Watch>, cpu: Duration) -> Sample {
    let all: u64 = watches.iter().map(|watch| watch.all).sum();
    let mut durations: Vec<u64> = watches.into_iter().flat_map(|watch| watch.durations).collect();
    durations.sort_unstable();
    Sample {
        per_second: number(durations.len()) * 1_000.0 / number(load.measure),
        p50: percentile(&durations, 50) / 1_000.0,
        p99: percentile(&durations, 99) / 1_000.0,
        cpu: cpu.as_secs_f64() * 1e6 / number(all.max(1)),
    }
}

/// Of sorted values; 0 without any.
pub(crate) fn percentile(sorted: &[u64], percent: usize) -> f64 {
    let last = sorted.len().saturating_sub(1);
    sorted.get(last * percent / 100).copied().map_or(0.0, number)
}

/// The middle one; 0 without any.
pub(crate) fn median(values: impl IntoIterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.into_iter().collect();
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or_default()
}
