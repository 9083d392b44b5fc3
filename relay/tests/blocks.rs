//! Blocks over REST: stored, changed, run, and still there after a restart.

#![expect(clippy::unwrap_used, reason = "a test ends where it fails")]

mod common;

use std::time::{Duration, Instant};

use cipdeck_relay::Settings;
use serde_json::{Value, json};

use self::common::{Relay, local};

/// Asks the demo device for its name.
fn name() -> Value {
    json!({
        "name": "name", "AppCfg": {"Service": 14, "Class": 1, "Instance": 1, "Attribute": 7},
        "TargetCfg": {"Path": "0,0"},
    })
}

/// Sets the demo device's output assembly.
fn write(byte: &str) -> Value {
    json!({
        "name": "write", "AppCfg": {"Service": 16, "Class": 4, "Instance": 150, "Attribute": 3},
        "TargetCfg": {"Path": "0,0"}, "ReqData": byte.repeat(32),
    })
}

fn with(mut block: Value, pointer: &str, value: impl Into<Value>) -> Value {
    *block.pointer_mut(pointer).unwrap() = value.into();
    block
}

async fn create(relay: &Relay, block: &Value) -> Value {
    let reply = relay.ask("POST", "/api/v1/blocks", &block.to_string()).await;
    assert_eq!(reply.status, 201, "{reply:?}");
    reply.json()
}

async fn post(relay: &Relay, path: &str, body: &str) -> Value {
    let reply = relay.ask("POST", &format!("/api/v1/blocks/{path}"), body).await;
    assert_eq!(reply.status, 200, "{reply:?}");
    reply.json()
}

/// Asks again until it is as wanted.
async fn until(relay: &Relay, path: &str, is_wanted: impl Fn(&Value) -> bool) -> Value {
    let deadline = Instant::now() + Duration::from_secs(10);
    loop {
        let reply = relay.ask("GET", path, "").await.json();
        if is_wanted(&reply) {
            return reply;
        }
        assert!(Instant::now() < deadline, "{reply}");
        tokio::time::sleep(Duration::from_millis(5)).await;
    }
}

#[tokio::test]
async fn a_block_is_stored_run_changed_and_deleted() {
    let relay = Relay::start(local(Settings::in_memory())).await;
    let block = create(&relay, &name()).await;
    assert_eq!((&block["id"], &block["revision"]), (&json!("b1"), &json!(1)));
    assert_eq!(relay.ask("GET", "/api/v1/blocks", "").await.json(), json!([block]));
    assert_eq!(relay.ask("GET", "/api/v1/health", "").await.json()["blocks"], 1);

    let idle = relay.ask("GET", "/api/v1/blocks/b1/status", "").await.json();
    assert_eq!((&idle["phase"], &idle["IN"], &idle["last"]), (&json!("idle"), &json!(false), &Value::Null));
    let ended = post(&relay, "b1/run", "").await;
    assert_eq!((&ended["Q"], &ended["Status"]["StatusBits"]), (&json!(true), &json!(17)));
    assert_eq!(ended["last"]["ResData"], ended["ResData"]);
    let after = relay.ask("GET", "/api/v1/blocks/b1/status", "").await.json();
    assert_eq!(
        (&after["IN"], &after["Status"]["StatusBits"], &after["runs"]),
        (&json!(false), &json!(16), &json!(1))
    );
    let exchanges = relay.ask("GET", "/api/v1/blocks/b1/exchange", "").await.json();
    assert_eq!(exchanges[0]["request"], "0e03200124013007");
    assert!(exchanges[0]["response_frame"].as_str().unwrap().starts_with("6f00"), "{exchanges}");

    let changed = with(block.clone(), "/AppCfg/Class", 238);
    let reply = relay.ask("PUT", "/api/v1/blocks/b1", &changed.to_string()).await;
    assert_eq!((reply.status, &reply.json()["revision"]), (200, &json!(2)));
    let refused = post(&relay, "b1/run", "{}").await;
    assert_eq!((&refused["Status"]["ErrorID"], &refused["Status"]["SubErrorID"]), (&json!(224), &json!(5)));
    assert_eq!(refused["last"], Value::Null, "the last success answered another question");

    let stale = relay.ask("PUT", "/api/v1/blocks/b1", &changed.to_string()).await;
    assert_eq!(stale.problem(), (409, "stale_revision".to_owned()));
    assert_eq!(
        (&stale.json()["current"]["revision"], &stale.json()["current"]["AppCfg"]["Class"]),
        (&json!(2), &json!(238))
    );
    assert_eq!(relay.ask("DELETE", "/api/v1/blocks/b1?revision=1", "").await.problem().0, 409);
    assert_eq!(relay.ask("DELETE", "/api/v1/blocks/b1", "").await.problem(), (400, "unreadable".to_owned()));
    assert_eq!(relay.ask("DELETE", "/api/v1/blocks/b1?revision=2", "").await.status, 204);
    assert_eq!(relay.ask("GET", "/api/v1/blocks/b1", "").await.problem(), (404, "not_found".to_owned()));
    assert_eq!(create(&relay, &name()).await["id"], "b2");
    relay.stop().await;
}

