//! What whoever runs a relay does at its machine: backup, going back, the switch.

#![expect(clippy::unwrap_used, reason = "a test ends where it fails")]

mod common;

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use cipdeck_relay::Settings;

use self::common::{Relay, local};

async fn cipdeck(arguments: &[&str]) -> Output {
    let arguments: Vec<String> = arguments.iter().map(ToString::to_string).collect();
    let run = move || Command::new(env!("CARGO_BIN_EXE_cipdeck")).args(arguments).output().unwrap();
    tokio::task::spawn_blocking(run).await.unwrap()
}

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

const BLOCK: &str = r#"{"name":"drive-current","kind":"MSG_CIPGENERIC","TargetCfg":{"Path":"0,0"},
    "AppCfg":{"Service":14,"Class":1,"Instance":1,"Attribute":7}}"#;

#[tokio::test]
async fn a_running_relay_is_backed_up_and_another_one_goes_on_from_there() {
    let place = tempfile::tempdir().unwrap();
    let (data, file, back) =
        (place.path().join("data"), place.path().join("monday.tar"), place.path().join("back"));
    let relay = Relay::start(local(Settings::stored_in(&data))).await;
    assert_eq!(relay.ask("POST", "/api/v1/blocks", BLOCK).await.status, 201);
    assert_eq!(relay.ask("POST", "/api/v1/blocks/b1/run", "").await.status, 200);
    let made = cipdeck(&["backup", "--data", text(&data), text(&file)]).await;
    assert!(made.status.success(), "{made:?}");
    let again = cipdeck(&["backup", "--data", text(&data), text(&file)]).await;
    assert_eq!(again.status.code(), Some(2), "{again:?}");
    let refused = cipdeck(&["restore", text(&file), "--data", text(&data)]).await;
    assert!(String::from_utf8(refused.stderr).unwrap().contains("nothing is overwritten"));
    relay.stop().await;

    let restored = cipdeck(&["restore", text(&file), "--data", text(&back)]).await;
    assert!(restored.status.success(), "{restored:?}");
    assert!(cipdeck(&["audit", "verify", "--data", text(&back)]).await.status.success());
    let relay = Relay::start(local(Settings::stored_in(&back))).await;
    let blocks = relay.ask("GET", "/api/v1/blocks", "").await.json();
    assert_eq!(blocks[0]["name"], "drive-current", "{blocks}");
    relay.stop().await;
}

#[tokio::test]
async fn the_switch_is_turned_off_at_the_machine_and_both_are_recorded() {
    let place = tempfile::tempdir().unwrap();
    let data = text(place.path());
    let relay = Relay::start(local(Settings::stored_in(place.path()))).await;
    relay.ask("GET", "/api/v1/health", "").await;
    for (turn, says) in [("on", "read-only: on"), ("state", "read-only: on"), ("off", "read-only: off")] {
        let said = cipdeck(&["read-only", turn, "--data", data]).await;
        assert!(String::from_utf8(said.stdout).unwrap().starts_with(says), "{turn}");
        let switch = relay.ask("GET", "/api/v1/read-only", "").await;
        assert_eq!(switch.json()["read_only"], turn != "off", "{switch:?}");
        if turn != "state" {
            // The relay looks a few times a second.
            let event = format!("\"event\":\"read_only_{turn}\",\"actor\":\"local\"");
            let deadline = tokio::time::Instant::now() + std::time::Duration::from_secs(10);
            while !fs::read_to_string(place.path().join("audit.jsonl")).unwrap().contains(&event) {
                assert!(tokio::time::Instant::now() < deadline, "{event} is not recorded");
                tokio::task::yield_now().await;
            }
        }
    }
    relay.stop().await;
    let nowhere = cipdeck(&["read-only", "on", "--data", "/nonexistent/cipdeck"]).await;
    assert_eq!(nowhere.status.code(), Some(2));
}
