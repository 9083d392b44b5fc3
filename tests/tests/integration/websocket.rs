//! What a viewer sees.

use cipdeck_tests::PATIENCE;
use cipdeck_tests::block::{self, with};
use cipdeck_tests::fake_plc::{self, FakePlc};
use cipdeck_tests::peers::CiplinkAdapter;
use cipdeck_tests::relay::Relay;
use serde_json::json;

#[tokio::test]
async fn a_viewer_gets_hello_and_everything() {
    let relay = Relay::start().await;
    let id = relay.rest.create(&block::product_name("0,0")).await;
    let viewer = relay.viewer().await;
    assert_eq!(viewer.hello["protocol"], 2);
    assert!(viewer.hello["relay"].is_string());
    assert_eq!(viewer.blocks[&id]["name"], "get-1-1-7");
    let status = &viewer.statuses[&id];
    assert_eq!((&status["phase"], &status["Status"]["StatusBits"]), (&json!("idle"), &json!(0)), "{status}");
}

#[tokio::test]
async fn the_product_name_of_a_foreign_device_comes_back() {
    let relay = Relay::start().await;
    let adapter = CiplinkAdapter::start();
    let id = relay.rest.create(&block::product_name(&adapter.path())).await;
    let mut viewer = relay.viewer().await;
    let status = viewer.run(&id).await;
    assert_eq!(status["ResData"], block::short_string(CiplinkAdapter::PRODUCT_NAME), "{status}");
    assert_eq!(status["ResLength"], CiplinkAdapter::PRODUCT_NAME.len() + 1);
    assert_eq!(status["Status"]["StatusBits"], 17, "DN, and EN until IN falls: {status}");
    assert!(status["elapsed_us"].as_u64() >= status["reply_us"].as_u64(), "{status}");
}

#[tokio::test]
async fn a_run_shows_every_bit_in_its_order_and_ends_without_en() {
    let relay = Relay::start().await;
    let adapter = CiplinkAdapter::start();
    let id = relay.rest.create(&block::product_name(&adapter.path())).await;
    let mut viewer = relay.viewer().await;
    viewer.run(&id).await;
    let after = |status: &serde_json::Value| status["Status"]["StatusBits"] == 16;
    let status = viewer.status_where("IN falls after the run", PATIENCE, &id, after).await;
    assert_eq!((&status["IN"], &status["Q"], &status["runs"]), (&json!(false), &json!(true), &json!(1)));
    assert_eq!(viewer.edges[&id], [1, 3, 5, 17, 16], "EN; EW; ST; DN; EN falls with IN");
}

#[tokio::test]
async fn viewers_see_blocks_come_change_and_go() {
    let relay = Relay::start().await;
    let mut viewer = relay.viewer().await;
    let id = relay.rest.create(&block::product_name("0,0")).await;
    let name = |viewer: &mut cipdeck_tests::viewer::Viewer| {
        viewer.blocks.get("b1").map(|block| block["name"].clone())
    };
    viewer.wait_until("a new block", PATIENCE, name).await;
    let stored = relay.rest.get(&format!("blocks/{id}")).await.body;
    relay.rest.put(&format!("blocks/{id}"), &with(stored, "/name", "other")).await;
    viewer.wait_until("its new name", PATIENCE, |viewer| name(viewer).filter(|name| name == "other")).await;
    relay.rest.delete(&format!("blocks/{id}?revision=2")).await;
    viewer.wait_until("it is gone", PATIENCE, |viewer| name(viewer).is_none().then_some(())).await;
    assert!(!viewer.statuses.contains_key(&id));
}

#[tokio::test]
async fn a_busy_block_answers_busy_and_ends_its_first_run() {
    let relay = Relay::start().await;
    let plc = FakePlc::start(fake_plc::messages(|request| {
        vec![fake_plc::Act::Hold, fake_plc::Act::Send(request.success(&[1]))]
    }))
    .await;
    let id = relay.rest.create(&block::product_name(&plc.path())).await;
    let mut viewer = relay.viewer().await;
    let run = viewer.submit(json!({ "type": "run", "block": id })).await;
    let second = viewer.command(json!({ "type": "run", "block": id })).await;
    assert_eq!(second["problem"]["code"], "busy", "{second}");
    relay.rest.post(&format!("blocks/{id}/run"), &json!({})).await.is_problem(409, "busy");
    plc.release();
    let answer = viewer.answer(&run).await;
    assert_eq!(answer["status"]["Q"], true, "{answer}");
    assert_eq!(plc.messages().len(), 1);
}

