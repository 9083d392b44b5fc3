//! API tokens and view links, for administrators.

use axum::Json as Answer;
use axum::extract::State;
use axum::http::{HeaderMap, StatusCode};
use cipdeck_shared::api::{NewToken, NewViewLink, PassView, TokenCreated, ViewLinkCreated};

use super::super::caller::Caller;
use super::super::extract::{Json, Number};
use super::view::{address, qr_svg};
use crate::access::{MadeLink, MadeToken, PassKind};
use crate::app::App;
use crate::error::ApiError;

/// All API tokens, without their secrets.
#[utoipa::path(
    get,
    path = "/tokens",
    tag = "access",
    responses((status = 200, description = "The tokens", body = Vec<PassView>))
)]
pub(in crate::http) async fn tokens(State(app): State<App>) -> Answer<Vec<PassView>> {
    Answer(app.access.passes(PassKind::Token))
}

/// Makes an API token; its secret is shown this once.
#[utoipa::path(
    post,
    path = "/tokens",
    tag = "access",
    request_body = NewToken,
    extensions(("x-cipdeck-problems" = json!(["conflict"]))),
    responses((status = 201, description = "The token", body = TokenCreated))
)]
pub(in crate::http) async fn make_token(
    State(app): State<App>,
    Caller(actor): Caller,
    Json(new): Json<NewToken>,
) -> Result<(StatusCode, Answer<TokenCreated>), ApiError> {
    let MadeToken { view: token, secret } = app.access.make_token(new, &actor).await?;
    Ok((StatusCode::CREATED, Answer(TokenCreated { token, secret })))
}

/// Revokes an API token.
#[utoipa::path(
    delete,
    path = "/tokens/{id}",
    tag = "access",
    params(("id" = u64, Path, description = "The token")),
    responses((status = 204, description = "It is gone"))
)]
pub(in crate::http) async fn revoke_token(
    State(app): State<App>,
    Caller(actor): Caller,
    Number(id): Number,
) -> Result<StatusCode, ApiError> {
    app.access.revoke(PassKind::Token, id, &actor).await?;
    Ok(StatusCode::NO_CONTENT)
}

/// All view links, without their secrets.
#[utoipa::path(
    get,
    path = "/view-links",
    tag = "access",
    responses((status = 200, description = "The links", body = Vec<PassView>))
)]
pub(in crate::http) async fn links(State(app): State<App>) -> Answer<Vec<PassView>> {
    Answer(app.access.passes(PassKind::ViewLink))
}

/// Makes a view link; it is shown this once.
#[utoipa::path(
    post,
    path = "/view-links",
    tag = "access",
    request_body = NewViewLink,
    extensions(("x-cipdeck-problems" = json!(["conflict"]))),
    responses((status = 201, description = "The link", body = ViewLinkCreated))
)]
pub(in crate::http) async fn make_link(
    State(app): State<App>,
    Caller(actor): Caller,
    headers: HeaderMap,
    Json(new): Json<NewViewLink>,
) -> Result<(StatusCode, Answer<ViewLinkCreated>), ApiError> {
    let base = address(&headers, &actor)?;
    let MadeLink { view: link, secret } = app.access.make_link(new, &actor).await?;
    let url = format!("{base}/view/{secret}");
    let qr_svg = qr_svg(&url)?;
    Ok((StatusCode::CREATED, Answer(ViewLinkCreated { link, url, qr_svg })))
}

/// Revokes a view link.
#[utoipa::path(
    delete,
    path = "/view-links/{id}",
    tag = "access",
    params(("id" = u64, Path, description = "The link")),
    responses((status = 204, description = "It is gone"))
)]
pub(in crate::http) async fn revoke_link(
    State(app): State<App>,
    Caller(actor): Caller,
    Number(id): Number,
) -> Result<StatusCode, ApiError> {
    app.access.revoke(PassKind::ViewLink, id, &actor).await?;
    Ok(StatusCode::NO_CONTENT)
}
