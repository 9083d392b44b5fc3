//! Two people watch a cyclic block while its target goes and comes.

use std::time::{Duration, Instant};

use cipdeck_tests::PATIENCE;
use cipdeck_tests::block::{self, with};
use cipdeck_tests::browser::{Browser, Journey, part};
use cipdeck_tests::measure::measured;
use cipdeck_tests::peers::CiplinkAdapter;
use cipdeck_tests::relay::Relay;
use serde_json::json;

const PERIOD: Duration = Duration::from_millis(100);
const TIMEOUT: Duration = Duration::from_secs(1);
/// What two browsers on a busy machine may add until the page has shown it and WebDriver has read it.
const GRACE: Duration = Duration::from_secs(2);

#[tokio::test]
async fn both_see_it_turn_red_and_green_again() {
    let relay = Relay::start().await;
    let adapter = CiplinkAdapter::start();
    let port = adapter.address().port();
    let block = with(block::product_name(&adapter.path()), "/CtrlCfg", json!({ "TriggerType": 100 }));
    relay.rest.create(&with(block, "/TargetCfg/UcmmTimeout", 1000)).await;
    let journey = Journey::start("cyclic").await;
    let mut engineer = journey.open("engineer", &relay.page()).await;
    let mut operator = journey.open("operator", &relay.page()).await;
    operator.click("Monitor").await;
    engineer.click("get-1-1-7").await;
    engineer.click_part("in-switch").await;
    runs_above(&operator, 5).await;
    both(&mut engineer, &mut operator, "done", PATIENCE).await;
    shots(&mut engineer, &mut operator, "running").await;

    let killed = Instant::now();
    drop(adapter);
    both(&mut engineer, &mut operator, "failed", TIMEOUT + PERIOD + GRACE).await;
    measured(format!("two browsers: red {:?} after the target was killed", killed.elapsed()));
    shots(&mut engineer, &mut operator, "target-killed").await;
    let before = runs(&operator).await.expect("a number of runs");

    let started = Instant::now();
    let _adapter = CiplinkAdapter::listen(port);
    both(&mut engineer, &mut operator, "done", Duration::from_secs(6)).await;
    measured(format!("two browsers: green {:?} after the target was started again", started.elapsed()));
    runs_above(&operator, before).await;
    shots(&mut engineer, &mut operator, "target-started").await;

    engineer.click_part("in-switch").await;
    engineer.find("IN is off", &format!("{}[@aria-checked='false']", part("in-switch")), PATIENCE).await;
    engineer.close().await;
    operator.close().await;
}

async fn both(engineer: &mut Browser, operator: &mut Browser, phase: &str, limit: Duration) {
    let state = format!("//*[contains(@class, 'state') and normalize-space(.)='{phase}']");
    tokio::join!(engineer.find(phase, &state, limit), operator.find(phase, &state, limit));
}

async fn shots(engineer: &mut Browser, operator: &mut Browser, stage: &str) {
    engineer.shot(stage).await;
    operator.shot(stage).await;
}

async fn runs_above(operator: &Browser, number: u64) {
    let what = format!("more than {number} runs");
    operator.until(&what, PATIENCE, async |_| runs(operator).await.filter(|runs| *runs > number)).await;
}

async fn runs(operator: &Browser) -> Option<u64> {
    let script = "return document.querySelector('[data-test=monitor-row] .col-runs')?.textContent ?? ''";
    operator.script(script).await.as_str()?.parse().ok()
}
