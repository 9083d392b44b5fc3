//! `/api/v1/blocks`: the stored blocks and how they look.

use axum::Json as Answer;
use axum::extract::State;
use axum::http::{StatusCode, header};
use axum::response::IntoResponse;
use cipdeck_shared::api::{BlockStatus, ExchangeView};
use cipdeck_shared::config::{Block, BlockId};

use super::caller::Caller;
use super::extract::{Id, Json, Revision};
use crate::app::App;
use crate::draft::Draft;
use crate::error::ApiError;

/// All blocks, by id.
#[utoipa::path(
    get,
    path = "/blocks",
    tag = "blocks",
    responses((status = 200, description = "The blocks", body = Vec<Block>))
)]
pub(super) async fn list(State(app): State<App>) -> Answer<Vec<Block>> {
    Answer(app.blocks.hub().blocks())
}

/// Stores a new block.
#[utoipa::path(
    post,
    path = "/blocks",
    tag = "blocks",
    request_body = Draft,
    extensions(("x-cipdeck-problems" = json!(["conflict", "findings"]))),
    responses((status = 201, description = "The block as it was stored", body = Block, headers(("location" = String, description = "Where the block is"))))
)]
pub(super) async fn create(
    State(app): State<App>,
    Caller(actor): Caller,
    Json(draft): Json<Draft>,
) -> Result<impl IntoResponse, ApiError> {
    let block = app.blocks.create(&actor, draft).await?;
    let location = format!("/api/v1/blocks/{}", block.id);
    Ok((StatusCode::CREATED, [(header::LOCATION, location)], Answer(block)))
}

/// A block.
#[utoipa::path(
    get,
    path = "/blocks/{id}",
    tag = "blocks",
    params(("id" = BlockId, Path, description = "The block")),
    responses((status = 200, description = "The block", body = Block))
)]
pub(super) async fn show(State(app): State<App>, Id(id): Id) -> Result<Answer<Block>, ApiError> {
    app.blocks.block(id).map(Answer)
}

/// Replaces a block; the body names the revision that was seen.
#[utoipa::path(
    put,
    path = "/blocks/{id}",
    tag = "blocks",
    params(("id" = BlockId, Path, description = "The block")),
    request_body = Draft,
    extensions(("x-cipdeck-problems" = json!(["conflict", "findings", "stale_revision"]))),
    responses((status = 200, description = "The block as it was stored", body = Block))
)]
pub(super) async fn replace(
    State(app): State<App>,
    Caller(actor): Caller,
    Id(id): Id,
    Json(draft): Json<Draft>,
) -> Result<Answer<Block>, ApiError> {
    app.blocks.replace(&actor, id, draft).await.map(Answer)
}

/// Cancels and deletes a block.
#[utoipa::path(
    delete,
    path = "/blocks/{id}",
    tag = "blocks",
    params(
        ("id" = BlockId, Path, description = "The block"),
        ("revision" = u64, Query, description = "The revision that was seen"),
    ),
    extensions(("x-cipdeck-problems" = json!(["conflict", "stale_revision"]))),
    responses((status = 204, description = "It is gone"))
)]
pub(super) async fn delete(
    State(app): State<App>,
    Caller(actor): Caller,
    Id(id): Id,
    Revision(revision): Revision,
) -> Result<StatusCode, ApiError> {
    app.blocks.delete(&actor, id, revision).await?;
    Ok(StatusCode::NO_CONTENT)
}

/// How a block looks now.
#[utoipa::path(
    get,
    path = "/blocks/{id}/status",
    tag = "blocks",
    params(("id" = BlockId, Path, description = "The block")),
    responses((status = 200, description = "The status", body = BlockStatus))
)]
pub(super) async fn status(State(app): State<App>, Id(id): Id) -> Result<Answer<BlockStatus>, ApiError> {
    app.blocks.status(id).map(Answer)
}

/// The last exchanges of a block, the newest last.
#[utoipa::path(
    get,
    path = "/blocks/{id}/exchange",
    tag = "blocks",
    params(("id" = BlockId, Path, description = "The block")),
    responses((status = 200, description = "At most 16", body = Vec<ExchangeView>))
)]
pub(super) async fn exchange(
    State(app): State<App>,
    Id(id): Id,
) -> Result<Answer<Vec<ExchangeView>>, ApiError> {
    app.blocks.exchanges(id).map(Answer)
}

/// The last exchanges of a block as a file for Wireshark.
#[utoipa::path(
    get,
    path = "/blocks/{id}/exchange.pcapng",
    tag = "blocks",
    params(("id" = BlockId, Path, description = "The block")),
    responses((status = 200, description = "The file", body = [u8], content_type = "application/x-pcapng"))
)]
pub(super) async fn capture(State(app): State<App>, Id(id): Id) -> Result<impl IntoResponse, ApiError> {
    let (name, file) = app.blocks.capture(id)?;
    let headers = [
        (header::CONTENT_TYPE, "application/x-pcapng".to_owned()),
        (header::CONTENT_DISPOSITION, format!("attachment; filename=\"{name}\"")),
    ];
    Ok((headers, file))
}
