//! A cyclic block outlives its target.

use std::time::{Duration, Instant};

use cipdeck_tests::block::{self, with};
use cipdeck_tests::measure::measured;
use cipdeck_tests::peers::CiplinkAdapter;
use cipdeck_tests::relay::Relay;
use cipdeck_tests::{PATIENCE, viewer::Viewer};
use serde_json::{Value, json};

const PERIOD: Duration = Duration::from_millis(100);
const TIMEOUT: Duration = Duration::from_secs(1);
/// What a busy machine may add.
const GRACE: Duration = Duration::from_millis(500);

#[tokio::test]
async fn a_cyclic_block_turns_red_with_its_target_and_green_again() {
    let relay = Relay::start().await;
    let adapter = CiplinkAdapter::start();
    let port = adapter.address().port();
    let block = with(block::product_name(&adapter.path()), "/CtrlCfg", json!({ "TriggerType": 100 }));
    let id = relay.rest.create(&with(block, "/TargetCfg/UcmmTimeout", 1000)).await;
    let (mut one, mut two) = (relay.viewer().await, relay.viewer().await);
    one.set_in(&id, true).await;
    for viewer in [&mut one, &mut two] {
        viewer.status_where("it runs", PATIENCE, &id, |status| runs(status) >= 5 && good(status)).await;
    }

    let killed = Instant::now();
    drop(adapter);
    let before = both(&mut one, &mut two, "red", TIMEOUT + PERIOD + GRACE, &id, bad).await;
    measured(format!("red {:?} after the target was killed", killed.elapsed()));

    let started = Instant::now();
    let _adapter = CiplinkAdapter::listen(port);
    let after = both(&mut one, &mut two, "green again", Duration::from_secs(6), &id, good).await;
    measured(format!("green {:?} after the target was started again", started.elapsed()));
    assert!(runs(&after) > runs(&before));
    let more = runs(&after) + 5;
    both(&mut one, &mut two, "it goes on", PATIENCE, &id, |status| runs(status) >= more).await;

    one.set_in(&id, false).await;
    both(&mut one, &mut two, "EN falls with IN", PATIENCE, &id, |status| {
        status["Status"]["StatusBits"] == 16
    })
    .await;
}

#[tokio::test]
async fn the_period_is_kept() {
    let relay = Relay::start().await;
    let adapter = CiplinkAdapter::start();
    let block = with(block::product_name(&adapter.path()), "/CtrlCfg", json!({ "TriggerType": 100 }));
    let id = relay.rest.create(&block).await;
    let mut viewer = relay.viewer().await;
    viewer.set_in(&id, true).await;
    let started = Instant::now();
    viewer.status_where("20 periods", PATIENCE, &id, |status| runs(status) >= 21).await;
    let elapsed = started.elapsed();
    measured(format!("20 periods of 100 ms took {elapsed:?}"));
    assert!(elapsed >= PERIOD * 19, "start to start: {elapsed:?}");
    assert!(elapsed < PERIOD * 20 + GRACE, "no drift: {elapsed:?}");
}

/// Waits until both see it; what the second saw.
async fn both(
    one: &mut Viewer,
    two: &mut Viewer,
    what: &str,
    limit: Duration,
    id: &str,
    condition: impl Fn(&Value) -> bool + Copy,
) -> Value {
    one.status_where(what, limit, id, condition).await;
    two.status_where(what, limit, id, condition).await
}

fn runs(status: &Value) -> u64 {
    status["runs"].as_u64().unwrap_or_default()
}

fn good(status: &Value) -> bool {
    status["phase"] == "done"
}

fn bad(status: &Value) -> bool {
    status["phase"] == "failed"
}
