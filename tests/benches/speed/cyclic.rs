//! 1,000 cyclic blocks at 100 ms over 50 simulated targets, on the channel `monitor` of a relay.

use std::collections::HashMap;
use std::time::{Duration, Instant};

use cipdeck_tests::block;
use cipdeck_tests::rest::Rest;
use cipdeck_tests::viewer::Viewer;
use serde_json::Value;

use crate::load::percentile;
use crate::relay::RelayProcess;
use crate::target::{Kind, Targets};
use crate::way::number;

const BLOCKS: usize = 1_000;
const TARGETS: usize = 50;

/// ms and µs.
const PERIOD: u32 = 100;
const PERIOD_US: u64 = PERIOD as u64 * 1_000;

/// What is known of one block.
#[derive(Debug, Default)]
struct Beats {
    /// `runs` when it was seen last.
    runs: u64,
    /// When the messages began, µs of the day.
    begins: Vec<u64>,
}

/// What is known of all.
#[derive(Debug, Default)]
struct Seen {
    blocks: HashMap<String, Beats>,
    errors: u64,
}

/// Lets them run and prints how late they begin and what the relay needs.
pub(crate) fn table(quick: bool) -> String {
    let time = Duration::from_secs(if quick { 3 } else { 20 });
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().expect("a runtime");
    let elsewhere = usize::from(std::thread::available_parallelism().map_or(1, usize::from) > 1);
    let targets = Targets::start(Kind::Simulated, TARGETS, elsewhere);
    let relay = RelayProcess::start(0);
    let (seen, elapsed, used) = runtime.block_on(async {
        let rest = Rest::new(relay.address);
        let mut ids = Vec::new();
        for number in 0..BLOCKS {
            let target = targets.addresses[number % TARGETS];
            let block = block::get(&format!("4,{target}"), 1, 1, 1);
            let block = block::with(block, "/Channel", "monitor");
            ids.push(
                rest.create(&block::with(block, "/CtrlCfg", serde_json::json!({"TriggerType": PERIOD})))
                    .await,
            );
        }
        let mut viewer = Viewer::connect(relay.address).await;
        for id in &ids {
            viewer.set_in(id, true).await;
        }
        // Sessions are being opened: not the steady state.
        watch(&mut viewer, Duration::from_secs(1)).await;
        let (before, since) = (relay.time(), Instant::now());
        let seen = watch(&mut viewer, time).await;
        (seen, since.elapsed(), relay.time().saturating_sub(before))
    });
    text(&seen, elapsed, used)
}

async fn watch(viewer: &mut Viewer, time: Duration) -> Seen {
    let mut seen = Seen::default();
    let end = Instant::now() + time;
    // Statuses are kept by block: one is looked at once, when it has changed.
    while Instant::now() < end {
        viewer.news().await;
        for (id, status) in &viewer.statuses {
            seen.look(id, status);
        }
    }
    seen
}

impl Seen {
    fn look(&mut self, id: &str, status: &Value) {
        let beats = match self.blocks.get_mut(id) {
            Some(beats) => beats,
            None => self.blocks.entry(id.to_owned()).or_default(),
        };
        let runs = status["runs"].as_u64().unwrap_or_default();
        let ended = status["phase"] == "done" || status["phase"] == "failed";
        if runs == beats.runs || !ended {
            return;
        }
        beats.runs = runs;
        beats.begins.extend(begin(status));
        self.errors += u64::from(status["Status"]["Error"] == true);
    }

    /// From the grid to the begin of all messages, µs, sorted.
    fn late(&self) -> Vec<u64> {
        let mut late: Vec<u64> = self.blocks.values().flat_map(Beats::late).collect();
        late.sort_unstable();
        late
    }
}

impl Beats {
    /// Nobody here knows when the relay took the command that started the grid. Most messages begin in time: so the
    /// grid goes through the earliest begins around the middle of all.
    fn late(&self) -> Vec<u64> {
        let place = |begin: u64, origin: u64| (begin + PERIOD_US - origin % PERIOD_US) % PERIOD_US;
        let Some(first) = self.begins.first() else { return Vec::new() };
        // Half a period before the middle, so that early and late lie in one row.
        let mut places: Vec<u64> =
            self.begins.iter().map(|begin| place(*begin, *first + PERIOD_US / 2)).collect();
        places.sort_unstable();
        let middle = places.get(places.len() / 2).copied().unwrap_or_default();
        let origin = first + middle;
        let mut places: Vec<u64> = self.begins.iter().map(|begin| place(*begin, origin)).collect();
        places.sort_unstable();
        let earliest = places.get(places.len() / 50).copied().unwrap_or_default();
        places.into_iter().map(|place| place.saturating_sub(earliest)).collect()
    }
}

/// When the message began: its end less how long it took; µs of the day.
fn begin(status: &Value) -> Option<u64> {
    let at = status["at"].as_str()?.split_once('T')?.1;
    let mut parts = at.trim_end_matches('Z').split([':', '.']).map(|part| part.parse::<u64>().ok());
    let mut next = || parts.next().flatten();
    let end = ((next()? * 60 + next()?) * 60 + next()?) * 1_000_000 + next()?;
    end.checked_sub(status["elapsed_us"].as_u64()?)
}

fn text(seen: &Seen, elapsed: Duration, used: Duration) -> String {
    let sorted = seen.late();
    let late = |percent| percentile(&sorted, percent) / 1_000.0;
    format!(
        "### {BLOCKS} cyclic blocks every {PERIOD} ms, {TARGETS} simulated targets, channel `monitor`\n\n\
         | | |\n| --- | ---: |\n\
         | messages seen in {:.1} s | {} of {:.0} |\n\
         | errors | {} |\n\
         | lateness of the begin p50 | {:.2} ms |\n\
         | lateness of the begin p99 | {:.2} ms |\n\
         | processor time of the relay | {:.0} % of one processor |\n",
        elapsed.as_secs_f64(),
        sorted.len(),
        number(BLOCKS) * elapsed.as_secs_f64() * 1_000.0 / f64::from(PERIOD),
        seen.errors,
        late(50),
        late(99),
        100.0 * used.as_secs_f64() / elapsed.as_secs_f64(),
    )
}
