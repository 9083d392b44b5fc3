//! The Monitor page with many blocks.

use std::time::Duration;

use cipdeck_tests::PATIENCE;
use cipdeck_tests::block::{self, with};
use cipdeck_tests::browser::{Browser, Journey};
use cipdeck_tests::measure::measured;
use cipdeck_tests::relay::Relay;
use serde_json::{Value, json};

const BLOCKS: u64 = 1000;
/// Cyclic, once a second each.
const CHANGING: u64 = 100;
/// The budget of the page, for the mean: single frames may wait for a processor that others use.
pub(crate) const BUDGET_MS: f64 = 8.0;

#[tokio::test]
async fn a_thousand_blocks_of_which_a_hundred_change_every_second() {
    let relay = Relay::start().await;
    for number in 1..=BLOCKS {
        let period = if number <= CHANGING { 1000 } else { 0 };
        let block = with(block::get("0,0", 147, 1, 9), "/CtrlCfg", json!({ "TriggerType": period }));
        let block = with(with(block, "/Channel", "monitor"), "/name", format!("block {number:04}"));
        relay.rest.create(&block).await;
    }
    let journey = Journey::start("monitor_1000").await;
    let mut user = journey.open("user", &relay.page()).await;
    user.click("Monitor").await;
    user.see("block 0001", PATIENCE).await;
    user.shot("idle").await;
    // Evenly over the period: one change every 10 ms, not a hundred at once.
    let mut pace = tokio::time::interval(Duration::from_millis(1000 / CHANGING));
    for number in 1..=CHANGING {
        pace.tick().await;
        let reply = relay.rest.post(&format!("blocks/b{number}/in"), &json!({ "IN": true })).await;
        assert_eq!(reply.status, 200, "{reply:?}");
    }
    user.see("done", PATIENCE).await;
    user.chromium("Performance.enable", json!({})).await;
    let (spent, all) = spent_in_frames(&user, 100.0).await;
    let stats = stats(&user).await;
    user.shot("live").await;

    measured(format!(
        "Monitor, {BLOCKS} blocks, {CHANGING} runs/s: script per frame, as the page counts: {stats}"
    ));
    measured(format!("Monitor: script per frame, as Chromium counts: {:.2} ms ({all} frames)", spent / all));
    let rows = user.script("return document.querySelectorAll('[data-test=monitor-row]').length").await;
    measured(format!("Monitor: {rows} rows are in the document"));
    assert!(rows.as_u64().is_some_and(|rows| rows < 100), "windowed: {rows}");
    assert!(spent / all < BUDGET_MS, "{} ms of script per frame", spent / all);

    user.click("Connections").await;
    user.see("Channel monitor", PATIENCE).await;
    let (spent, all) = spent_in_frames(&user, 100.0).await;
    user.shot("connections").await;
    measured(format!(
        "Connections: script per frame, as Chromium counts: {:.2} ms ({all} frames)",
        spent / all
    ));
    assert!(spent / all < BUDGET_MS, "{} ms of script per frame", spent / all);
    user.close().await;
}

/// Milliseconds of script while the page drew so many frames.
pub(crate) async fn spent_in_frames(user: &Browser, count: f64) -> (f64, f64) {
    let (before, frames_before) = (script_ms(user).await, frames(user).await);
    user.until("some frames", PATIENCE, async |_| {
        (frames(user).await >= frames_before + count).then_some(())
    })
    .await;
    (script_ms(user).await - before, frames(user).await - frames_before)
}

async fn stats(user: &Browser) -> Value {
    user.script("return window.cipdeckFrameStats()").await
}

async fn frames(user: &Browser) -> f64 {
    stats(user).await["frames"].as_f64().expect("a count of frames")
}

/// Milliseconds of script since the page was opened.
async fn script_ms(user: &Browser) -> f64 {
    let answer = user.chromium("Performance.getMetrics", json!({})).await;
    let metrics = answer["metrics"].as_array().into_iter().flatten();
    let mut script = metrics.filter(|metric| metric["name"] == "ScriptDuration");
    let seconds = script.next().and_then(|metric| metric["value"].as_f64());
    seconds.unwrap_or_else(|| panic!("ScriptDuration in {answer}")) * 1000.0
}
