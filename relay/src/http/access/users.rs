//! Users and their sessions, for administrators.

use axum::Json as Answer;
use axum::extract::State;
use axum::http::StatusCode;
use cipdeck_shared::api::{NewUser, SessionEntry, UserChange, UserView};

use super::super::caller::Caller;
use super::super::extract::{Json, Name, Number};
use crate::app::App;
use crate::error::ApiError;

/// All users.
#[utoipa::path(
    get,
    path = "/users",
    tag = "access",
    responses((status = 200, description = "The users", body = Vec<UserView>))
)]
pub(in crate::http) async fn list(State(app): State<App>) -> Answer<Vec<UserView>> {
    Answer(app.access.users())
}

/// Adds a user.
#[utoipa::path(
    post,
    path = "/users",
    tag = "access",
    request_body = NewUser,
    extensions(("x-cipdeck-problems" = json!(["conflict"]))),
    responses((status = 201, description = "The user", body = UserView))
)]
pub(in crate::http) async fn add(
    State(app): State<App>,
    Caller(actor): Caller,
    Json(new): Json<NewUser>,
) -> Result<(StatusCode, Answer<UserView>), ApiError> {
    let user = app.access.add_user(new, &actor).await?;
    Ok((StatusCode::CREATED, Answer(user)))
}

/// Changes role, password or lock of a user.
#[utoipa::path(
    patch,
    path = "/users/{name}",
    tag = "access",
    params(("name" = String, Path, description = "The user")),
    request_body = UserChange,
    extensions(("x-cipdeck-problems" = json!(["conflict"]))),
    responses((status = 200, description = "The user", body = UserView))
)]
pub(in crate::http) async fn change(
    State(app): State<App>,
    Caller(actor): Caller,
    Name(name): Name,
    Json(change): Json<UserChange>,
) -> Result<Answer<UserView>, ApiError> {
    app.access.change_user(&name, change, &actor).await.map(Answer)
}

/// Removes a user.
#[utoipa::path(
    delete,
    path = "/users/{name}",
    tag = "access",
    params(("name" = String, Path, description = "The user")),
    extensions(("x-cipdeck-problems" = json!(["conflict"]))),
    responses((status = 204, description = "The user is gone"))
)]
pub(in crate::http) async fn remove(
    State(app): State<App>,
    Caller(actor): Caller,
    Name(name): Name,
) -> Result<StatusCode, ApiError> {
    app.access.remove_user(&name, &actor).await?;
    Ok(StatusCode::NO_CONTENT)
}

/// All open sessions.
#[utoipa::path(
    get,
    path = "/sessions",
    tag = "access",
    responses((status = 200, description = "The sessions", body = Vec<SessionEntry>))
)]
pub(in crate::http) async fn sessions(State(app): State<App>) -> Answer<Vec<SessionEntry>> {
    Answer(app.access.sessions())
}

/// Ends a session.
#[utoipa::path(
    delete,
    path = "/sessions/{id}",
    tag = "access",
    params(("id" = u64, Path, description = "The session")),
    responses((status = 204, description = "It has ended"))
)]
pub(in crate::http) async fn end_session(
    State(app): State<App>,
    Caller(actor): Caller,
    Number(id): Number,
) -> Result<StatusCode, ApiError> {
    app.access.end_session(id, &actor)?;
    Ok(StatusCode::NO_CONTENT)
}
