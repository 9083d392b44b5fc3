//! What is written to a device is on record: while the disk is full, and when the relay is killed.

use std::path::Path;
use std::time::{Duration, Instant};

use cipdeck_relay::simulate;
use cipdeck_shared::sim::SimConfig;
use cipdeck_tests::PATIENCE;
use cipdeck_tests::block::{self, with};
use cipdeck_tests::command::{Service, cipdeck};
use cipdeck_tests::fake_plc::{self, FakePlc};
use cipdeck_tests::measure::measured;
use cipdeck_tests::rest::Rest;
use cipdeck_tests::viewer::Viewer;
use cipdeck_tests::wait::{eventually, eventually_every};
use serde_json::{Value, json};
use tempfile::TempDir;
use tokio::net::TcpListener;

/// The writes that a device has got.
fn writes(plc: &FakePlc) -> Vec<Vec<u8>> {
    plc.messages().into_iter().filter(|message| message[0] == 0x10).collect()
}

/// The records of an event.
fn records(folder: &Path, event: &str) -> Vec<Value> {
    let text = std::fs::read_to_string(folder.join("audit.jsonl")).expect("the audit");
    let records = text.lines().map(|line| serde_json::from_str::<Value>(line).expect("whole lines"));
    records.filter(|record| record["event"] == event).collect()
}

async fn is_unbroken(folder: &Path) {
    let verified = cipdeck(&["audit", "verify", "--data", folder.to_str().expect("UTF-8")]).await;
    assert!(verified.code == 0 && verified.stdout.contains("unbroken"), "{verified:?}");
}

async fn start(rest: &Rest, id: &str, ticket: Option<String>) {
    let command = match ticket {
        Some(ticket) => json!({ "IN": true, "ticket": ticket }),
        None => json!({ "IN": true }),
    };
    let reply = rest.post(&format!("blocks/{id}/in"), &command).await;
    assert_eq!(reply.status, 200, "{reply:?}");
}

#[tokio::test]
async fn what_cannot_be_recorded_is_not_written() {
    let folder = TempDir::new().expect("a temporary folder");
    let relay = Service::serve_with_limits("127.0.0.1:0", folder.path()).await;
    let rest = Rest::new(&relay.address);
    let plc = FakePlc::start(fake_plc::answering(&[1, 2, 3, 4])).await;
    let once = rest.create(&block::set(&plc.path(), 4, 150, 3, "0a0b0c0d")).await;
    let cyclic = with(block::set(&plc.path(), 4, 150, 4, "01"), "/CtrlCfg", json!({ "TriggerType": 20 }));
    let cyclic = rest.create(&cyclic).await;
    let read = rest.create(&block::product_name(&plc.path())).await;
    start(&rest, &cyclic, Some(rest.ticket(&cyclic, 1).await)).await;
    eventually("it writes", PATIENCE, async || (writes(&plc).len() >= 3).then_some(())).await;
    // Given while there was room.
    let ticket = rest.ticket(&once, 1).await;
    let mut viewer = Viewer::connect(&relay.address).await;
    assert!(viewer.access["stopped"].is_null(), "{}", viewer.access);

    // The disk is full: no file may become bigger than the audit is now.
    let size = std::fs::metadata(folder.path().join("audit.jsonl")).expect("the audit").len();
    relay.process.limit_files(Some(size));
    let stopped = |viewer: &mut Viewer| viewer.access["stopped"].as_str().map(str::to_owned);
    let why = viewer.wait_until("everybody is told why", PATIENCE, stopped).await;
    assert!(why.contains("audit"), "{why}");
    let fallen = |status: &Value| status["IN"] == false && status["cause"]["what"] == "not_permitted";
    viewer.status_where("the cyclic write ends", PATIENCE, &cyclic, fallen).await;
    let before = writes(&plc).len();
    for (path, command) in [
        (format!("blocks/{once}/run"), json!({ "ticket": ticket })),
        (format!("blocks/{once}/write"), json!({ "revision": 1 })),
    ] {
        let refused = rest.post(&path, &command).await;
        refused.is_problem(403, "not_permitted");
        assert!(
            refused.body["detail"].as_str().is_some_and(|detail| detail.contains("audit")),
            "{refused:?}"
        );
    }
    let state = rest.get("audit/state").await.body;
    assert!(state["writable"] == false && state["trouble"].is_string(), "{state}");
    for _ in 0..10 {
        assert_eq!(rest.run(&read).await["Q"], true, "reads go on");
    }
    assert_eq!(writes(&plc).len(), before, "the device has got nothing");
    assert!(!writes(&plc).iter().any(|write| write.ends_with(&[10, 11, 12, 13])));

    relay.process.limit_files(None);
    let goes_on = |viewer: &mut Viewer| viewer.access["stopped"].is_null().then_some(());
    viewer.wait_until("there is room again", PATIENCE, goes_on).await;
    let used = rest.post(&format!("blocks/{once}/run"), &json!({ "ticket": ticket })).await;
    used.is_problem(403, "not_permitted");
    let command = json!({ "ticket": rest.ticket(&once, 1).await });
    let status = rest.post(&format!("blocks/{once}/run"), &command).await;
    assert_eq!((status.status, &status.body["Q"]), (200, &json!(true)), "{status:?}");
    let writes = writes(&plc);
    assert_eq!(writes.iter().filter(|write| write.ends_with(&[10, 11, 12, 13])).count(), 1);
    is_unbroken(folder.path()).await;
    assert_eq!(records(folder.path(), "write_permitted").len(), writes.len(), "each is on record");
    assert_eq!(records(folder.path(), "audit_resumed").len(), 1);
}

