//! A saved block is never lost: not by Ctrl-C, and not by a power failure.

use cipdeck_tests::PATIENCE;
use cipdeck_tests::block::{self, with};
use cipdeck_tests::command::Service;
use cipdeck_tests::rest::Rest;
use cipdeck_tests::viewer::Viewer;
use serde_json::{Value, json};
use tempfile::TempDir;

#[tokio::test]
async fn blocks_are_identical_after_ctrl_c_and_after_kill() {
    let folder = TempDir::new().expect("a temporary folder");
    let mut relay = Service::serve("127.0.0.1:0", folder.path()).await;
    let rest = Rest::new(&relay.address);
    for number in 0..20 {
        let block =
            with(block::get("4,192.0.2.1", 1, 1, number + 1), "/name", format!("Förderband {number}"));
        rest.create(&with(block, "/Colour", json!({ "known to": ["somebody else"] }))).await;
    }
    rest.delete("blocks/b20?revision=1").await;
    let changed = with(rest.get("blocks/b3").await.body, "/name", "changed");
    assert_eq!(rest.put("blocks/b3", &changed).await.status, 200);
    let before = rest.get("blocks").await.body;
    assert_eq!(before.as_array().map(Vec::len), Some(19));

    relay.process.interrupt();
    let status = relay.process.ended(PATIENCE).await;
    assert!(status.success(), "stopped in order: {status}\n{}", relay.process.output().join("\n"));
    let mut relay = Service::serve("127.0.0.1:0", folder.path()).await;
    let rest = Rest::new(&relay.address);
    assert_eq!(rest.get("blocks").await.body, before, "after Ctrl-C");

    relay.process.kill();
    relay.process.ended(PATIENCE).await;
    let relay = Service::serve("127.0.0.1:0", folder.path()).await;
    let rest = Rest::new(&relay.address);
    assert_eq!(rest.get("blocks").await.body, before, "after kill -9");
    assert_eq!(rest.create(&block::product_name("0,0")).await, "b21", "an id is never used again");
}

#[tokio::test]
async fn what_was_acknowledged_survives_a_kill_in_the_middle_of_writing() {
    let folder = TempDir::new().expect("a temporary folder");
    let mut relay = Service::serve("127.0.0.1:0", folder.path()).await;
    let rest = Rest::new(&relay.address);
    let mut acknowledged = Vec::new();
    for _ in 0..30 {
        acknowledged.push(rest.create(&block::product_name("0,0")).await);
    }
    relay.process.kill(); // at once after the answer to the last
    relay.process.ended(PATIENCE).await;
    let relay = Service::serve("127.0.0.1:0", folder.path()).await;
    let stored = Rest::new(&relay.address).get("blocks").await.body;
    let ids: Vec<_> = stored.as_array().into_iter().flatten().map(|block| block["id"].clone()).collect();
    assert_eq!(json!(ids), json!(acknowledged));
}

#[tokio::test]
async fn in_is_false_after_a_start_unless_the_block_says_otherwise() {
    let folder = TempDir::new().expect("a temporary folder");
    let mut relay = Service::serve("127.0.0.1:0", folder.path()).await;
    let rest = Rest::new(&relay.address);
    let cyclic = with(block::product_name("0,0"), "/CtrlCfg", json!({ "TriggerType": 100 }));
    let forgets = rest.create(&cyclic).await;
    let resumes = rest.create(&with(cyclic, "/Resume", true)).await;
    for id in [&forgets, &resumes] {
        assert_eq!(rest.post(&format!("blocks/{id}/in"), &json!({ "IN": true })).await.status, 200);
    }
    relay.process.kill();
    relay.process.ended(PATIENCE).await;
    let relay = Service::serve("127.0.0.1:0", folder.path()).await;
    let mut viewer = Viewer::connect(&relay.address).await;
    let runs = |status: &Value| status["runs"].as_u64() >= Some(2);
    viewer.status_where("it resumes", PATIENCE, &resumes, runs).await;
    let status = &viewer.statuses[&forgets];
    assert_eq!((&status["IN"], &status["runs"]), (&json!(false), &json!(0)), "{status}");
}