#[tokio::test]
async fn bad_input_is_a_problem_and_nothing_is_stored() {
    let relay = Relay::start(local(Settings::in_memory())).await;
    for (pointer, value, field) in [
        ("/AppCfg/Service", json!(300), "AppCfg.Service"),
        ("/AppCfg/Instance", json!(-1), "AppCfg.Instance"),
        ("/TargetCfg/Path", json!(""), "TargetCfg.Path"),
        ("/TargetCfg/Path", json!("4,10.0.0.1,1,0,1,0"), "TargetCfg.Path"),
        ("/TargetCfg/Path", json!("2,1"), "TargetCfg.Path"),
        ("/TargetCfg/Path", json!("4,10.0.0.1,1,256"), "TargetCfg.Path"),
        ("/ReqData", json!("00".repeat(491)), "ReqData"),
        ("/ReqData", json!("0a0"), "ReqData"),
    ] {
        let reply = relay.ask("POST", "/api/v1/blocks", &with(write("00"), pointer, value).to_string()).await;
        assert_eq!(reply.problem(), (422, "findings".to_owned()), "{pointer}");
        assert_eq!(reply.json()["findings"][0]["field"], field, "{reply:?}");
    }
    for (method, path, body, status, code) in [
        ("POST", "blocks", "{", 400, "unreadable"),
        ("POST", "blocks", r#"{"name":1}"#, 400, "unreadable"),
        (
            "POST",
            "blocks",
            r#"{"name":"x","AppCfg":{"Service":1.5,"Class":1,"Instance":1},"TargetCfg":{"Path":"0,0"}}"#,
            400,
            "unreadable",
        ),
        ("POST", "check", "[]", 400, "unreadable"),
        ("GET", "blocks/b9", "", 404, "not_found"),
        ("GET", "blocks/nine", "", 404, "not_found"),
        ("POST", "blocks/b9/run", "", 404, "not_found"),
        ("POST", "blocks/b9/in", r#"{"IN":true}"#, 404, "not_found"),
        ("POST", "blocks/b9/in", "", 400, "unreadable"),
        ("POST", "blocks/b9/cancel", "", 404, "not_found"),
        ("DELETE", "blocks/b9?revision=1", "", 404, "not_found"),
        ("PUT", "blocks/b9", "{}", 400, "unreadable"),
    ] {
        let reply = relay.ask(method, &format!("/api/v1/{path}"), body).await;
        assert_eq!(reply.problem(), (status, code.to_owned()), "{method} {path} {body}");
    }
    let large = relay.ask("POST", "/api/v1/blocks", &" ".repeat(2_000_000)).await;
    assert_eq!(large.problem(), (413, "too_large".to_owned()));
    let block = create(&relay, &name()).await;
    let without = relay.ask("PUT", "/api/v1/blocks/b1", &name().to_string()).await;
    assert_eq!(without.problem(), (400, "unreadable".to_owned()));
    let other = relay.ask("PUT", "/api/v1/blocks/b1", &with(block.clone(), "/id", "b2").to_string()).await;
    assert_eq!(other.problem(), (400, "unreadable".to_owned()));
    assert_eq!(relay.ask("GET", "/api/v1/blocks", "").await.json(), json!([block]));
    relay.stop().await;
}

#[tokio::test]
async fn checking_stores_nothing() {
    let relay = Relay::start(local(Settings::in_memory())).await;
    let good = relay.ask("POST", "/api/v1/check", &name().to_string()).await.json();
    assert_eq!(good, json!({"findings": [], "request": "0e03200124013007"}));
    let bad = with(name(), "/AppCfg/Service", 300);
    let bad = relay.ask("POST", "/api/v1/check", &bad.to_string()).await.json();
    assert_eq!((&bad["request"], &bad["findings"][0]["max"]), (&Value::Null, &json!(127)));
    assert_eq!(relay.ask("GET", "/api/v1/blocks", "").await.json(), json!([]));
    relay.stop().await;
}

#[tokio::test]
async fn a_write_is_sent_only_when_its_revision_was_confirmed() {
    let relay = Relay::start(local(Settings::in_memory())).await;
    let output =
        with(with(with(name(), "/AppCfg/Class", 4), "/AppCfg/Instance", 150), "/AppCfg/Attribute", 3);
    create(&relay, &output).await;
    create(&relay, &write("A5")).await;
    for body in ["", "{}", r#"{"ticket":"0123"}"#] {
        let reply = relay.ask("POST", "/api/v1/blocks/b2/run", body).await;
        assert_eq!(reply.problem(), (403, "not_permitted".to_owned()), "{body}");
    }
    let reply = relay.ask("POST", "/api/v1/blocks/b2/in", r#"{"IN":true}"#).await;
    assert_eq!(reply.problem(), (403, "not_permitted".to_owned()));
    assert_eq!(post(&relay, "b1/run", "").await["ResData"], "00".repeat(32));
    let asked = relay.ask("POST", "/api/v1/blocks/b2/write", r#"{"revision":1}"#).await;
    assert_eq!(asked.problem(), (403, "not_permitted".to_owned()), "without a write window");
    assert_eq!(relay.ask("POST", "/api/v1/window", r#"{"minutes":1}"#).await.status, 200);
    let stale = relay.ask("POST", "/api/v1/blocks/b2/write", r#"{"revision":2}"#).await;
    assert_eq!(stale.problem(), (409, "stale_revision".to_owned()));
    let offer = post(&relay, "b2/write", r#"{"revision":1}"#).await;
    assert_eq!(
        (&offer["old"]["data"], &offer["new"]["data"]),
        (&json!("00".repeat(32)), &json!("a5".repeat(32)))
    );
    let command = json!({ "ticket": offer["ticket"] }).to_string();
    let done = post(&relay, "b2/run", &command).await;
    assert_eq!((&done["Q"], &done["written"]["is_equal"]), (&json!(true), &json!(true)), "{done}");
    let again = relay.ask("POST", "/api/v1/blocks/b2/run", &command).await;
    assert_eq!(again.problem(), (403, "not_permitted".to_owned()), "a ticket is good once");
    assert_eq!(post(&relay, "b1/run", "").await["ResData"], "a5".repeat(32));
    relay.stop().await;
}

#[tokio::test]
async fn a_cyclic_block_runs_until_in_falls_and_is_busy_for_others() {
    let relay = Relay::start(local(Settings::in_memory())).await;
    let mut cyclic = name();
    cyclic["CtrlCfg"] = json!({"TriggerType": 5});
    create(&relay, &cyclic).await;
    assert_eq!(post(&relay, "b1/in", r#"{"IN":true}"#).await["IN"], true);
    until(&relay, "/api/v1/blocks/b1/status", |status| status["runs"].as_u64() > Some(3)).await;
    let reply = relay.ask("POST", "/api/v1/blocks/b1/run", "").await;
    assert_eq!(reply.problem(), (409, "busy".to_owned()));
    post(&relay, "b1/in", r#"{"IN":false}"#).await;
    until(&relay, "/api/v1/blocks/b1/status", |status| status["Status"]["StatusBits"] == 16).await;
    assert_eq!(post(&relay, "b1/run", "").await["Q"], true);
    relay.stop().await;
}

#[tokio::test]
async fn blocks_survive_a_restart_and_only_reads_that_ask_for_it_resume() {
    let folder = tempfile::tempdir().unwrap();
    let relay = Relay::start(local(Settings::stored_in(folder.path()))).await;
    let mut stored = with(name(), "/name", "resumes");
    stored["Resume"] = json!(true);
    stored["CtrlCfg"] = json!({"TriggerType": 5, "Cancel": true});
    stored["Colour"] = json!("red");
    let block = create(&relay, &stored).await;
    assert_eq!((&block["Colour"], &block["CtrlCfg"]["Cancel"]), (&json!("red"), &json!(false)));
    create(&relay, &name()).await;
    let mut write = write("00");
    write["Resume"] = json!(true);
    assert_eq!(relay.ask("POST", "/api/v1/blocks", &write.to_string()).await.problem().0, 422);
    for id in ["b1", "b2"] {
        post(&relay, &format!("{id}/in"), r#"{"IN":true}"#).await;
    }
    let before = relay.ask("GET", "/api/v1/blocks", "").await.body;
    relay.stop().await;

    let relay = Relay::start(local(Settings::stored_in(folder.path()))).await;
    assert_eq!(relay.ask("GET", "/api/v1/blocks", "").await.body, before);
    until(&relay, "/api/v1/blocks/b1/status", |status| status["runs"].as_u64() > Some(1)).await;
    let other = relay.ask("GET", "/api/v1/blocks/b2/status", "").await.json();
    assert_eq!((&other["IN"], &other["runs"]), (&json!(false), &json!(0)));
    relay.stop().await;
}

#[tokio::test]
async fn stopping_answers_what_is_running() {
    let silent = tokio::net::TcpListener::bind("127.0.0.1:0").await.unwrap();
    let relay = Relay::start(local(Settings::in_memory())).await;
    let path = format!("4,127.0.0.1:{}", silent.local_addr().unwrap().port());
    create(&relay, &with(name(), "/TargetCfg/Path", path)).await;
    let address = relay.address;
    let run = tokio::spawn(async move { Relay::ask_at(address, "POST", "/api/v1/blocks/b1/run", "").await });
    until(&relay, "/api/v1/blocks/b1/status", |status| status["phase"] == "connecting").await;
    relay.stop().await;
    assert_eq!(run.await.unwrap().json()["Status"]["ErrorID"], 217);
}
