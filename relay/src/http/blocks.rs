//! `/api/v1/blocks`: the stored blocks and how they look.

use axum::Json as Answer;
use axum::extract::State;
use axum::http::{StatusCode, header};
use axum::response::IntoResponse;
use cipdeck_shared::api::{BlockStatus, ExchangeView};
use cipdeck_shared::config::Block;

use super::caller::Caller;
use super::extract::{Id, Json, Revision};
use crate::app::App;
use crate::draft::Draft;
use crate::error::ApiError;

/// `GET blocks`
pub(super) async fn list(State(app): State<App>) -> Answer<Vec<Block>> {
    Answer(app.blocks.hub().blocks())
}

/// `POST blocks`
pub(super) async fn create(
    State(app): State<App>,
    Caller(actor): Caller,
    Json(draft): Json<Draft>,
) -> Result<impl IntoResponse, ApiError> {
    let block = app.blocks.create(&actor, draft).await?;
    let location = format!("/api/v1/blocks/{}", block.id);
    Ok((StatusCode::CREATED, [(header::LOCATION, location)], Answer(block)))
}

/// `GET blocks/{id}`
pub(super) async fn show(State(app): State<App>, Id(id): Id) -> Result<Answer<Block>, ApiError> {
    app.blocks.block(id).map(Answer)
}

/// `PUT blocks/{id}`
pub(super) async fn replace(
    State(app): State<App>,
    Caller(actor): Caller,
    Id(id): Id,
    Json(draft): Json<Draft>,
) -> Result<Answer<Block>, ApiError> {
    app.blocks.replace(&actor, id, draft).await.map(Answer)
}

/// `DELETE blocks/{id}?revision=3`
pub(super) async fn delete(
    State(app): State<App>,
    Caller(actor): Caller,
    Id(id): Id,
    Revision(revision): Revision,
) -> Result<StatusCode, ApiError> {
    app.blocks.delete(&actor, id, revision).await?;
    Ok(StatusCode::NO_CONTENT)
}

/// `GET blocks/{id}/status`
pub(super) async fn status(State(app): State<App>, Id(id): Id) -> Result<Answer<BlockStatus>, ApiError> {
    app.blocks.status(id).map(Answer)
}

/// `GET blocks/{id}/exchange`
pub(super) async fn exchange(
    State(app): State<App>,
    Id(id): Id,
) -> Result<Answer<Vec<ExchangeView>>, ApiError> {
    app.blocks.exchanges(id).map(Answer)
}

/// `GET blocks/{id}/exchange.pcapng`
pub(super) async fn capture(State(app): State<App>, Id(id): Id) -> Result<impl IntoResponse, ApiError> {
    let (name, file) = app.blocks.capture(id)?;
    let headers = [
        (header::CONTENT_TYPE, "application/x-pcapng".to_owned()),
        (header::CONTENT_DISPOSITION, format!("attachment; filename=\"{name}\"")),
    ];
    Ok((headers, file))
}
