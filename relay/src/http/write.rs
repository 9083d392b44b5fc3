//! Writing: the window, the tickets, the switch.

use axum::Json as Answer;
use axum::extract::State;
use axum::http::StatusCode;
use cipdeck_shared::api::{ActorKind, NewWindow, ReadOnly, WriteRequest, WriteState, WriteTicket};

use super::caller::Caller;
use super::extract::{Id, Json, OptionalJson};
use crate::app::App;
use crate::error::ApiError;
use crate::permit::OpenError;

/// `GET window`
pub(super) async fn show(State(app): State<App>) -> Answer<WriteState> {
    Answer(app.policy.write_state())
}

/// `POST window`
pub(super) async fn open(
    State(app): State<App>,
    Caller(actor): Caller,
    OptionalJson(new): OptionalJson<NewWindow>,
) -> Result<Answer<WriteState>, ApiError> {
    app.policy.open_window(&actor, new.minutes)?;
    Ok(Answer(app.policy.write_state()))
}

/// `DELETE window`
pub(super) async fn close(State(app): State<App>, Caller(actor): Caller) -> StatusCode {
    app.policy.close_window(&actor);
    StatusCode::NO_CONTENT
}

/// `POST blocks/{id}/write`: reads what is there, and gives a ticket for the write.
pub(super) async fn offer(
    State(app): State<App>,
    Caller(actor): Caller,
    Id(id): Id,
    Json(request): Json<WriteRequest>,
) -> Result<Answer<WriteTicket>, ApiError> {
    app.blocks.offer(&actor, id, request.revision).await.map(Answer)
}

/// `GET read-only`
pub(super) async fn read_only(State(app): State<App>) -> Answer<ReadOnly> {
    Answer(ReadOnly { read_only: app.policy.read_only.is_on() })
}

/// `PUT read-only`: on from everywhere, off with local access alone.
pub(super) async fn set_read_only(
    State(app): State<App>,
    Caller(actor): Caller,
    Json(wanted): Json<ReadOnly>,
) -> Result<Answer<ReadOnly>, ApiError> {
    let failed = |error: std::io::Error| ApiError::Internal(format!("the switch cannot be set: {error}"));
    if wanted.read_only {
        app.policy.stop_writing(&actor).map_err(failed)?;
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
