//! Many targets and many blocks at once.

use cipdeck_tests::PATIENCE;
use cipdeck_tests::block::{self, with};
use cipdeck_tests::fake_plc::{self, FakePlc};
use cipdeck_tests::measure::measured;
use cipdeck_tests::relay::Relay;
use cipdeck_tests::wait::eventually;
use futures_util::future::join_all;
use serde_json::{Value, json};

/// A target whose answer is the request.
async fn mirror() -> FakePlc {
    FakePlc::start(fake_plc::messages(|request| {
        vec![fake_plc::Act::Send(request.success(request.frame.message()))]
    }))
    .await
}

fn on_monitor(path: &str, attribute: u32) -> Value {
    with(block::get(path, 1, 1, attribute), "/Channel", "monitor")
}

#[tokio::test]
async fn sixty_four_sessions_are_open_at_once() {
    let relay = Relay::start().await;
    let mut viewer = relay.viewer().await;
    let mut targets = Vec::new();
    for _ in 0..64 {
        targets.push(mirror().await);
    }
    for round in 1..=3 {
        let mut runs = Vec::new();
        for (number, target) in (1..).zip(&targets) {
            let attribute = 64 * round + number;
            let id = relay.rest.create(&on_monitor(&target.path(), attribute)).await;
            runs.push((viewer.submit(json!({ "type": "run", "block": id })).await, attribute));
        }
        for (run, attribute) in runs {
            let answer = viewer.answer(&run).await;
            assert_eq!(answer["status"]["ResData"], request(attribute), "{answer}");
        }
    }
    let open = relay.rest.get("targets").await.body;
    let open = open.as_array().expect("targets").iter().filter(|target| target["state"] == "open");
    assert_eq!(open.count(), 64);
    for target in &targets {
        assert!(target.requests().iter().all(|request| request.connection == 1), "one session each");
    }
}

/// Message router bytes of Get_Attribute_Single, Identity 1.
fn request(attribute: u32) -> String {
    let [low, high, ..] = attribute.to_le_bytes();
    if high == 0 {
        format!("0e03200124 0130{low:02x}")
    } else {
        format!("0e0420012401 3100{low:02x}{high:02x}")
    }
    .replace(' ', "")
}

const TARGETS: u32 = 50;
const BLOCKS: u32 = 1_000;
const PERIOD_MS: u32 = 1_000;

/// Each block three times at least, while all others run.
#[tokio::test]
async fn a_thousand_cyclic_blocks_over_fifty_targets_have_their_own_values() {
    let relay = Relay::start().await;
    let mut targets = Vec::new();
    for _ in 0..TARGETS {
        targets.push(mirror().await);
    }
    let mut blocks = Vec::new();
    for (attribute, target) in (1..=BLOCKS).zip(targets.iter().cycle()) {
        let block =
            with(on_monitor(&target.path(), attribute), "/CtrlCfg", json!({ "TriggerType": PERIOD_MS }));
        blocks.push((relay.rest.create(&block).await, request(attribute)));
    }
    for some in blocks.chunks(50) {
        let started = some.iter().map(async |(id, _)| {
            let reply = relay.rest.post(&format!("blocks/{id}/in"), &json!({ "IN": true })).await;
            assert_eq!(reply.status, 200, "{reply:?}");
        });
        join_all(started).await;
    }
    for (id, value) in &blocks {
        let ran = eventually("every block runs", PATIENCE, async || {
            let status = relay.rest.get(&format!("blocks/{id}/status")).await.body;
            assert_eq!(status["Status"]["Error"], false, "{status}");
            (status["runs"].as_u64() >= Some(3) && status["phase"] == "done").then_some(status)
        });
        let status = ran.await;
        assert_eq!(&status["ResData"], value, "{status}");
    }
    let answered: usize = targets.iter().map(|target| target.messages().len()).sum();
    measured(format!("{answered} messages of {BLOCKS} blocks at {TARGETS} targets"));
    for target in &targets {
        assert!(target.requests().iter().all(|request| request.connection == 1), "one session each");
    }
}
