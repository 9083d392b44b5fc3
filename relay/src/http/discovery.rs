//! `POST /api/v1/discover`.

use axum::Json as Answer;
use axum::extract::State;
use cipdeck_shared::api::{DiscoverRequest, Discovered};
use cipdeck_shared::config::{Endpoint, Host};

use super::extract::OptionalJson;
use crate::app::App;
use crate::discover::{Search, SearchError};
use crate::error::ApiError;

/// Asks the network which devices there are. One search at a time: two would only hear each other's devices.
#[utoipa::path(
    post,
    path = "/discover",
    tag = "commands",
    request_body = Option<DiscoverRequest>,
    extensions(("x-cipdeck-problems" = json!(["busy"]))),
    responses((status = 200, description = "Who has answered, when the time for answers is over", body = Discovered))
)]
pub(super) async fn discover(
    State(app): State<App>,
    OptionalJson(request): OptionalJson<DiscoverRequest>,
) -> Result<Answer<Discovered>, ApiError> {
    let search = Search::parse(&request.addresses.unwrap_or_default(), request.timeout_ms)?;
    // Neighbours are asked, that is what it is for; others only where the lists allow them, so that nobody sends from
    // here to wherever they like.
    for address in search.elsewhere() {
        let endpoint = Endpoint { host: Host::Ip(address.ip().octets()), port: address.port() };
        app.policy
            .lists
            .allow_endpoint(&endpoint)
            .map_err(|denied| ApiError::NotPermitted(denied.to_string()))?;
    }
    let Ok(_turn) = app.discovery.try_lock() else {
        return Err(ApiError::Busy("a discovery is under way".to_owned()));
    };
    tokio::select! {
        found = search.run() => Ok(Answer(found)),
        () = app.stop.cancelled() => Err(ApiError::Unavailable("the relay is stopping".to_owned())),
    }
}

impl From<SearchError> for ApiError {
    fn from(error: SearchError) -> Self {
        match error {
            SearchError::Networks(_) => Self::Internal(error.to_string()),
            error => Self::Unreadable(error.to_string()),
        }
    }
}
