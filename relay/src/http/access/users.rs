//! Users and their sessions, for administrators.

use axum::Json as Answer;
use axum::extract::State;
use axum::http::StatusCode;
use cipdeck_shared::api::{NewUser, SessionEntry, UserChange, UserView};

use super::super::caller::Caller;
use super::super::extract::{Json, Name, Number};
use crate::app::App;
use crate::error::ApiError;

/// `GET users`
pub(in crate::http) async fn list(State(app): State<App>) -> Answer<Vec<UserView>> {
    Answer(app.access.users())
}

/// `POST users`
pub(in crate::http) async fn add(
    State(app): State<App>,
    Caller(actor): Caller,
    Json(new): Json<NewUser>,
) -> Result<(StatusCode, Answer<UserView>), ApiError> {
    let user = app.access.add_user(new, &actor).await?;
    Ok((StatusCode::CREATED, Answer(user)))
}

/// `PATCH users/{name}`
pub(in crate::http) async fn change(
    State(app): State<App>,
    Caller(actor): Caller,
    Name(name): Name,
    Json(change): Json<UserChange>,
) -> Result<Answer<UserView>, ApiError> {
    app.access.change_user(&name, change, &actor).await.map(Answer)
}

/// `DELETE users/{name}`
pub(in crate::http) async fn remove(
    State(app): State<App>,
    Caller(actor): Caller,
    Name(name): Name,
) -> Result<StatusCode, ApiError> {
    app.access.remove_user(&name, &actor).await?;
    Ok(StatusCode::NO_CONTENT)
}

/// `GET sessions`
pub(in crate::http) async fn sessions(State(app): State<App>) -> Answer<Vec<SessionEntry>> {
    Answer(app.access.sessions())
}

/// `DELETE sessions/{id}`
pub(in crate::http) async fn end_session(
    State(app): State<App>,
    Caller(actor): Caller,
    Number(id): Number,
) -> Result<StatusCode, ApiError> {
    app.access.end_session(id, &actor)?;
    Ok(StatusCode::NO_CONTENT)
}
