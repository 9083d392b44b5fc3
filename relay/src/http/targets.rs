//! `/api/v1/targets`: the sessions and connections of the relay.

use axum::Json as Answer;
use axum::extract::State;
use cipdeck_shared::api::TargetStatus;

use crate::app::App;

/// The sessions and connections of the relay.
#[utoipa::path(
    get,
    path = "/targets",
    tag = "blocks",
    responses((status = 200, description = "The targets", body = Vec<TargetStatus>))
)]
pub(super) async fn list(State(app): State<App>) -> Answer<Vec<TargetStatus>> {
    Answer(app.blocks.targets())
}
