//! No write without its record: with a full disk, and when the relay is killed in the middle.

use std::fs;
use std::path::Path;

use cipdeck_tests::PATIENCE;
use cipdeck_tests::block::{self, with};
use cipdeck_tests::command::{Service, cipdeck};
use cipdeck_tests::fake_plc::{self, FakePlc};
use cipdeck_tests::rest::Rest;
use cipdeck_tests::wait::eventually;
use serde_json::{Value, json};
use tempfile::TempDir;

fn audit_file(folder: &TempDir) -> std::path::PathBuf {
    folder.path().join("audit.jsonl")
}

fn records(folder: &TempDir, event: &str) -> Vec<Value> {
    let text = fs::read_to_string(audit_file(folder)).expect("the audit");
    // The last line may be in the making.
    let whole = text.lines().filter_map(|line| serde_json::from_str::<Value>(line).ok());
    whole.filter(|record| record["event"] == event).collect()
}

async fn verified(folder: &Path) {
    let ended = cipdeck(&["audit", "verify", "--data", folder.to_str().expect("UTF-8")]).await;
    assert_eq!(ended.code, 0, "{ended:?}");
}

fn writes(plc: &FakePlc) -> usize {
    plc.messages().iter().filter(|message| message.first() == Some(&0x10)).count()
}

#[tokio::test]
async fn while_the_audit_cannot_be_written_nothing_is_written_to_a_device_and_reads_go_on() {
    let folder = TempDir::new().expect("a temporary folder");
    let relay = Service::serve_with_limits("127.0.0.1:0", folder.path()).await;
    let rest = Rest::new(&relay.address);
    let plc = FakePlc::start(fake_plc::answering(&[])).await;
    let write = rest.create(&block::set(&plc.path(), 4, 150, 3, "01020304")).await;
    let read = rest.create(&block::get(&plc.path(), 4, 150, 3)).await;
    let ticket = rest.ticket(&write, 1).await;

    // No file may grow beyond what the audit has now.
    let full = fs::metadata(audit_file(&folder)).expect("the audit").len();
    relay.process.limit_files(Some(full));
    let refused = rest.post(&format!("blocks/{write}/run"), &json!({ "ticket": ticket })).await;
    // Refused at once, or at the gate: then the message that was begun says so.
    let words = refused.body.to_string();
    assert!(words.contains("not_permitted") && words.contains("audit"), "{refused:?}");
    assert_eq!(writes(&plc), 0, "the device has got nothing");
    let state = rest.get("audit/state").await.body;
    assert_eq!(state["writable"], false, "{state}");
    assert!(state["trouble"].as_str().is_some_and(|words| words.contains("writes to devices are stopped")));
    assert_eq!(rest.run(&read).await["Q"], true, "reads go on");

    relay.process.limit_files(None);
    eventually("the audit goes on by itself", PATIENCE, async || {
        (rest.get("audit/state").await.body["writable"] == true).then_some(())
    })
    .await;
    let ticket = rest.ticket(&write, 1).await;
    let run = rest.post(&format!("blocks/{write}/run"), &json!({ "ticket": ticket })).await;
    assert_eq!((run.status, &run.body["Q"]), (200, &json!(true)), "{run:?}");
    assert_eq!((writes(&plc), records(&folder, "write_permitted").len()), (1, 1));
    assert_eq!(records(&folder, "audit_resumed").len(), 1, "what was lost in between is counted");
    verified(folder.path()).await;
}

#[tokio::test]
async fn a_killed_relay_has_a_record_of_every_write_that_a_device_has_got() {
    let folder = TempDir::new().expect("a temporary folder");
    let mut relay = Service::serve("127.0.0.1:0", folder.path()).await;
    let rest = Rest::new(&relay.address);
    let plc = FakePlc::start(fake_plc::answering(&[])).await;
    let fast = with(block::set(&plc.path(), 4, 150, 3, "01"), "/CtrlCfg", json!({ "TriggerType": 1 }));
    let id = rest.create(&fast).await;
    let ticket = rest.ticket(&id, 1).await;
    let on = rest.post(&format!("blocks/{id}/in"), &json!({ "IN": true, "ticket": ticket })).await;
    assert_eq!(on.status, 200, "{on:?}");
    eventually("it writes", PATIENCE, async || (writes(&plc) >= 50).then_some(())).await;
    relay.process.kill();
    relay.process.ended(PATIENCE).await;

    let (got, permitted) = (writes(&plc), records(&folder, "write_permitted").len());
    assert!(permitted >= got && got >= 50, "{permitted} records of {got} writes");
    let relay = Service::serve("127.0.0.1:0", folder.path()).await;
    let state = Rest::new(&relay.address).get("audit/state").await.body;
    assert_eq!((&state["writable"], &state["verified"]), (&json!(true), &json!(true)), "{state}");
    verified(folder.path()).await;
}
