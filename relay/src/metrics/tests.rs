use cipdeck_shared::api::{ActorKind, AuditHead, AuditState, HistoryHealth};
use cipdeck_shared::engine::{BlockView, Cause, TargetState};

use super::*;

fn now() -> Now {
    Now {
        blocks: 7,
        targets: vec![TargetState::Open, TargetState::Down, TargetState::Open],
        sessions: vec![ActorKind::Person],
        viewers: 2,
        window: true,
        read_only: false,
        audit: AuditState {
            records: 12,
            writable: true,
            trouble: None,
            verified: true,
            head: AuditHead { seq: 12, hash: String::new() },
        },
        history: HistoryHealth { recording: true, lost: 3 },
        history_runs: Some(100),
        history_waiting: 4,
    }
}

fn counted() -> Metrics {
    let metrics = Metrics::default();
    metrics.message(false, &BlockView { reply_us: Some(400), ..BlockView::default() });
    let failed = BlockView { cause: Some(Cause::new(CauseKind::Timeout)), ..BlockView::default() };
    metrics.message(true, &failed);
    let denied = BlockView { cause: Some(Cause::new(CauseKind::NotPermitted)), ..BlockView::default() };
    metrics.message(true, &denied);
    metrics.denied(&Denied::NoWindow);
    metrics.snapshot();
    metrics.request("GET", "/api/v1/blocks/{id}", 404);
    metrics.event(Event::SignInFailed);
    metrics.unseated();
    metrics
}

#[test]
fn what_has_happened_and_how_it_is_can_be_read() {
    let text = counted().text(&now()).unwrap();
    for line in [
        r#"cipdeck_messages_total{access="read",result="ok"} 1"#,
        r#"cipdeck_messages_total{access="write",result="timeout"} 1"#,
        r#"cipdeck_denied_total{reason="no_window"} 1"#,
        r#"cipdeck_reply_seconds_bucket{le="0.0005"} 1"#,
        "cipdeck_reply_seconds_count 1",
        "cipdeck_viewer_snapshots_total 1",
        r#"cipdeck_http_requests_total{method="GET",route="/api/v1/blocks/{id}",status="404"} 1"#,
        r#"cipdeck_audit_events_total{event="sign_in_failed"} 1"#,
        "cipdeck_connections_refused_total 1",
        r#"cipdeck_targets{state="open"} 2"#,
        r#"cipdeck_targets{state="connecting"} 0"#,
        r#"cipdeck_sessions{kind="person"} 1"#,
        "cipdeck_blocks 7",
        "cipdeck_viewers 2",
        "cipdeck_write_window_open 1",
        "cipdeck_read_only 0",
        "cipdeck_audit_records 12",
        "cipdeck_audit_writable 1",
        "cipdeck_history_recording 1",
        "cipdeck_history_waiting 4",
        "cipdeck_history_lost_total 3",
        "cipdeck_history_runs 100",
    ] {
        assert!(text.lines().any(|there| there == line), "{line} is not in\n{text}");
    }
    assert!(!text.contains("not_permitted"), "what was not sent is no message");
}

#[test]
fn every_metric_is_documented() {
    let document = include_str!("../../../docs/METRICS.md");
    let text = counted().text(&now()).unwrap();
    for name in text.lines().filter_map(|line| line.strip_prefix("# TYPE ")?.split(' ').next()) {
        assert!(document.contains(&format!("| `{name}")), "docs/METRICS.md lacks {name}");
    }
}
