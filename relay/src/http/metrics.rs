//! `/metrics`.

use axum::extract::State;
use axum::http::header;
use axum::response::IntoResponse;

use crate::app::App;
use crate::error::ApiError;
use crate::metrics::{CONTENT_TYPE, Now};

/// What is counted, and how things are now, as text for Prometheus.
#[utoipa::path(
    get,
    path = "/metrics",
    tag = "relay",
    responses((status = 200, description = "docs/METRICS.md lists what is in it", body = String, content_type = "application/openmetrics-text"))
)]
pub(super) async fn show(State(app): State<App>) -> Result<impl IntoResponse, ApiError> {
    let write = app.policy.write_state();
    let now = Now {
        blocks: app.blocks.hub().len(),
        targets: app.blocks.targets().into_iter().map(|target| target.state).collect(),
        sessions: app.access.sessions().into_iter().map(|session| session.kind).collect(),
        viewers: app.viewers.len(),
        window: write.window.is_some(),
        read_only: write.read_only,
        audit: app.audit.state(),
        history: app.history.health(),
        history_runs: app.history.state().await.ok().map(|state| state.runs),
        history_waiting: app.history.waiting(),
    };
    let text = app.policy.metrics.text(&now).map_err(|error| ApiError::Internal(error.to_string()))?;
    Ok(([(header::CONTENT_TYPE, CONTENT_TYPE)], text))
}