/// Devices that are read meanwhile, so that over 1,000 runs end in a second.
const TARGETS: usize = 8;

#[tokio::test]
async fn a_killed_relay_has_a_record_of_every_write_that_the_device_got() {
    let folder = TempDir::new().expect("a temporary folder");
    let mut relay = Service::serve("127.0.0.1:0", folder.path()).await;
    let rest = Rest::new(&relay.address);
    let fast =
        |block: Value| with(with(block, "/CtrlCfg", json!({ "TriggerType": 1 })), "/Channel", "monitor");
    let mut readers = Vec::new();
    for _ in 0..TARGETS {
        let listener = TcpListener::bind(("127.0.0.1", 0)).await.expect("a free port");
        let path = fake_plc::path(listener.local_addr().expect("the port that is bound"));
        tokio::spawn(simulate(listener, SimConfig::default()));
        readers.push(rest.create(&fast(block::product_name(&path))).await);
    }
    let plc = FakePlc::start(fake_plc::answering(&[])).await;
    let writer = rest.create(&fast(block::set(&plc.path(), 4, 150, 3, "01020304"))).await;
    for id in &readers {
        start(&rest, id, None).await;
    }
    start(&rest, &writer, Some(rest.ticket(&writer, 1).await)).await;
    let (blocks, began) = (rest.get("blocks").await.body, Instant::now());
    let runs = async || {
        let mut all = 0;
        for id in &readers {
            all += rest.get(&format!("blocks/{id}/status")).await.body["runs"].as_u64().unwrap_or(0);
        }
        all
    };
    let reads = eventually_every(Duration::from_millis(100), "many reads and writes", PATIENCE, async || {
        let is_long = began.elapsed() > Duration::from_secs(2) && writes(&plc).len() > 200;
        if is_long { Some(runs().await) } else { None }
    })
    .await;
    let (written, took) = (writes(&plc).len(), began.elapsed());
    relay.process.kill();
    relay.process.ended(PATIENCE).await;

    is_unbroken(folder.path()).await;
    let relay = Service::serve("127.0.0.1:0", folder.path()).await;
    let rest = Rest::new(&relay.address);
    is_unbroken(folder.path()).await;
    assert_eq!(rest.get("blocks").await.body, blocks, "no block is lost");
    let status = rest.get(&format!("blocks/{writer}/status")).await.body;
    assert_eq!(
        (&status["IN"], &status["runs"]),
        (&json!(false), &json!(0)),
        "it does not begin again: {status}"
    );
    // What it had sent has arrived meanwhile.
    let (got, recorded) = (writes(&plc).len(), records(folder.path(), "write_permitted").len());
    measured(format!(
        "{reads} reads and {written} writes in {took:?} before the kill; {got} writes got, {recorded} recorded"
    ));
    assert!(got >= written && got <= recorded, "{got} writes got, {recorded} recorded");
    assert!(recorded - got <= 1, "one at most was recorded and not sent: {got} of {recorded}");
}
