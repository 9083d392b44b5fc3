//! `GET /api/v1/health`.

use axum::Json;
use serde_json::{Value, json};

/// The relay lives.
pub(crate) async fn show() -> Json<Value> {
    Json(json!({ "status": "ok", "version": env!("CARGO_PKG_VERSION"), "blocks": 0 }))
}
