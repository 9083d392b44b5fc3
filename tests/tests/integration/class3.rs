//! Class 3 connections to our simulated device and to targets that nobody here wrote.

use std::collections::BTreeSet;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use cipdeck_tests::PATIENCE;
use cipdeck_tests::block::{self, with};
use cipdeck_tests::command::{Ended, Service, cipdeck};
use cipdeck_tests::peers::{CiplinkAdapter, Cpppo};
use cipdeck_tests::relay::Relay;
use cipdeck_tests::wait::eventually;
use serde_json::{Value, json};

#[tokio::test]
async fn a_thousand_requests_to_the_simulated_device_are_one_connection() {
    let mut device = Service::simulate("127.0.0.1:0", &[]).await;
    let path = format!("4,{}", device.address);
    let lines = thousand(&path).await;
    let moments: Vec<_> = lines.iter().map(|line| little_endian(&line["ResData"])).collect();
    assert!(moments.is_sorted(), "time does not go back");
    assert!(moments.iter().collect::<BTreeSet<_>>().len() > 10, "the value moves");

    let counted = |attribute: u32| {
        let path = path.clone();
        async move { little_endian(&read(&path, 6, 1, attribute, &["--json"]).await.json()["ResData"]) }
    };
    assert_eq!((counted(1).await, counted(5).await, counted(8).await), (1, 1, 0), "opens, closes, watchdogs");

    device.process.interrupt();
    assert!(device.process.ended(PATIENCE).await.success());
    let said = eventually("the last line", PATIENCE, async || device.process.output().last().cloned()).await;
    let expected = "unconnected 3, connections opened 1, connected requests 1000, closed 1, \
                    timed out 0, unregistered 0, repeated 0, dropped 0";
    assert_eq!(said, expected);
}

#[tokio::test]
async fn a_thousand_requests_to_ciplink_are_all_right_and_move_with_the_value() {
    let adapter = Arc::new(CiplinkAdapter::start());
    adapter.set_input(&[0; 32]);
    let ended = Arc::new(AtomicBool::new(false));
    let (moved, stop) = (Arc::clone(&adapter), Arc::clone(&ended));
    let moving = std::thread::spawn(move || {
        let mut value = 0_u32;
        while !stop.load(Ordering::Relaxed) {
            value += 1;
            moved.set_input(&value.to_le_bytes().repeat(8));
            std::thread::yield_now();
        }
    });
    let lines = thousand(&adapter.path()).await;
    ended.store(true, Ordering::Relaxed);
    moving.join().expect("no panic");
    let values: Vec<_> = lines.iter().map(|line| little_endian(&line["ResData"])).collect();
    for line in &lines {
        let data = line["ResData"].as_str().expect("data");
        assert_eq!(data, data[..8].repeat(8), "all of one moment");
    }
    assert!(values.is_sorted(), "an older value never follows a newer one");
    assert!(values.iter().collect::<BTreeSet<_>>().len() > 10, "the value moves");
}

#[tokio::test]
async fn a_target_that_echoes_the_wrong_connection_id_is_tolerated_and_shown() {
    let cpppo = Cpppo::start().await;
    let device = Service::simulate("127.0.0.1:0", &["--quirk", "own-connection-id"]).await;
    let adapter = CiplinkAdapter::start();
    let relay = Relay::start().await;
    for (path, data, own) in [
        (cpppo.path(), cpppo_name(), true),
        (format!("4,{}", device.address), block::short_string("cipdeck demo drive"), true),
        (adapter.path(), block::short_string(CiplinkAdapter::PRODUCT_NAME), false),
    ] {
        let id = relay.rest.create(&block::connected(block::product_name(&path))).await;
        for _ in 0..20 {
            let status = relay.rest.run(&id).await;
            assert_eq!((&status["Q"], &status["ResData"]), (&json!(true), &json!(data)), "{path}: {status}");
        }
        let target = target(&relay, &path).await;
        assert_eq!(target["own_connection_id"].as_bool().unwrap_or(false), own, "{target}");
        assert_eq!(target["connections"][0]["size"], 504, "{target}");
        assert_eq!(target["dropped"], 0, "{target}");
    }
}

