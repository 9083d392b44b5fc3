//! `/api/v1/targets`: the sessions and connections of the relay.

use axum::Json as Answer;
use axum::extract::State;
use cipdeck_shared::api::TargetStatus;

use crate::app::App;

/// `GET targets`
pub(super) async fn list(State(app): State<App>) -> Answer<Vec<TargetStatus>> {
    Answer(app.blocks.targets())
}
