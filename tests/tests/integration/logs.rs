//! What the log has: who was refused and why, once; and bytes of devices at the finest level alone.

use cipdeck_tests::fake_plc::{self, FakePlc};
use cipdeck_tests::managed::Managed;
use cipdeck_tests::rest::Rest;
use cipdeck_tests::{PATIENCE, block};
use serde_json::json;

/// Bytes that nothing else in a log looks like, and how they could be written there.
const WRITTEN: (&str, [&str; 3]) =
    ("deadbeefcafe0123", ["deadbeef", "de ad be ef", "222, 173, 190, 239, 202, 254"]);

/// Writes to a device, stops the relay, and gives its log.
async fn log_of_a_write(level: &str) -> String {
    let mut relay = Managed::start_with(&["--log", level], |address, _| Rest::new(address)).await;
    let engineer = relay.user("engineer").await;
    let plc = FakePlc::start(fake_plc::answering(&[])).await;
    let id = engineer.create(&block::set(&plc.path(), 4, 150, 3, WRITTEN.0)).await;
    let ticket = engineer.ticket(&id, 1).await;
    let status = engineer.post(&format!("blocks/{id}/run"), &json!({ "ticket": ticket })).await;
    assert_eq!((status.status, &status.body["Q"]), (200, &json!(true)), "{status:?}");
    relay.process.interrupt();
    relay.process.ended(PATIENCE).await;
    relay.process.output().join("\n")
}

#[tokio::test]
async fn what_goes_to_a_device_is_logged_at_the_finest_level_alone() {
    let found = |log: &str| WRITTEN.1.iter().filter(|bytes| log.contains(**bytes)).count();
    let debug = log_of_a_write("debug").await;
    assert!(debug.contains("DEBUG") && found(&debug) == 0, "{debug}");
    let trace = log_of_a_write("trace").await;
    assert!(found(&trace) > 0, "this test knows how bytes look in a log");
}

#[tokio::test]
async fn who_is_refused_is_in_the_log_once_with_where_and_why() {
    let mut relay = Managed::start().await;
    let viewer = relay.user("viewer").await;
    viewer.post("blocks/b1/run", &json!({})).await.is_problem(403, "not_permitted");
    viewer.post("check", &json!(["my-secret"])).await.is_problem(400, "unreadable");
    relay.process.interrupt();
    relay.process.ended(PATIENCE).await;
    let log = relay.process.output();
    let refused: Vec<_> =
        log.iter().filter(|line| line.contains("refused") && line.contains("viewer")).collect();
    assert_eq!(refused.len(), 2, "{log:#?}");
    for (line, words) in refused.iter().zip([
        ["WARN", "127.0.0.1", "/api/v1/blocks/{id}/run", "a viewer looks and sends nothing"],
        ["INFO", "127.0.0.1", "/api/v1/check", "it could not be read"],
    ]) {
        assert!(words.iter().all(|word| line.contains(word)), "{line}");
    }
    assert!(!log.join("\n").contains("my-secret"), "what could not be read is not repeated");
}
