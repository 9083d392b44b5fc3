//! Blocks over REST: what is refused and why, and that nothing of it is stored.

use cipdeck_tests::block::{self, with};
use cipdeck_tests::relay::Relay;
use reqwest::Method;
use serde_json::{Value, json};

#[tokio::test]
async fn a_block_is_created_read_changed_and_deleted() {
    let relay = Relay::start().await;
    let id = relay.rest.create(&block::product_name("0,0")).await;
    assert_eq!(id, "b1");
    let created = relay.rest.get("blocks/b1").await.body;
    assert_eq!((&created["revision"], &created["AppCfg"]["Attribute"]), (&json!(1), &json!(7)));

    let changed = relay.rest.put("blocks/b1", &with(created, "/AppCfg/Attribute", 1)).await;
    assert_eq!(changed.status, 200, "{changed:?}");
    assert_eq!(relay.rest.get("blocks/b1").await.body["AppCfg"]["Attribute"], 1);

    let revision = changed.body["revision"].as_u64().unwrap();
    let deleted = relay.rest.delete(&format!("blocks/b1?revision={revision}")).await;
    assert!(matches!(deleted.status, 200 | 204), "{deleted:?}");
    relay.rest.get("blocks/b1").await.is_problem(404, "not_found");
    assert_eq!(relay.rest.create(&block::product_name("0,0")).await, "b2", "an id is never used again");
}

#[tokio::test]
async fn an_unknown_block_is_not_found_everywhere() {
    let relay = Relay::start().await;
    for path in ["blocks/b7", "blocks/b7/status", "blocks/b7/exchange", "blocks/x", "nothing"] {
        relay.rest.get(path).await.is_problem(404, "not_found");
    }
    relay.rest.post("blocks/b7/run", &json!({})).await.is_problem(404, "not_found");
    relay.rest.post("blocks/b7/cancel", &json!({})).await.is_problem(404, "not_found");
    relay.rest.post("blocks/b7/in", &json!({ "IN": true })).await.is_problem(404, "not_found");
    relay.rest.delete("blocks/b7?revision=1").await.is_problem(404, "not_found");
}

#[tokio::test]
async fn a_stale_revision_is_refused_with_the_current_block() {
    let relay = Relay::start().await;
    let id = relay.rest.create(&block::product_name("0,0")).await;
    let first = relay.rest.get(&format!("blocks/{id}")).await.body;
    let path = format!("blocks/{id}");
    assert_eq!(relay.rest.put(&path, &with(first.clone(), "/name", "by somebody else")).await.status, 200);

    let stale = relay.rest.put(&path, &with(first, "/name", "too late")).await;
    stale.is_problem(409, "stale_revision");
    assert_eq!(stale.body["current"]["name"], "by somebody else");
    let stale = relay.rest.delete(&format!("{path}?revision=1")).await;
    stale.is_problem(409, "stale_revision");
    assert_eq!(stale.body["current"]["name"], "by somebody else");
    assert_eq!(relay.rest.get(&path).await.body["name"], "by somebody else");
}

#[tokio::test]
async fn bad_input_is_a_finding_at_its_field_and_nothing_is_stored() {
    let relay = Relay::start().await;
    let good = block::product_name("0,0");
    let rows: [(&str, Value, &str); 11] = [
        ("/AppCfg/Service", json!(300), "AppCfg.Service"),
        ("/AppCfg/Service", json!(0), "AppCfg.Service"),
        ("/AppCfg/Class", json!(-1), "AppCfg.Class"),
        ("/AppCfg/Instance", json!(4_294_967_296_i64), "AppCfg.Instance"),
        ("/AppCfg/MemberCnt", json!(4), "AppCfg.MemberCnt"),
        ("/CtrlCfg", json!({ "TriggerType": 65_536 }), "CtrlCfg.TriggerType"),
        ("/TargetCfg/Path", json!(""), "TargetCfg.Path"),
        ("/TargetCfg/Path", json!("4,127.0.0.1,1,0,1,0"), "TargetCfg.Path"),
        ("/TargetCfg/Path", json!("6,1"), "TargetCfg.Path"),
        ("/ReqData", json!("00".repeat(491)), "ReqData"),
        ("/ReqData", json!("123"), "ReqData"),
    ];
    for (pointer, value, field) in rows {
        let reply = relay.rest.post("blocks", &with(good.clone(), pointer, value)).await;
        reply.is_problem(422, "findings");
        let finding = error_at(&reply.body, field);
        assert!(finding["message"].as_str().is_some_and(|message| !message.is_empty()), "{finding}");
    }
    let listed = relay.rest.get("blocks").await.body;
    assert_eq!(listed.as_array().map(Vec::len), Some(0), "nothing is stored: {listed}");
}

#[tokio::test]
async fn a_finding_names_the_range_and_the_controllers_numbers() {
    let relay = Relay::start().await;
    let wrong = with(block::product_name("0,0"), "/AppCfg/Service", 300);
    let reply = relay.rest.post("blocks", &wrong).await;
    let finding = error_at(&reply.body, "AppCfg.Service");
    assert_eq!((&finding["min"], &finding["max"]), (&json!(1), &json!(127)), "{finding}");
    assert_eq!(finding["ErrorID"], 33, "{finding}");
}

#[tokio::test]
async fn every_finding_is_given_at_once() {
    let relay = Relay::start().await;
    let wrong = with(block::product_name(""), "/AppCfg/Service", 300);
    let reply = relay.rest.post("check", &with(wrong, "/AppCfg/Class", 0)).await;
    assert_eq!(reply.status, 200, "{reply:?}");
    for field in ["AppCfg.Service", "AppCfg.Class", "TargetCfg.Path"] {
        error_at(&reply.body, field);
    }
}

#[tokio::test]
async fn a_change_with_errors_leaves_the_stored_block_as_it_was() {
    let relay = Relay::start().await;
    let id = relay.rest.create(&block::product_name("0,0")).await;
    let before = relay.rest.get(&format!("blocks/{id}")).await.body;
    let reply = relay.rest.put(&format!("blocks/{id}"), &with(before.clone(), "/AppCfg/Service", 300)).await;
    reply.is_problem(422, "findings");
    assert_eq!(relay.rest.get(&format!("blocks/{id}")).await.body, before);
}

#[tokio::test]
async fn what_is_no_block_is_unreadable() {
    let relay = Relay::start().await;
    for text in ["", "{", "[]", "{\"name\":7}", "1x", "{\"name\":\"a\",\"AppCfg\":{\"Service\":\"1x\"}}"] {
        let request = relay.rest.request(Method::POST, "blocks").header("content-type", "application/json");
        cipdeck_tests::rest::Rest::send(request.body(text)).await.is_problem(400, "unreadable");
    }
}

fn error_at(body: &Value, field: &str) -> Value {
    let findings = body["findings"].as_array().into_iter().flatten();
    let mut errors = findings.filter(|finding| finding["severity"] == "error");
    errors.find(|finding| finding["field"] == field).unwrap_or_else(|| panic!("{field} in {body}")).clone()
}
