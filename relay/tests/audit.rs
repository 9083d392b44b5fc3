//! The audit as a person meets it: over the network, and at the command line.

#![expect(clippy::unwrap_used, reason = "a test ends where it fails")]

mod common;

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use cipdeck_relay::Settings;

use self::common::{Relay, local};

#[tokio::test]
async fn the_records_are_listed_told_about_and_exported() {
    let folder = tempfile::tempdir().unwrap();
    let relay = Relay::start(local(Settings::stored_in(folder.path()))).await;
    let page = relay.ask("GET", "/api/v1/audit?event=start", "").await.json();
    assert_eq!(page["records"][0]["actor"], "relay", "{page}");
    assert_eq!(page["records"].as_array().unwrap().len(), 1);
    let state = relay.ask("GET", "/api/v1/audit/state", "").await.json();
    assert_eq!((&state["writable"], &state["verified"]), (&true.into(), &true.into()), "{state}");
    assert_eq!(state["head"]["hash"], page["records"][0]["hash"]);
    let export = relay.ask("GET", "/api/v1/audit.jsonl", "").await;
    let text = fs::read_to_string(folder.path().join("audit.jsonl")).unwrap();
    assert!(export.headers.contains("application/x-ndjson"), "{export:?}");
    assert!(export.body.contains(text.trim()), "{export:?}");
    let refused = relay.ask("GET", "/api/v1/audit?evnt=start", "").await;
    assert_eq!(refused.problem(), (400, "unreadable".to_owned()));
    relay.stop().await;
}

#[tokio::test]
async fn verify_finds_one_changed_byte_and_accept_goes_on() {
    let folder = tempfile::tempdir().unwrap();
    let data = folder.path();
    Relay::start(local(Settings::stored_in(data))).await.stop().await;
    let relay = Relay::start(local(Settings::stored_in(data))).await;
    relay.ask("GET", "/api/v1/health", "").await;
    let unbroken = audit(&["verify"], data);
    assert!(said(&unbroken).starts_with("3 records, unbroken from "), "{unbroken:?}");
    assert_eq!(unbroken.status.code(), Some(0), "while a relay runs");
    relay.stop().await;

    let file = data.join("audit.jsonl");
    let text = fs::read_to_string(&file).unwrap();
    fs::write(&file, text.replacen("stop", "stoq", 1)).unwrap();
    let broken = audit(&["verify"], data);
    assert_eq!(broken.status.code(), Some(1));
    assert_eq!(said(&broken), "broken: line 2: its content does not match its hash\n");
    assert_eq!(audit(&["accept"], data).status.code(), Some(2), "no relay has found it yet");

    let relay = Relay::start(local(Settings::stored_in(data))).await;
    let state = relay.ask("GET", "/api/v1/audit/state", "").await.json();
    assert_eq!(state["writable"], false, "{state}");
    assert!(state["trouble"].as_str().unwrap().contains("cipdeck audit accept"), "{state}");
    let folder = data.to_owned();
    let accepted = tokio::task::spawn_blocking(move || audit(&["accept"], &folder)).await.unwrap();
    assert!(said(&accepted).ends_with("writes go on\n"), "{accepted:?}");
    let state = relay.ask("GET", "/api/v1/audit/state", "").await.json();
    assert_eq!(state["writable"], true, "{state}");
    relay.stop().await;
    assert_eq!(audit(&["verify"], data).status.code(), Some(0));
}

#[tokio::test]
async fn an_exported_file_is_verified_without_its_folder() {
    let folder = tempfile::tempdir().unwrap();
    Relay::start(local(Settings::stored_in(folder.path()))).await.stop().await;
    let copy = folder.path().join("copy.jsonl");
    fs::copy(folder.path().join("audit.jsonl"), &copy).unwrap();
    let output =
        Command::new(env!("CARGO_BIN_EXE_cipdeck")).args(["audit", "verify"]).arg(&copy).output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    let notes = String::from_utf8(output.stderr).unwrap();
    assert!(notes.contains("without audit.head"), "{notes}");
}

fn audit(arguments: &[&str], data: &Path) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_cipdeck"));
    command.arg("audit").args(arguments).arg("--data").arg(data).output().unwrap()
}

fn said(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).unwrap()
}
