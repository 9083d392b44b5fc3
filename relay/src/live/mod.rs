//! The WebSocket at `/api/v1/live`: devices, groups and values. docs/LIVE.md describes it.

mod viewer;

use axum::extract::State;
use axum::extract::ws::rejection::WebSocketUpgradeRejection;
use axum::extract::ws::{WebSocket, WebSocketUpgrade};
use axum::response::Response;
use futures_util::StreamExt;

use self::viewer::Seat;
use crate::app::App;
use crate::error::ApiError;
use crate::http::Caller;

/// Longest message that a viewer may send.
const MAX_MESSAGE: usize = 64 * 1024;

/// Opens the WebSocket for devices and values, which docs/LIVE.md describes.
///
/// The messages are the schemas `LiveClientMessage` and `LiveServerMessage`.
#[utoipa::path(
    get,
    path = "/live",
    tag = "devices",
    extensions(("x-cipdeck-problems" = json!(["unreadable"]))),
    responses((status = 101, description = "The WebSocket is open"))
)]
// `Host` and `Origin` have been checked.
pub(crate) async fn upgrade(
    State(app): State<App>,
    Caller(actor): Caller,
    upgrade: Result<WebSocketUpgrade, WebSocketUpgradeRejection>,
) -> Result<Response, ApiError> {
    let upgrade = upgrade.map_err(|rejection| {
        ApiError::Unreadable(format!("not a WebSocket handshake: {}", rejection.body_text()))
    })?;
    let serve = move |socket: WebSocket| async move {
        let viewers = app.viewers.clone();
        let (sink, stream) = socket.split();
        let seat = Seat { actor, plant: app.plant, policy: app.policy, stop: app.stop };
        viewers.track_future(viewer::serve(sink, stream, seat)).await;
    };
    Ok(upgrade.max_message_size(MAX_MESSAGE).max_frame_size(MAX_MESSAGE).on_upgrade(serve))
}
