//! Cyclic writes end with what allowed them.

use cipdeck_shared::api::Role;
use serde_json::{Value, json};

use super::site::{PATIENCE, Person, Site};
use crate::permit::permit;

/// A cyclic write that is under way, and who started it.
async fn running(site: &Site, writer: &Person) -> String {
    let engineer = site.person(Role::Engineer);
    let block = json!({
        "name": "speed",
        "AppCfg": { "Service": 16, "Class": 4, "Instance": 150, "Attribute": 3 },
        "TargetCfg": { "Path": format!("4,{}", site.device) },
        "CtrlCfg": { "TriggerType": 20 },
        "ReqData": "07".repeat(32),
    });
    let id = engineer.create(&block).await;
    let ticket = writer.ticket(&id).await.expect("a ticket");
    let path = format!("blocks/{id}/in");
    let (status, body) = writer.ask("POST", &path, &json!({ "IN": true, "ticket": ticket })).await;
    assert_eq!(status, 200, "{body}");
    engineer.status_where(&id, |status| status["runs"].as_u64() >= Some(3)).await;
    id
}

/// Waits until it has ended, and says why.
async fn ended(site: &Site, id: &str) -> String {
    let ended = |status: &Value| status["IN"] == false && status["phase"] == "failed";
    let status = site.person(Role::Engineer).status_where(id, ended).await;
    assert_eq!(status["cause"]["what"], "not_permitted", "{status}");
    status["cause"]["detail"].as_str().unwrap().to_owned()
}

#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn a_cyclic_write_ends_with_the_right_of_its_owner() {
    let site = Site::start(permit).await;
    let (admin, engineer) = (site.person(Role::Admin), site.person(Role::Engineer));
    assert_eq!(engineer.ask("POST", "window", &json!({})).await.0, 200);
    let writer = admin.hire("bob", Role::Engineer).await;
    let id = running(&site, &writer).await;
    let change = json!({ "role": "viewer" });
    assert_eq!(admin.ask("PATCH", "users/bob", &change).await.0, 200);
    assert!(ended(&site, &id).await.contains("viewer"));

    let change = json!({ "role": "engineer" });
    assert_eq!(admin.ask("PATCH", "users/bob", &change).await.0, 200);
    let writer = writer.sign_in("bob").await;
    let id = running(&site, &writer).await;
    assert_eq!(writer.ask("DELETE", "session", &Value::Null).await.0, 204);
    assert!(ended(&site, &id).await.contains("signed out"));
    site.stop().await;
}

#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn a_cyclic_write_ends_with_its_window() {
    let site = Site::start(permit).await;
    let (engineer, operator) = (site.person(Role::Engineer), site.person(Role::Operator));
    for closed_by in ["a button", "the loss of its owner"] {
        let owner = site.person(Role::Admin).hire(&closed_by.replace(' ', "-"), Role::Operator).await;
        assert_eq!(owner.ask("POST", "window", &json!({ "minutes": 1 })).await.0, 200);
        let id = running(&site, engineer).await;
        match closed_by {
            "a button" => assert_eq!(operator.ask("DELETE", "window", &Value::Null).await.0, 204),
            _ => assert_eq!(owner.ask("DELETE", "session", &Value::Null).await.0, 204),
        }
        assert!(ended(&site, &id).await.contains("window"), "{closed_by}");
        // The next window does not start it again.
        let runs = |status: &Value| status["runs"].as_u64();
        let before = engineer.status_where(&id, |_| true).await;
        assert_eq!(engineer.ask("POST", "window", &json!({})).await.0, 200);
        let reader = running(&site, engineer).await;
        let after = engineer.status_where(&id, |_| true).await;
        assert_eq!((runs(&after), &after["IN"]), (runs(&before), &json!(false)), "{after}");
        assert_eq!(engineer.ask("DELETE", "window", &Value::Null).await.0, 204);
        ended(&site, &reader).await;
    }
    site.stop().await;
}

#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn a_target_that_is_no_longer_allowed_is_left_at_once() {
    let site = Site::start(permit).await;
    let (admin, engineer) = (site.person(Role::Admin), site.person(Role::Engineer));
    let rule = json!({ "target": format!("{} via *", site.other), "note": "for a while" });
    let (status, entry) = admin.ask("POST", "allow/targets", &rule).await;
    assert_eq!(status, 201, "{entry}");
    let block = json!({
        "name": "kept", "KeepAlive": 1000,
        "AppCfg": { "Service": 14, "Class": 1, "Instance": 1, "Attribute": 7 },
        "TargetCfg": { "Path": format!("4,{}", site.other) },
    });
    let id = engineer.create(&block).await;
    assert_eq!(engineer.ask("POST", &format!("blocks/{id}/run"), &Value::Null).await.0, 200);
    let state = || async {
        let (_, targets) = engineer.ask("GET", "targets", &Value::Null).await;
        targets.as_array().unwrap().iter().find(|it| it["target"] == site.other.to_string()).cloned()
    };
    assert_eq!(state().await.unwrap()["state"], "open");
    let gone = admin.ask("DELETE", &format!("allow/targets/{}", entry["id"]), &Value::Null).await;
    assert_eq!(gone.0, 204, "{}", gone.1);
    let left = async {
        while state().await.is_some_and(|target| target["state"] == "open") {
            tokio::task::yield_now().await;
        }
    };
    tokio::time::timeout(PATIENCE, left).await.expect("the session is left");
    let (status, body) = engineer.ask("POST", &format!("blocks/{id}/run"), &Value::Null).await;
    assert_eq!((status, &body["code"]), (403, &json!("not_permitted")), "{body}");
    site.stop().await;
}
