//! Commands to a block, and the check that needs none.

use axum::Json as Answer;
use axum::extract::State;
use cipdeck_shared::api::{BlockStatus, Checked, InRequest, RunRequest};

use super::caller::Caller;
use super::extract::{Id, Json, OptionalJson};
use crate::app::App;
use crate::blocks;
use crate::draft::Draft;
use crate::error::ApiError;

/// `POST blocks/{id}/in`: answers at once.
pub(super) async fn set_in(
    State(app): State<App>,
    Caller(actor): Caller,
    Id(id): Id,
    Json(request): Json<InRequest>,
) -> Result<Answer<BlockStatus>, ApiError> {
    app.blocks.set_in(&actor, id, request.input, request.ticket.as_deref()).await.map(Answer)
}

/// `POST blocks/{id}/run`: answers at DN or ER.
pub(super) async fn run(
    State(app): State<App>,
    Caller(actor): Caller,
    Id(id): Id,
    OptionalJson(request): OptionalJson<RunRequest>,
) -> Result<Answer<BlockStatus>, ApiError> {
    app.blocks.run(&actor, id, request.ticket.as_deref()).await.map(Answer)
}

/// `POST blocks/{id}/cancel`
pub(super) async fn cancel(State(app): State<App>, Id(id): Id) -> Result<Answer<BlockStatus>, ApiError> {
    app.blocks.cancel(id).map(Answer)
}

/// `POST check`
pub(super) async fn check(Json(draft): Json<Draft>) -> Answer<Checked> {
    Answer(blocks::check(&draft.config))
}
