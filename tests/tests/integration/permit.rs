//! Nothing is written to a device that nobody has confirmed, and what is written is written once.

use cipdeck_tests::PATIENCE;
use cipdeck_tests::block::{self, with};
use cipdeck_tests::fake_plc::{self, Act, FakePlc};
use cipdeck_tests::frame::{REGISTER_SESSION, SEND_RR_DATA, encapsulate};
use cipdeck_tests::relay::Relay;
use serde_json::{Value, json};

#[tokio::test]
async fn a_write_that_nobody_has_confirmed_never_reaches_the_device() {
    let relay = Relay::start().await;
    let plc = FakePlc::start(fake_plc::answering(&[])).await;
    let id = relay.rest.create(&block::set(&plc.path(), 4, 150, 3, "01020304")).await;
    let stranger = relay.rest.create(&unknown_service(&plc.path())).await;
    let mut viewer = relay.viewer().await;
    for id in [&id, &stranger] {
        for body in [json!({}), json!({ "ticket": "0123" }), json!({ "ticket": "" })] {
            relay.rest.post(&format!("blocks/{id}/run"), &body).await.is_problem(403, "not_permitted");
        }
        relay
            .rest
            .post(&format!("blocks/{id}/in"), &json!({ "IN": true }))
            .await
            .is_problem(403, "not_permitted");
        for command in
            [json!({ "type": "run", "block": id }), json!({ "type": "in", "block": id, "IN": true })]
        {
            let answer = viewer.command(command).await;
            assert_eq!(answer["problem"]["code"], "not_permitted", "{answer}");
        }
        let status = relay.rest.get(&format!("blocks/{id}/status")).await.body;
        assert_eq!((&status["IN"], &status["runs"]), (&json!(false), &json!(0)), "{status}");
    }
    // A message through the same relay to the same target: had there been a write, it would have come before.
    let read = relay.rest.create(&block::product_name(&plc.path())).await;
    assert_eq!(relay.rest.run(&read).await["Q"], true, "a read needs no confirmation");
    let services: Vec<_> = plc.messages().iter().map(|message| message[0]).collect();
    assert_eq!(services, [14], "only the read has arrived");
}

#[tokio::test]
async fn a_confirmed_write_is_sent_once() {
    let relay = Relay::start().await;
    let plc = FakePlc::start(fake_plc::answering(&[])).await;
    let id = relay.rest.create(&block::set(&plc.path(), 4, 150, 3, "01020304")).await;
    let status = confirmed(&relay, &id, 1).await;
    assert_eq!((&status["Q"], &status["Status"]["StatusBits"]), (&json!(true), &json!(17)), "{status}");
    let path = [3, 0x20, 4, 0x24, 150, 0x30, 3];
    let write = [&[0x10], &path[..], &[1, 2, 3, 4]].concat();
    let read = [&[0x0E], &path[..]].concat();
    assert_eq!(plc.messages(), [read.clone(), write, read], "what was there, the write, what is there now");
    relay.rest.post(&format!("blocks/{id}/run"), &json!({})).await.is_problem(403, "not_permitted");
    assert_eq!(plc.messages().len(), 3, "a ticket is for one run");
}

#[tokio::test]
async fn a_change_after_the_confirmation_asks_again() {
    let relay = Relay::start().await;
    let plc = FakePlc::start(fake_plc::answering(&[])).await;
    let id = relay.rest.create(&block::set(&plc.path(), 4, 150, 3, "01")).await;
    let stored = relay.rest.get(&format!("blocks/{id}")).await.body;
    let ticket = relay.rest.ticket(&id, 1).await;
    let changed = relay.rest.put(&format!("blocks/{id}"), &with(stored, "/ReqData", "ff")).await;
    assert_eq!(changed.status, 200, "{changed:?}");
    let body = json!({ "ticket": ticket });
    relay.rest.post(&format!("blocks/{id}/run"), &body).await.is_problem(403, "not_permitted");
    relay
        .rest
        .post(&format!("blocks/{id}/write"), &json!({ "revision": 1 }))
        .await
        .is_problem(409, "stale_revision");
    assert_eq!(writes(&plc), 0);
    assert_eq!(confirmed(&relay, &id, 2).await["Q"], true);
}

