//! `/api/v1/variables`: one variable.

use axum::Json as Answer;
use axum::extract::State;
use axum::http::StatusCode;
use cipdeck_shared::api::{NewValue, VariableWritten, WriteTicket, WriteVariable};
use cipdeck_shared::config::{Variable, VariableId};

use super::caller::Caller;
use super::extract::{Json, PlantId, Revision};
use crate::app::App;
use crate::error::ApiError;

/// Replaces a variable; the body names the revision that was seen.
#[utoipa::path(
    put,
    path = "/variables/{id}",
    tag = "devices",
    params(("id" = VariableId, Path, description = "The variable")),
    request_body = Variable,
    extensions(("x-cipdeck-problems" = json!(["conflict", "findings", "stale_revision"]))),
    responses((status = 200, description = "The variable as it was stored", body = Variable))
)]
pub(super) async fn replace(
    State(app): State<App>,
    Caller(actor): Caller,
    PlantId(id): PlantId<VariableId>,
    Json(variable): Json<Variable>,
) -> Result<Answer<Variable>, ApiError> {
    app.plant.replace_variable(&actor, id, variable).await.map(Answer)
}

/// Deletes a variable with its parts.
#[utoipa::path(
    delete,
    path = "/variables/{id}",
    tag = "devices",
    params(
        ("id" = VariableId, Path, description = "The variable"),
        ("revision" = u64, Query, description = "The revision that was seen"),
    ),
    extensions(("x-cipdeck-problems" = json!(["conflict", "stale_revision"]))),
    responses((status = 204, description = "It is gone"))
)]
pub(super) async fn delete(
    State(app): State<App>,
    Caller(actor): Caller,
    PlantId(id): PlantId<VariableId>,
    Revision(revision): Revision,
) -> Result<StatusCode, ApiError> {
    app.plant.remove_variable(&actor, id, revision).await?;
    Ok(StatusCode::NO_CONTENT)
}

/// The first half of a write: reads what is there, and gives a ticket for the write.
#[utoipa::path(
    post,
    path = "/variables/{id}/offer",
    tag = "writing",
    params(("id" = VariableId, Path, description = "The variable")),
    request_body = NewValue,
    extensions(("x-cipdeck-problems" = json!(["findings", "conflict", "busy"]))),
    responses((status = 200, description = "The ticket", body = WriteTicket))
)]
pub(super) async fn offer(
    State(app): State<App>,
    Caller(actor): Caller,
    PlantId(id): PlantId<VariableId>,
    Json(value): Json<NewValue>,
) -> Result<Answer<WriteTicket>, ApiError> {
    app.plant.offer(&actor, id, &value.text).await.map(Answer)
}

/// The second half of a write: sends it, and reads what is there then.
#[utoipa::path(
    post,
    path = "/variables/{id}/write",
    tag = "writing",
    params(("id" = VariableId, Path, description = "The variable")),
    request_body = WriteVariable,
    extensions(("x-cipdeck-problems" = json!(["conflict"]))),
    responses((status = 200, description = "What has become of it, also when the device has refused it", body = VariableWritten))
)]
pub(super) async fn write(
    State(app): State<App>,
    Caller(actor): Caller,
    PlantId(id): PlantId<VariableId>,
    Json(write): Json<WriteVariable>,
) -> Result<Answer<VariableWritten>, ApiError> {
    app.plant.write(&actor, id, &write.ticket).await.map(Answer)
}
