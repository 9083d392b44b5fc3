//! `GET /api/v1/health`.

use axum::Json;
use axum::extract::State;
use cipdeck_shared::api::Health;

use crate::app::App;

/// Whether the relay lives.
#[utoipa::path(
    get,
    path = "/health",
    tag = "relay",
    responses((status = 200, description = "It does", body = Health))
)]
pub(crate) async fn show(State(app): State<App>) -> Json<Health> {
    let version = env!("CARGO_PKG_VERSION").to_owned();
    Json(Health {
        status: "ok".to_owned(),
        version,
        blocks: app.blocks.hub().len(),
        history: app.history.health(),
    })
}
