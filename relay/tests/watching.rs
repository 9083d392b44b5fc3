//! Health, readiness and metrics: what a stranger hears, and what whoever may look hears.

#![expect(clippy::unwrap_used, reason = "a test ends where it fails")]

mod common;

use cipdeck_relay::Settings;
use common::{Relay, local};
use serde_json::json;

#[tokio::test]
async fn a_stranger_hears_that_it_lives_and_no_more() {
    let folder = tempfile::tempdir().unwrap();
    let relay = Relay::start(Settings::stored_in(folder.path())).await;
    let health = relay.ask("GET", "/api/v1/health", "").await;
    assert_eq!(health.json(), json!({"status": "ok", "version": env!("CARGO_PKG_VERSION")}));
    let ready = relay.ask("GET", "/api/v1/ready", "").await;
    assert_eq!((ready.status, ready.json()), (200, json!({"ready": true})));
    for path in ["/metrics", "/api/v1/openapi.json"] {
        let refused = relay.ask("GET", path, "").await;
        assert_eq!(refused.problem(), (401, "signed_out".to_owned()));
        assert!(!refused.body.contains("cipdeck_"), "{refused:?}");
    }
    relay.stop().await;
}

#[tokio::test]
async fn whoever_may_look_hears_how_it_is() {
    let folder = tempfile::tempdir().unwrap();
    let relay = Relay::start(local(Settings::stored_in(folder.path()))).await;
    let health = relay.ask("GET", "/api/v1/health", "").await.json();
    assert_eq!((&health["blocks"], &health["history"]["recording"]), (&json!(0), &json!(true)));
    relay.ask("GET", "/api/v1/blocks/b1", "").await.problem();
    relay.ask("GET", "/no-such-page.css", "").await.problem();

    let metrics = relay.ask("GET", "/metrics", "").await;
    assert!(metrics.headers.contains("content-type: application/openmetrics-text"), "{metrics:?}");
    for line in [
        r#"cipdeck_http_requests_total{method="GET",route="/api/v1/blocks/{id}",status="404"} 1"#,
        r#"cipdeck_http_requests_total{method="GET",route="page",status="404"} 1"#,
        r#"cipdeck_audit_events_total{event="start"} 1"#,
        "cipdeck_audit_writable 1",
    ] {
        assert!(metrics.body.lines().any(|there| there == line), "{line} is not in\n{}", metrics.body);
    }
    relay.stop().await;
}

#[tokio::test]
async fn a_broken_audit_is_not_ready_and_strangers_do_not_hear_why() {
    let folder = tempfile::tempdir().unwrap();
    let audit = folder.path().join("audit.jsonl");
    Relay::start(Settings::stored_in(folder.path())).await.stop().await;
    let text = std::fs::read_to_string(&audit).unwrap();
    std::fs::write(&audit, text.replacen("start", "stood", 1)).unwrap();

    let relay = Relay::start(Settings::stored_in(folder.path())).await;
    let ready = relay.ask("GET", "/api/v1/ready", "").await;
    assert_eq!((ready.status, ready.json()), (503, json!({"ready": false})));
    relay.stop().await;
    let relay = Relay::start(local(Settings::stored_in(folder.path()))).await;
    let ready = relay.ask("GET", "/api/v1/ready", "").await;
    assert_eq!(ready.status, 503);
    assert!(ready.json()["trouble"][0].as_str().unwrap().starts_with("audit: "), "{ready:?}");
    relay.stop().await;
}