#[tokio::test]
async fn a_target_without_contexts_is_tolerated_and_shown() {
    let device = Service::simulate("127.0.0.1:0", &["--quirk", "no-context"]).await;
    let relay = Relay::start().await;
    let path = format!("4,{}", device.address);
    for block in [block::product_name(&path), block::connected(block::product_name(&path))] {
        let id = relay.rest.create(&block).await;
        assert_eq!(relay.rest.run(&id).await["Q"], true);
    }
    assert_eq!(target(&relay, &path).await["no_context"], true);
}

#[tokio::test]
async fn a_device_of_another_size_is_asked_for_what_it_takes() {
    for flags in
        [&["--connection-size", "100"][..], &["--no-large", "--connection-size", "400"], &["--no-large"]]
    {
        let device = Service::simulate("127.0.0.1:0", flags).await;
        let relay = Relay::start().await;
        let path = format!("4,{}", device.address);
        for profile in ["generic", "logix", "omron"] {
            let block = with(block::connected(block::product_name(&path)), "/Profile", profile);
            let id = relay.rest.create(&with(block, "/TargetCfg/ConnClose", true)).await;
            let status = relay.rest.run(&id).await;
            assert_eq!(status["Q"], true, "{flags:?} {profile}: {status}");
            let bits = status["Status"]["StatusBits"].as_u64();
            assert_eq!(bits, Some(17 + 32 + 64), "{flags:?} {profile}: DN, CIPCONN, EIPSESS");
        }
    }
}

#[tokio::test]
async fn five_connected_blocks_to_five_slow_targets_are_four_and_one_that_waits() {
    let relay = Relay::start().await;
    let mut viewer = relay.viewer().await;
    let mut runs = Vec::new();
    let mut devices = Vec::new();
    for _ in 0..5 {
        let device = Service::simulate("127.0.0.1:0", &["--delay", "700"]).await;
        let block = block::connected(block::product_name(&format!("4,{}", device.address)));
        let id = relay.rest.create(&block).await;
        runs.push((viewer.submit(json!({ "type": "run", "block": id })).await, id));
        devices.push(device);
    }
    let last = runs[4].1.clone();
    let waiting = |status: &Value| status["phase"] == "waiting" && status["Status"]["StatusBits"] == 1;
    viewer.status_where("the fifth waits, EN only", PATIENCE, &last, waiting).await;
    for (_, id) in &runs[..4] {
        let sent = |status: &Value| status["phase"] == "sent" && status["Status"]["StatusBits"] == 5;
        viewer.status_where("four are sent", PATIENCE, id, sent).await;
    }
    assert_eq!(viewer.statuses[&last]["phase"], "waiting");
    for (run, _) in runs {
        let answer = viewer.answer(&run).await;
        assert_eq!(answer["status"]["Q"], true, "{answer}");
    }
}

/// Reads the input assembly a thousand times over a connection.
async fn thousand(path: &str) -> Vec<Value> {
    let ended = read(path, 4, 100, 3, &["--connected", "--repeat", "1000", "--json"]).await;
    assert_eq!(ended.code, 0, "{}", ended.stderr);
    let lines: Vec<Value> =
        ended.stdout.lines().map(|line| serde_json::from_str(line).expect("JSON in every line")).collect();
    assert_eq!(lines.len(), 1_000);
    assert!(lines.iter().all(|line| line["Q"] == true));
    lines
}

async fn read(path: &str, class: u32, instance: u32, attribute: u32, more: &[&str]) -> Ended {
    let [class, instance, attribute] = [class, instance, attribute].map(|number| number.to_string());
    let arguments = [
        "send",
        path,
        "--service",
        "14",
        "--class",
        &class,
        "--instance",
        &instance,
        "--attribute",
        &attribute,
    ];
    cipdeck(&[&arguments[..], more].concat()).await
}

/// The first bytes as an unsigned number, at most a UDINT.
fn little_endian(data: &Value) -> u32 {
    let text = data.as_str().expect("hexadecimal text");
    let bytes = (0..text.len().min(8)).step_by(2).map(|at| u32::from_str_radix(&text[at..at + 2], 16));
    bytes.rev().fold(0, |number, byte| number << 8 | byte.expect("hexadecimal text"))
}

/// How the relay shows a target.
async fn target(relay: &Relay, path: &str) -> Value {
    let targets = relay.rest.get("targets").await.body;
    let found = targets.as_array().into_iter().flatten().find(|target| path[2..] == target["target"]);
    found.cloned().unwrap_or_else(|| panic!("no {path} in {targets}"))
}

fn cpppo_name() -> String {
    block::short_string(Cpppo::PRODUCT_NAME)
}