#[tokio::test]
async fn in_runs_once_and_holds_en_until_it_falls() {
    let relay = Relay::start().await;
    let plc = FakePlc::start(fake_plc::answering(&[1])).await;
    let id = relay.rest.create(&block::product_name(&plc.path())).await;
    let mut viewer = relay.viewer().await;
    viewer.set_in(&id, true).await;
    let done = |status: &serde_json::Value| status["Status"]["StatusBits"] == 17;
    viewer.status_where("DN, and EN with IN", PATIENCE, &id, done).await;
    let run = viewer.command(json!({ "type": "run", "block": id })).await;
    assert_eq!(run["problem"]["code"], "busy", "IN is TRUE: {run}");
    viewer.set_in(&id, true).await; // no edge
    viewer.set_in(&id, false).await;
    let fell = |status: &serde_json::Value| status["Status"]["StatusBits"] == 16;
    let status = viewer.status_where("EN falls with IN", PATIENCE, &id, fell).await;
    assert_eq!((&status["runs"], &status["Q"]), (&json!(1), &json!(true)), "{status}");
    assert_eq!(plc.messages().len(), 1);
}

#[tokio::test]
async fn cancel_without_a_run_is_nothing() {
    let relay = Relay::start().await;
    let id = relay.rest.create(&block::product_name("0,0")).await;
    let mut viewer = relay.viewer().await;
    let status = viewer.cancel(&id).await;
    assert_eq!((&status["phase"], &status["runs"]), (&json!("idle"), &json!(0)), "{status}");
}

#[tokio::test]
async fn deleting_a_running_block_cancels_it() {
    let relay = Relay::start().await;
    let plc = FakePlc::start(fake_plc::messages(|_| vec![])).await;
    let id = relay.rest.create(&block::product_name(&plc.path())).await;
    let mut viewer = relay.viewer().await;
    let run = viewer.submit(json!({ "type": "run", "block": id })).await;
    viewer.status_where("the request is sent", PATIENCE, &id, |status| status["phase"] == "sent").await;
    relay.rest.delete(&format!("blocks/{id}?revision=1")).await;
    let answer = viewer.answer(&run).await;
    let cancelled = answer["status"]["Status"]["ErrorID"] == 217;
    assert!(cancelled || !answer["problem"].is_null(), "the run has an answer: {answer}");
    relay.rest.get(&format!("blocks/{id}")).await.is_problem(404, "not_found");
}

#[tokio::test]
async fn the_last_good_value_stays_while_a_later_run_fails() {
    let relay = Relay::start().await;
    let plc = FakePlc::start(fake_plc::messages(|request| match request.number {
        1 => vec![fake_plc::Act::Send(request.success(&[0x2A]))],
        _ => vec![fake_plc::Act::Close],
    }))
    .await;
    let id = relay.rest.create(&block::product_name(&plc.path())).await;
    let good = relay.rest.run(&id).await;
    let failed = relay.rest.run(&id).await;
    assert_eq!((&failed["ResData"], &failed["ResLength"]), (&json!(""), &json!(0)), "cleared: {failed}");
    assert_eq!(failed["last"]["ResData"], "2a", "{failed}");
    assert_eq!(failed["last"]["at"], good["last"]["at"], "{failed}");
}

#[tokio::test]
async fn the_last_good_value_goes_when_the_block_asks_something_else() {
    let relay = Relay::start().await;
    let id = relay.rest.create(&block::product_name("0,0")).await;
    let good = relay.rest.run(&id).await;
    let path = format!("blocks/{id}");
    let stored = relay.rest.get(&path).await.body;
    let renamed = relay.rest.put(&path, &with(stored, "/name", "other")).await;
    let status = relay.rest.get(&format!("{path}/status")).await.body;
    assert_eq!(status["last"], good["last"], "the same question: {status}");

    let mut viewer = relay.viewer().await;
    relay.rest.put(&path, &with(renamed.body, "/AppCfg/Attribute", 1)).await;
    viewer.status_where("no value", PATIENCE, &id, |status| status["last"].is_null()).await;
}
