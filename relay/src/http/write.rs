//! Writing: the window, the tickets, the switch.

use axum::Json as Answer;
use axum::extract::State;
use axum::http::StatusCode;
use cipdeck_shared::api::{ActorKind, NewWindow, ReadOnly, WriteRequest, WriteState, WriteTicket};
use cipdeck_shared::config::BlockId;

use super::caller::Caller;
use super::extract::{Id, Json, OptionalJson};
use crate::app::App;
use crate::error::ApiError;
use crate::permit::OpenError;

/// The write window, and whether anything can be written.
#[utoipa::path(
    get,
    path = "/window",
    tag = "writing",
    responses((status = 200, description = "The window", body = WriteState))
)]
pub(super) async fn show(State(app): State<App>) -> Answer<WriteState> {
    Answer(app.policy.write_state())
}

/// Opens the write window.
#[utoipa::path(
    post,
    path = "/window",
    tag = "writing",
    request_body = Option<NewWindow>,
    extensions(("x-cipdeck-problems" = json!(["busy"]))),
    responses((status = 200, description = "The window", body = WriteState))
)]
pub(super) async fn open(
    State(app): State<App>,
    Caller(actor): Caller,
    OptionalJson(new): OptionalJson<NewWindow>,
) -> Result<Answer<WriteState>, ApiError> {
    app.policy.open_window(&actor, new.minutes)?;
    Ok(Answer(app.policy.write_state()))
}

/// Closes the write window.
#[utoipa::path(
    delete,
    path = "/window",
    tag = "writing",
    responses((status = 204, description = "It is closed"))
)]
pub(super) async fn close(State(app): State<App>, Caller(actor): Caller) -> StatusCode {
    app.policy.close_window(&actor);
    StatusCode::NO_CONTENT
}

/// The first half of a write: reads what is there, and gives a ticket for the write.
#[utoipa::path(
    post,
    path = "/blocks/{id}/write",
    tag = "writing",
    params(("id" = BlockId, Path, description = "The block")),
    request_body = WriteRequest,
    extensions(("x-cipdeck-problems" = json!(["busy", "stale_revision"]))),
    responses((status = 200, description = "The ticket", body = WriteTicket))
)]
pub(super) async fn offer(
    State(app): State<App>,
    Caller(actor): Caller,
    Id(id): Id,
    Json(request): Json<WriteRequest>,
) -> Result<Answer<WriteTicket>, ApiError> {
    app.blocks.offer(&actor, id, request.revision).await.map(Answer)
}

/// Whether all writing is stopped.
#[utoipa::path(
    get,
    path = "/read-only",
    tag = "writing",
    responses((status = 200, description = "The switch", body = ReadOnly))
)]
pub(super) async fn read_only(State(app): State<App>) -> Answer<ReadOnly> {
    Answer(ReadOnly { read_only: app.policy.read_only.is_on() })
}

/// Stops all writing; only local access allows it again.
#[utoipa::path(
    put,
    path = "/read-only",
    tag = "writing",
    request_body = ReadOnly,
    responses((status = 200, description = "The switch", body = ReadOnly))
)]
pub(super) async fn set_read_only(
    State(app): State<App>,
    Caller(actor): Caller,
    Json(wanted): Json<ReadOnly>,
) -> Result<Answer<ReadOnly>, ApiError> {
    let failed = |error: std::io::Error| ApiError::Internal(format!("the switch cannot be set: {error}"));
    if wanted.read_only {
        app.policy.stop_writing(&actor).map_err(|error| {
            ApiError::Internal(format!(
                "writing is stopped, but only until the relay ends: the switch cannot be kept: {error}"
            ))
        })?;
    } else if actor.kind() == ActorKind::Local {
        app.policy.write_again(&actor).map_err(failed)?;
    } else {
        let how =
            "only local access turns this off: cipdeck read-only off --data DIR, on the relay's machine";
        return Err(ApiError::NotPermitted(how.to_owned()));
    }
    Ok(read_only(State(app)).await)
}

impl From<OpenError> for ApiError {
    fn from(error: OpenError) -> Self {
        use crate::permit::NotOpened;
        match &error {
            OpenError::Window(NotOpened::AlreadyOpen(_)) => Self::Busy(error.to_string()),
            OpenError::Window(NotOpened::Minutes) => Self::Unreadable(error.to_string()),
            OpenError::Window(NotOpened::NotAllowed) | OpenError::Denied(_) => {
                Self::NotPermitted(error.to_string())
            }
        }
    }
}
