//! `/api/v1/health` and `/api/v1/ready`: for whoever watches the relay. Strangers hear that it lives, and no more.

use axum::Json;
use axum::extract::State;
use axum::http::StatusCode;
use cipdeck_shared::api::{Health, Ready};

use super::caller::Caller;
use crate::app::App;

/// Whether the relay lives.
#[utoipa::path(
    get,
    path = "/health",
    tag = "relay",
    responses((status = 200, description = "It does", body = Health))
)]
pub(super) async fn show(State(app): State<App>, caller: Option<Caller>) -> Json<Health> {
    Json(Health {
        status: "ok".to_owned(),
        version: env!("CARGO_PKG_VERSION").to_owned(),
        blocks: caller.as_ref().map(|_| app.blocks.hub().len()),
        history: caller.map(|_| app.history.health()),
    })
}

/// Whether everything works that messages need.
#[utoipa::path(
    get,
    path = "/ready",
    tag = "relay",
    responses(
        (status = 200, description = "It does", body = Ready),
        (status = 503, description = "Something does not", body = Ready)
    )
)]
pub(super) async fn ready(State(app): State<App>, caller: Option<Caller>) -> (StatusCode, Json<Ready>) {
    let mut trouble = Vec::new();
    if let Err(error) = app.store.load_lists().await {
        trouble.push(format!("database: {error}"));
    }
    if let Some(why) = app.audit.state().trouble {
        trouble.push(format!("audit: {why}"));
    }
    if app.history.is_on() && !app.history.health().recording {
        trouble.push("history: runs are lost; history/state says why".to_owned());
    }
    let ready = trouble.is_empty();
    let status = if ready { StatusCode::OK } else { StatusCode::SERVICE_UNAVAILABLE };
    (status, Json(Ready { ready, trouble: if caller.is_some() { trouble } else { Vec::new() } }))
}