#[tokio::test]
async fn a_cyclic_read_that_is_changed_into_a_write_stops_there() {
    let relay = Relay::start().await;
    let plc = FakePlc::start(fake_plc::answering(&[])).await;
    let cyclic = |block: Value| with(block, "/CtrlCfg", json!({ "TriggerType": 50 }));
    let id = relay.rest.create(&cyclic(block::get(&plc.path(), 4, 150, 3))).await;
    let mut viewer = relay.viewer().await;
    viewer.set_in(&id, true).await;
    viewer.status_where("it reads", PATIENCE, &id, |status| status["runs"].as_u64() >= Some(3)).await;

    let write = with(cyclic(block::set(&plc.path(), 4, 150, 3, "01")), "/revision", 1);
    let reply = relay.rest.put(&format!("blocks/{id}"), &write).await;
    assert_eq!(reply.status, 200, "{reply:?}");
    let refused = |status: &Value| status["cause"]["what"] == "not_permitted";
    let status = viewer.status_where("nobody has confirmed it", PATIENCE, &id, refused).await;
    assert_eq!((&status["phase"], &status["Status"]["ErrorID"]), (&json!("failed"), &json!(217)), "{status}");
    viewer.status_where("it does not try again", PATIENCE, &id, |status| status["IN"] == false).await;
    assert!(plc.messages().iter().all(|message| message[0] == 14), "only reads have arrived");
}

#[tokio::test]
async fn a_write_without_an_answer_is_not_sent_again() {
    let relay = Relay::start().await;
    for (name, act) in [("silent", vec![]), ("closed", vec![Act::Close])] {
        let plc = FakePlc::start(fake_plc::messages(move |_| act.clone())).await;
        let block = with(block::set(&plc.path(), 4, 150, 3, "01"), "/TargetCfg/UcmmTimeout", 250);
        let id = relay.rest.create(&block).await;
        let status = confirmed(&relay, &id, 1).await;
        assert_eq!(status["Status"]["ErrorID"], 55, "{name}: {status}");
        assert_eq!(status["cause"]["may_have_acted"], true, "{name}: {status}");
        assert_eq!(writes(&plc), 1, "{name}");
    }
}

#[tokio::test]
async fn a_write_is_sent_again_where_the_target_cannot_have_acted() {
    let relay = Relay::start().await;
    let plc = FakePlc::start(fake_plc::messages(|request| match request.number {
        // It has forgotten the session after it was asked for what is there.
        2 => vec![Act::Send(encapsulate(
            SEND_RR_DATA,
            request.frame.session(),
            0x64,
            request.frame.context(),
            &[],
        ))],
        _ => vec![Act::Send(request.success(&[]))],
    }))
    .await;
    let id = relay.rest.create(&block::set(&plc.path(), 4, 150, 3, "01")).await;
    assert_eq!(confirmed(&relay, &id, 1).await["Q"], true);
    let commands: Vec<_> = plc.requests().iter().map(|request| request.frame.command()).collect();
    assert_eq!(
        commands,
        [REGISTER_SESSION, SEND_RR_DATA, SEND_RR_DATA, REGISTER_SESSION, SEND_RR_DATA, SEND_RR_DATA]
    );
}

#[tokio::test]
async fn taking_back_in_needs_no_confirmation() {
    let relay = Relay::start().await;
    let plc = FakePlc::start(fake_plc::answering(&[])).await;
    let block = with(block::set(&plc.path(), 4, 150, 3, "01"), "/CtrlCfg", json!({ "TriggerType": 50 }));
    let id = relay.rest.create(&block).await;
    let path = format!("blocks/{id}/in");
    let reply =
        relay.rest.post(&path, &json!({ "IN": true, "ticket": relay.rest.ticket(&id, 1).await })).await;
    assert_eq!((reply.status, &reply.body["IN"]), (200, &json!(true)), "{reply:?}");
    let mut viewer = relay.viewer().await;
    let cycles = |status: &Value| status["runs"].as_u64() >= Some(3);
    viewer.status_where("a confirmed cyclic write goes on", PATIENCE, &id, cycles).await;
    let reply = relay.rest.post(&path, &json!({ "IN": false })).await;
    assert_eq!((reply.status, &reply.body["IN"]), (200, &json!(false)), "{reply:?}");
}

async fn confirmed(relay: &Relay, id: &str, revision: u64) -> Value {
    let body = json!({ "ticket": relay.rest.ticket(id, revision).await });
    let reply = relay.rest.post(&format!("blocks/{id}/run"), &body).await;
    assert_eq!(reply.status, 200, "{reply:?}");
    reply.body
}

/// A service that no table knows counts as a write.
fn unknown_service(path: &str) -> Value {
    with(block::get(path, 0x300, 1, 1), "/AppCfg/Service", 0x5A)
}

fn writes(plc: &FakePlc) -> usize {
    plc.messages().iter().filter(|message| message[0] == 0x10).count()
}
