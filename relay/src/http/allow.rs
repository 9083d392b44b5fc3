//! `/api/v1/allow`: what may be reached, and what operators may write.

use axum::Json as Answer;
use axum::extract::State;
use axum::http::StatusCode;
use cipdeck_shared::api::{AllowedTarget, AllowedWrite, NewAllowedTarget, NewAllowedWrite};

use super::caller::Caller;
use super::extract::{Json, Number};
use crate::app::App;
use crate::audit::Event;
use crate::error::ApiError;
use crate::permit::{RuleError, record};

/// The targets that may be reached.
#[utoipa::path(
    get,
    path = "/allow/targets",
    tag = "lists",
    responses((status = 200, description = "The list", body = Vec<AllowedTarget>))
)]
pub(super) async fn targets(State(app): State<App>) -> Answer<Vec<AllowedTarget>> {
    Answer(app.policy.lists.targets())
}

/// Allows a target.
#[utoipa::path(
    post,
    path = "/allow/targets",
    tag = "lists",
    request_body = NewAllowedTarget,
    responses((status = 201, description = "The entry", body = AllowedTarget))
)]
pub(super) async fn add_target(
    State(app): State<App>,
    Caller(actor): Caller,
    Json(mut new): Json<NewAllowedTarget>,
) -> Result<(StatusCode, Answer<AllowedTarget>), ApiError> {
    // In its one spelling.
    let rule: crate::permit::TargetRule = new.target.parse()?;
    new.target = rule.to_string();
    let id = app.store.add_allowed_target(new.clone()).await?;
    app.policy.lists.add_target(Some(id), &new)?;
    app.policy.note(
        &record(Event::ListAdded, &actor).with("target", new.target.clone()).with("note", new.note.clone()),
    );
    app.blocks.review();
    let NewAllowedTarget { target, note } = new;
    Ok((StatusCode::CREATED, Answer(AllowedTarget { id: Some(id), target, note, pinned: Vec::new() })))
}

/// Denies a target again.
#[utoipa::path(
    delete,
    path = "/allow/targets/{id}",
    tag = "lists",
    params(("id" = u64, Path, description = "The entry")),
    responses((status = 204, description = "The entry is gone"))
)]
pub(super) async fn remove_target(
    State(app): State<App>,
    Caller(actor): Caller,
    Number(id): Number,
) -> Result<StatusCode, ApiError> {
    let gone = app.policy.lists.targets().into_iter().find(|entry| entry.id == Some(id));
    let gone = gone.ok_or_else(|| no_entry(id))?;
    // First it is denied, then it is forgotten: a failure of the database denies too much, never too little.
    app.policy.lists.remove_target(id);
    app.blocks.review();
    app.store.remove_allowed_target(id).await?;
    app.policy.note(&record(Event::ListRemoved, &actor).with("target", gone.target));
    Ok(StatusCode::NO_CONTENT)
}

/// The writes that operators may send.
#[utoipa::path(
    get,
    path = "/allow/writes",
    tag = "lists",
    responses((status = 200, description = "The list", body = Vec<AllowedWrite>))
)]
pub(super) async fn writes(State(app): State<App>) -> Answer<Vec<AllowedWrite>> {
    Answer(app.policy.lists.writes())
}

/// Allows operators a write.
#[utoipa::path(
    post,
    path = "/allow/writes",
    tag = "lists",
    request_body = NewAllowedWrite,
    responses((status = 201, description = "The entry", body = AllowedWrite))
)]
pub(super) async fn add_write(
    State(app): State<App>,
    Caller(actor): Caller,
    Json(mut new): Json<NewAllowedWrite>,
) -> Result<(StatusCode, Answer<AllowedWrite>), ApiError> {
    let rule: crate::permit::TargetRule = new.target.parse()?;
    new.target = rule.to_string();
    if !(1..=127).contains(&new.service) {
        return Err(ApiError::Unreadable(format!("service {} is outside 1 to 127", new.service)));
    }
    let id = app.store.add_allowed_write(new.clone()).await?;
    app.policy.lists.add_write(Some(id), &new)?;
    app.policy.note(&record(Event::ListAdded, &actor).with("write", words(&new)));
    Ok((StatusCode::CREATED, Answer(AllowedWrite { id: Some(id), write: new })))
}

/// Denies operators a write again.
#[utoipa::path(
    delete,
    path = "/allow/writes/{id}",
    tag = "lists",
    params(("id" = u64, Path, description = "The entry")),
    responses((status = 204, description = "The entry is gone"))
)]
pub(super) async fn remove_write(
    State(app): State<App>,
    Caller(actor): Caller,
    Number(id): Number,
) -> Result<StatusCode, ApiError> {
    let gone = app.policy.lists.writes().into_iter().find(|entry| entry.id == Some(id));
    let gone = gone.ok_or_else(|| no_entry(id))?;
    app.policy.lists.remove_write(id);
    app.store.remove_allowed_write(id).await?;
    app.policy.note(&record(Event::ListRemoved, &actor).with("write", words(&gone.write)));
    Ok(StatusCode::NO_CONTENT)
}

fn no_entry(id: u64) -> ApiError {
    ApiError::NotFound(format!(
        "the list has no entry {id}; those of the configuration file are changed there"
    ))
}

fn words(write: &NewAllowedWrite) -> String {
    let any = |number: Option<u32>| number.map_or_else(|| "*".to_owned(), |number| number.to_string());
    let NewAllowedWrite { target, service, class, instance, attribute, .. } = write;
    format!("{service}/{class}/{}/{} at {target}", any(*instance), any(attribute.map(u32::from)))
}

impl From<RuleError> for ApiError {
    fn from(error: RuleError) -> Self {
        Self::Unreadable(error.to_string())
    }
}
