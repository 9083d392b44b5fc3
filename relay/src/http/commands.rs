//! Commands to a block, and the check that needs none.

use axum::Json as Answer;
use axum::extract::State;
use cipdeck_shared::api::{BlockStatus, Checked, InRequest, RunRequest};
use cipdeck_shared::config::BlockId;

use super::caller::Caller;
use super::extract::{Id, Json, OptionalJson};
use crate::app::App;
use crate::blocks;
use crate::draft::Draft;
use crate::error::ApiError;

/// Sets the input; answers at once.
#[utoipa::path(
    post,
    path = "/blocks/{id}/in",
    tag = "commands",
    params(("id" = BlockId, Path, description = "The block")),
    request_body = InRequest,
    extensions(("x-cipdeck-problems" = json!(["busy"]))),
    responses((status = 200, description = "The status", body = BlockStatus))
)]
pub(super) async fn set_in(
    State(app): State<App>,
    Caller(actor): Caller,
    Id(id): Id,
    Json(request): Json<InRequest>,
) -> Result<Answer<BlockStatus>, ApiError> {
    app.blocks.set_in(&actor, id, request.input, request.ticket.as_deref()).await.map(Answer)
}

/// Sends one message; answers when it has ended.
#[utoipa::path(
    post,
    path = "/blocks/{id}/run",
    tag = "commands",
    params(("id" = BlockId, Path, description = "The block")),
    request_body = Option<RunRequest>,
    extensions(("x-cipdeck-problems" = json!(["busy"]))),
    responses((status = 200, description = "The status at the end, also of a message that failed", body = BlockStatus))
)]
pub(super) async fn run(
    State(app): State<App>,
    Caller(actor): Caller,
    Id(id): Id,
    OptionalJson(request): OptionalJson<RunRequest>,
) -> Result<Answer<BlockStatus>, ApiError> {
    app.blocks.run(&actor, id, request.ticket.as_deref()).await.map(Answer)
}

/// Ends a message that is under way.
#[utoipa::path(
    post,
    path = "/blocks/{id}/cancel",
    tag = "commands",
    params(("id" = BlockId, Path, description = "The block")),
    responses((status = 200, description = "The status", body = BlockStatus))
)]
pub(super) async fn cancel(State(app): State<App>, Id(id): Id) -> Result<Answer<BlockStatus>, ApiError> {
    app.blocks.cancel(id).map(Answer)
}

/// What is to be said about a configuration; stores nothing and sends nothing.
#[utoipa::path(
    post,
    path = "/check",
    tag = "blocks",
    request_body = Draft,
    responses((status = 200, description = "All findings", body = Checked))
)]
pub(super) async fn check(Json(draft): Json<Draft>) -> Answer<Checked> {
    Answer(blocks::check(&draft.config))
}
