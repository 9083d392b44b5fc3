//! `/api/v1/devices`: what is polled, and how it is.

use axum::Json as Answer;
use axum::extract::State;
use axum::http::{StatusCode, header};
use axum::response::IntoResponse;
use cipdeck_shared::api::{CopyDevice, DeviceStatus, Tree, WriteEntry};
use cipdeck_shared::config::{Device, DeviceConfig, DeviceId};

use super::caller::Caller;
use super::extract::{Json, PlantId, Revision};
use crate::app::App;
use crate::error::ApiError;

/// All devices with their groups.
#[utoipa::path(
    get,
    path = "/devices",
    tag = "devices",
    responses((status = 200, description = "Devices by id, groups in their order", body = Tree))
)]
pub(super) async fn list(State(app): State<App>) -> Answer<Tree> {
    Answer(app.plant.tree())
}

/// Adds a device.
#[utoipa::path(
    post,
    path = "/devices",
    tag = "devices",
    request_body = DeviceConfig,
    extensions(("x-cipdeck-problems" = json!(["findings", "conflict"]))),
    responses((status = 201, description = "The device as it was stored", body = Device, headers(("location" = String, description = "Where the device is"))))
)]
pub(super) async fn create(
    State(app): State<App>,
    Caller(actor): Caller,
    Json(config): Json<DeviceConfig>,
) -> Result<impl IntoResponse, ApiError> {
    Ok(created(app.plant.add_device(&actor, config).await?))
}

/// A device.
#[utoipa::path(
    get,
    path = "/devices/{id}",
    tag = "devices",
    params(("id" = DeviceId, Path, description = "The device")),
    responses((status = 200, description = "The device", body = Device))
)]
pub(super) async fn show(
    State(app): State<App>,
    PlantId(id): PlantId<DeviceId>,
) -> Result<Answer<Device>, ApiError> {
    app.plant.device(id).map(Answer)
}

/// Replaces a device; the body names the revision that was seen.
#[utoipa::path(
    put,
    path = "/devices/{id}",
    tag = "devices",
    params(("id" = DeviceId, Path, description = "The device")),
    request_body = Device,
    extensions(("x-cipdeck-problems" = json!(["conflict", "findings", "stale_revision"]))),
    responses((status = 200, description = "The device as it was stored", body = Device))
)]
pub(super) async fn replace(
    State(app): State<App>,
    Caller(actor): Caller,
    PlantId(id): PlantId<DeviceId>,
    Json(device): Json<Device>,
) -> Result<Answer<Device>, ApiError> {
    app.plant.replace_device(&actor, id, device).await.map(Answer)
}

/// Deletes a device with its groups and variables.
#[utoipa::path(
    delete,
    path = "/devices/{id}",
    tag = "devices",
    params(
        ("id" = DeviceId, Path, description = "The device"),
        ("revision" = u64, Query, description = "The revision that was seen"),
    ),
    extensions(("x-cipdeck-problems" = json!(["conflict", "stale_revision"]))),
    responses((status = 204, description = "It is gone"))
)]
pub(super) async fn delete(
    State(app): State<App>,
    Caller(actor): Caller,
    PlantId(id): PlantId<DeviceId>,
    Revision(revision): Revision,
) -> Result<StatusCode, ApiError> {
    app.plant.remove_device(&actor, id, revision).await?;
    Ok(StatusCode::NO_CONTENT)
}

/// Adds the same device at another place: with its groups, which are off, and their variables.
#[utoipa::path(
    post,
    path = "/devices/{id}/copy",
    tag = "devices",
    params(("id" = DeviceId, Path, description = "The device")),
    request_body = CopyDevice,
    extensions(("x-cipdeck-problems" = json!(["findings", "conflict"]))),
    responses((status = 201, description = "The new device", body = Device, headers(("location" = String, description = "Where the device is"))))
)]
pub(super) async fn copy(
    State(app): State<App>,
    Caller(actor): Caller,
    PlantId(id): PlantId<DeviceId>,
    Json(copy): Json<CopyDevice>,
) -> Result<impl IntoResponse, ApiError> {
    Ok(created(app.plant.copy_device(&actor, id, copy).await?))
}

/// How a device is: whether it answers, and what asking it costs.
#[utoipa::path(
    get,
    path = "/devices/{id}/status",
    tag = "devices",
    params(("id" = DeviceId, Path, description = "The device")),
    responses((status = 200, description = "The status", body = DeviceStatus))
)]
pub(super) async fn status(
    State(app): State<App>,
    PlantId(id): PlantId<DeviceId>,
) -> Result<Answer<DeviceStatus>, ApiError> {
    app.plant.status(id).map(Answer)
}

/// The last writes to the variables of a device, the newest first.
#[utoipa::path(
    get,
    path = "/devices/{id}/writes",
    tag = "devices",
    params(("id" = DeviceId, Path, description = "The device")),
    responses((status = 200, description = "At most 100", body = Vec<WriteEntry>))
)]
pub(super) async fn writes(
    State(app): State<App>,
    PlantId(id): PlantId<DeviceId>,
) -> Result<Answer<Vec<WriteEntry>>, ApiError> {
    app.plant.writes(id).await.map(Answer)
}

fn created(device: Device) -> impl IntoResponse {
    let location = format!("/api/v1/devices/{}", device.id);
    (StatusCode::CREATED, [(header::LOCATION, location)], Answer(device))
}
