//! The WebSocket at `/api/v1/ws`. docs/WEBSOCKET.md describes it.

mod command;
mod viewer;

use axum::extract::State;
use axum::extract::ws::rejection::WebSocketUpgradeRejection;
use axum::extract::ws::{WebSocket, WebSocketUpgrade};
use axum::response::Response;
use futures_util::StreamExt;
use tokio_tungstenite::tungstenite::Error as TungsteniteError;

use self::viewer::Seat;
use crate::app::App;
use crate::error::ApiError;
use crate::http::Caller;

/// Longest message that a viewer may send.
const MAX_MESSAGE: usize = 64 * 1024;

/// Longest message that is read at all. What lies between is read to its end, so that the viewer hears why the
/// connection is closed.
const MAX_READ: usize = 1024 * 1024;

/// Opens the WebSocket, which docs/WEBSOCKET.md describes.
///
/// The messages are the schemas `ClientMessage` and `ServerMessage`.
#[utoipa::path(
    get,
    path = "/ws",
    tag = "relay",
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
        let seat = Seat { actor, blocks: app.blocks, policy: app.policy, stop: app.stop };
        viewers.track_future(viewer::serve(sink, stream, seat, is_too_long)).await;
    };
    Ok(upgrade.max_message_size(MAX_READ).max_frame_size(MAX_READ).on_upgrade(serve))
}

fn is_too_long(error: &axum::Error) -> bool {
    use std::error::Error;
    let source = error.source().and_then(|source| source.downcast_ref::<TungsteniteError>());
    matches!(source, Some(TungsteniteError::Capacity(_)))
}
