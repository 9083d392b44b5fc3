//! `/api/v1/groups`: variables that are read together, and their values.

use axum::Json as Answer;
use axum::extract::State;
use axum::http::{StatusCode, header};
use axum::response::IntoResponse;
use cipdeck_shared::api::{GroupValues, NewVariables, VariablesCsv};
use cipdeck_shared::config::{Group, GroupConfig, GroupId, Variable};

use super::caller::Caller;
use super::extract::{Json, PlantId, Revision};
use crate::app::App;
use crate::error::ApiError;

/// Adds a group to a device.
#[utoipa::path(
    post,
    path = "/groups",
    tag = "devices",
    request_body = GroupConfig,
    extensions(("x-cipdeck-problems" = json!(["findings", "conflict", "not_found"]))),
    responses((status = 201, description = "The group as it was stored", body = Group))
)]
pub(super) async fn create(
    State(app): State<App>,
    Caller(actor): Caller,
    Json(config): Json<GroupConfig>,
) -> Result<(StatusCode, Answer<Group>), ApiError> {
    let group = app.plant.add_group(&actor, config).await?;
    Ok((StatusCode::CREATED, Answer(group)))
}

/// Replaces a group, or turns it on or off; the body names the revision that was seen.
#[utoipa::path(
    put,
    path = "/groups/{id}",
    tag = "devices",
    params(("id" = GroupId, Path, description = "The group")),
    request_body = Group,
    extensions(("x-cipdeck-problems" = json!(["conflict", "findings", "stale_revision"]))),
    responses((status = 200, description = "The group as it was stored", body = Group))
)]
pub(super) async fn replace(
    State(app): State<App>,
    Caller(actor): Caller,
    PlantId(id): PlantId<GroupId>,
    Json(group): Json<Group>,
) -> Result<Answer<Group>, ApiError> {
    app.plant.replace_group(&actor, id, group).await.map(Answer)
}

/// Deletes a group with its variables.
#[utoipa::path(
    delete,
    path = "/groups/{id}",
    tag = "devices",
    params(
        ("id" = GroupId, Path, description = "The group"),
        ("revision" = u64, Query, description = "The revision that was seen"),
    ),
    extensions(("x-cipdeck-problems" = json!(["conflict", "stale_revision"]))),
    responses((status = 204, description = "It is gone"))
)]
pub(super) async fn delete(
    State(app): State<App>,
    Caller(actor): Caller,
    PlantId(id): PlantId<GroupId>,
    Revision(revision): Revision,
) -> Result<StatusCode, ApiError> {
    app.plant.remove_group(&actor, id, revision).await?;
    Ok(StatusCode::NO_CONTENT)
}

/// The newest values of a group.
#[utoipa::path(
    get,
    path = "/groups/{id}/values",
    tag = "devices",
    params(("id" = GroupId, Path, description = "The group")),
    responses((status = 200, description = "One of each variable, in their order", body = GroupValues))
)]
pub(super) async fn values(
    State(app): State<App>,
    PlantId(id): PlantId<GroupId>,
) -> Result<Answer<GroupValues>, ApiError> {
    app.plant.values(id).map(Answer)
}

/// The variables of a group.
#[utoipa::path(
    get,
    path = "/groups/{id}/variables",
    tag = "devices",
    params(("id" = GroupId, Path, description = "The group")),
    responses((status = 200, description = "In their order", body = Vec<Variable>))
)]
pub(super) async fn variables(
    State(app): State<App>,
    PlantId(id): PlantId<GroupId>,
) -> Result<Answer<Vec<Variable>>, ApiError> {
    app.plant.variables(id).map(Answer)
}

/// Adds variables: all of them, or none.
#[utoipa::path(
    post,
    path = "/groups/{id}/variables",
    tag = "devices",
    params(("id" = GroupId, Path, description = "The group")),
    request_body = NewVariables,
    extensions(("x-cipdeck-problems" = json!(["conflict", "findings"]))),
    responses((status = 201, description = "The variables as they were stored", body = Vec<Variable>))
)]
pub(super) async fn add(
    State(app): State<App>,
    Caller(actor): Caller,
    PlantId(id): PlantId<GroupId>,
    Json(new): Json<NewVariables>,
) -> Result<(StatusCode, Answer<Vec<Variable>>), ApiError> {
    let variables = app.plant.add_variables(&actor, id, new).await?;
    Ok((StatusCode::CREATED, Answer(variables)))
}

/// The variables of a group as a file for a spreadsheet.
#[utoipa::path(
    get,
    path = "/groups/{id}/variables.csv",
    tag = "devices",
    params(("id" = GroupId, Path, description = "The group")),
    responses((status = 200, description = "The file", body = String, content_type = "text/csv"))
)]
pub(super) async fn csv(
    State(app): State<App>,
    PlantId(id): PlantId<GroupId>,
) -> Result<impl IntoResponse, ApiError> {
    let (name, file) = app.plant.csv(id)?;
    let headers = [
        (header::CONTENT_TYPE, "text/csv; charset=utf-8; header=present".to_owned()),
        (header::CONTENT_DISPOSITION, format!("attachment; filename=\"{name}\"")),
    ];
    Ok((headers, file))
}

/// Adds the variables of such a file: all of them, or none.
#[utoipa::path(
    post,
    path = "/groups/{id}/variables.csv",
    tag = "devices",
    params(("id" = GroupId, Path, description = "The group")),
    request_body = VariablesCsv,
    extensions(("x-cipdeck-problems" = json!(["conflict", "findings"]))),
    responses((status = 201, description = "The variables as they were stored", body = Vec<Variable>))
)]
pub(super) async fn add_csv(
    State(app): State<App>,
    Caller(actor): Caller,
    PlantId(id): PlantId<GroupId>,
    Json(file): Json<VariablesCsv>,
) -> Result<(StatusCode, Answer<Vec<Variable>>), ApiError> {
    let variables = app.plant.add_csv(&actor, id, file.csv).await?;
    Ok((StatusCode::CREATED, Answer(variables)))
}
