//! 20,000 variables of 40 simulated controllers, each read once a second through a relay.

use std::time::{Duration, Instant};

use cipdeck_tests::live::LiveViewer;
use cipdeck_tests::rest::Rest;
use serde_json::{Value, json};

use crate::load::percentile;
use crate::relay::RelayProcess;
use crate::target::{Kind, Targets};
use crate::way::number;

const DEVICES: usize = 40;

/// Of each device; the simulated Logix has as many.
const VARIABLES: usize = 500;

/// ms
const PERIOD: u32 = 1_000;

/// Until all sessions are open, and types and lengths are known.
const SETTLE: Duration = Duration::from_secs(5);

/// Lets them run and prints what the relay needs.
pub(crate) fn table(quick: bool) -> String {
    let time = Duration::from_secs(if quick { 5 } else { 30 });
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().expect("a runtime");
    let elsewhere = usize::from(std::thread::available_parallelism().map_or(1, usize::from) > 1);
    let targets = Targets::start(Kind::Logix, DEVICES, elsewhere);
    let relay = RelayProcess::start(0);
    runtime.block_on(async {
        let rest = Rest::new(relay.address);
        let empty = relay.memory();
        let mut groups = Vec::new();
        for (place, target) in targets.addresses.iter().enumerate() {
            groups.push(device(&rest, place, &target.to_string()).await);
        }
        let configured = relay.memory();
        for group in &groups {
            turn_on(&rest, group).await;
        }
        let mut nobody = LiveViewer::connect(relay.address).await;
        settle(&mut nobody, SETTLE).await;
        let alone = measure(&relay, &mut nobody, time).await;
        let mut viewer = LiveViewer::connect(relay.address).await;
        let all: Vec<&str> = groups.iter().map(|group| group["id"].as_str().expect("an id")).collect();
        viewer.watch(&all).await;
        settle(&mut viewer, Duration::from_secs(2)).await;
        let good = viewer.values.values().filter(|value| value["quality"] == "good").count();
        let watched = measure(&relay, &mut viewer, time).await;
        let per = |bytes: u64| number(bytes) / number(DEVICES * VARIABLES);
        format!(
            "### {} variables of {DEVICES} simulated controllers every {PERIOD} ms through a relay\n\n\
             | | nobody looks | one viewer watches all |\n| --- | ---: | ---: |\n\
             | processor time of the relay | {:.0} % of one | {:.0} % of one |\n\
             | lateness of the devices' rounds, p50 | {:.2} ms | {:.2} ms |\n\
             | lateness, the worst device | {:.2} ms | {:.2} ms |\n\
             | a round of one device, p50 | {:.1} ms | {:.1} ms |\n\
             | requests for a round of one device | {} | {} |\n\
             | periods left out | {} | {} |\n\n\
             {good} of {} values are good. Memory per variable: {:.0} bytes when configured, {:.0} bytes while read.\n",
            DEVICES * VARIABLES,
            alone.cpu,
            watched.cpu,
            alone.late(50),
            watched.late(50),
            alone.late(100),
            watched.late(100),
            alone.round_ms(),
            watched.round_ms(),
            alone.requests,
            watched.requests,
            alone.skipped,
            watched.skipped,
            DEVICES * VARIABLES,
            per(configured.saturating_sub(empty)),
            per(alone.memory.saturating_sub(empty)),
        )
    })
}

/// A device with its group, which is off.
async fn device(rest: &Rest, place: usize, target: &str) -> Value {
    let device =
        json!({ "name": format!("device {place}"), "path": format!("4,{target}"), "profile": "logix" });
    let device = made(rest, "devices", &device).await;
    let group = json!({ "device": device["id"], "name": "all", "period_ms": PERIOD });
    let group = made(rest, "groups", &group).await;
    let variable =
        |number: usize| json!({ "name": format!("D{number:04}"), "address": format!("D{number:04}") });
    let variables: Vec<_> = (0..VARIABLES).map(variable).collect();
    let path = format!("groups/{}/variables", group["id"].as_str().expect("an id"));
    made(rest, &path, &json!({ "variables": variables })).await;
    group
}

async fn turn_on(rest: &Rest, group: &Value) {
    let mut group = group.clone();
    group["on"] = json!(true);
    let path = format!("groups/{}", group["id"].as_str().expect("an id"));
    let reply = rest.put(&path, &group).await;
    assert_eq!(reply.status, 200, "{reply:?}");
}

async fn made(rest: &Rest, path: &str, body: &Value) -> Value {
    let reply = rest.post(path, body).await;
    assert_eq!(reply.status, 201, "{path}: {reply:?}");
    reply.body
}

/// What the relay did in a time.
#[derive(Debug, Default)]
struct Seen {
    /// % of one processor.
    cpu: f64,
    /// Bytes.
    memory: u64,
    /// µs, sorted.
    late: Vec<u64>,
    /// µs, sorted.
    rounds: Vec<u64>,
    requests: u64,
    skipped: u64,
}

impl Seen {
    fn late(&self, percent: usize) -> f64 {
        percentile(&self.late, percent) / 1_000.0
    }

    fn round_ms(&self) -> f64 {
        percentile(&self.rounds, 50) / 1_000.0
    }
}

async fn settle(viewer: &mut LiveViewer, time: Duration) {
    let end = Instant::now() + time;
    while Instant::now() < end {
        news(viewer).await;
    }
}

/// One message, if there is one soon.
async fn news(viewer: &mut LiveViewer) {
    let _ = tokio::time::timeout(Duration::from_millis(100), viewer.take()).await;
}

/// Statuses come as they change: each round is a sample of its device.
async fn measure(relay: &RelayProcess, viewer: &mut LiveViewer, time: Duration) -> Seen {
    let skipped = |viewer: &LiveViewer| -> u64 {
        viewer.statuses.values().filter_map(|status| status["load"]["skipped_periods"].as_u64()).sum()
    };
    let (before, begun, left_out) = (relay.time(), Instant::now(), skipped(viewer));
    let mut seen = Seen::default();
    while begun.elapsed() < time {
        news(viewer).await;
        for status in viewer.statuses.values() {
            seen.late.extend(status["load"]["lateness_us"].as_u64());
            seen.rounds.extend(status["load"]["cycle_us"].as_u64());
            seen.requests =
                seen.requests.max(status["load"]["requests_per_cycle"].as_u64().unwrap_or_default());
        }
    }
    seen.cpu = 100.0 * relay.time().saturating_sub(before).as_secs_f64() / begun.elapsed().as_secs_f64();
    seen.memory = relay.memory();
    seen.skipped = skipped(viewer) - left_out;
    seen.late.sort_unstable();
    seen.rounds.sort_unstable();
    seen
}
