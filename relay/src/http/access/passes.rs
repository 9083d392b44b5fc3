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

/// `GET tokens`
pub(in crate::http) async fn tokens(State(app): State<App>) -> Answer<Vec<PassView>> {
    Answer(app.access.passes(PassKind::Token))
}

/// `POST tokens`
pub(in crate::http) async fn make_token(
    State(app): State<App>,
    Caller(actor): Caller,
    Json(new): Json<NewToken>,
) -> Result<(StatusCode, Answer<TokenCreated>), ApiError> {
    let MadeToken { view: token, secret } = app.access.make_token(new, &actor).await?;
    Ok((StatusCode::CREATED, Answer(TokenCreated { token, secret })))
}

/// `DELETE tokens/{id}`
pub(in crate::http) async fn revoke_token(
    State(app): State<App>,
    Caller(actor): Caller,
    Number(id): Number,
) -> Result<StatusCode, ApiError> {
    app.access.revoke(PassKind::Token, id, &actor).await?;
    Ok(StatusCode::NO_CONTENT)
}

/// `GET view-links`
pub(in crate::http) async fn links(State(app): State<App>) -> Answer<Vec<PassView>> {
    Answer(app.access.passes(PassKind::ViewLink))
}

/// `POST view-links`
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

/// `DELETE view-links/{id}`
pub(in crate::http) async fn revoke_link(
    State(app): State<App>,
    Caller(actor): Caller,
    Number(id): Number,
) -> Result<StatusCode, ApiError> {
    app.access.revoke(PassKind::ViewLink, id, &actor).await?;
    Ok(StatusCode::NO_CONTENT)
}
