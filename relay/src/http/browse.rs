//! `/api/v1/devices/{id}/browse`: what a device has.

use axum::Json as Answer;
use axum::extract::rejection::QueryRejection;
use axum::extract::{Query, State};
use axum::http::StatusCode;
use cipdeck_shared::api::{BrowsePage, BrowseRequest, BrowsedType};
use cipdeck_shared::config::DeviceId;
use serde::Deserialize;

use super::caller::Caller;
use super::extract::{OptionalJson, PlantId};
use crate::app::App;
use crate::error::ApiError;

/// `?from=120`
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct From {
    #[serde(default)]
    from: u32,
}

/// `?of=4660`
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Of {
    of: u32,
}

/// Begins to ask a device which variables it has. What was asked before ends.
#[utoipa::path(
    post,
    path = "/devices/{id}/browse",
    tag = "devices",
    params(("id" = DeviceId, Path, description = "The device")),
    request_body = Option<BrowseRequest>,
    extensions(("x-cipdeck-problems" = json!(["conflict"]))),
    responses((status = 202, description = "It is being asked"))
)]
pub(super) async fn begin(
    State(app): State<App>,
    Caller(actor): Caller,
    PlantId(id): PlantId<DeviceId>,
    OptionalJson(request): OptionalJson<BrowseRequest>,
) -> Result<StatusCode, ApiError> {
    app.plant.browse(&actor, id, request)?;
    Ok(StatusCode::ACCEPTED)
}

/// What has been found until now.
#[utoipa::path(
    get,
    path = "/devices/{id}/browse",
    tag = "devices",
    params(
        ("id" = DeviceId, Path, description = "The device"),
        ("from" = Option<u32>, Query, description = "The first name that is wanted; 0 without"),
    ),
    responses((status = 200, description = "At most 1000 names", body = BrowsePage))
)]
pub(super) async fn show(
    State(app): State<App>,
    PlantId(id): PlantId<DeviceId>,
    from: Result<Query<From>, QueryRejection>,
) -> Result<Answer<BrowsePage>, ApiError> {
    let Query(From { from }) = from.map_err(unreadable)?;
    app.plant.browsed(id, usize::try_from(from).unwrap_or(usize::MAX)).map(Answer)
}

/// Ends asking; what has been found stays.
#[utoipa::path(
    delete,
    path = "/devices/{id}/browse",
    tag = "devices",
    params(("id" = DeviceId, Path, description = "The device")),
    responses((status = 204, description = "Nothing is asked any more"))
)]
pub(super) async fn end(
    State(app): State<App>,
    PlantId(id): PlantId<DeviceId>,
) -> Result<StatusCode, ApiError> {
    app.plant.end_browse(id)?;
    Ok(StatusCode::NO_CONTENT)
}

/// Asks a device what a structure is made of.
#[utoipa::path(
    get,
    path = "/devices/{id}/browse/type",
    tag = "devices",
    params(
        ("id" = DeviceId, Path, description = "The device"),
        ("of" = u32, Query, description = "The `structure` of a variable that was found"),
    ),
    extensions(("x-cipdeck-problems" = json!(["conflict"]))),
    responses((status = 200, description = "Its members", body = BrowsedType))
)]
pub(super) async fn structure(
    State(app): State<App>,
    Caller(actor): Caller,
    PlantId(id): PlantId<DeviceId>,
    of: Result<Query<Of>, QueryRejection>,
) -> Result<Answer<BrowsedType>, ApiError> {
    let Query(Of { of }) = of.map_err(unreadable)?;
    app.plant.browsed_type(&actor, id, of).await.map(Answer)
}

#[expect(clippy::needless_pass_by_value, reason = "of the shape that map_err takes")]
fn unreadable(rejection: QueryRejection) -> ApiError {
    ApiError::Unreadable(rejection.body_text())
}
