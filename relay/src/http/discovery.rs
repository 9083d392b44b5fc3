//! `POST /api/v1/discover`.

use axum::Json as Answer;
use axum::extract::State;
use cipdeck_shared::api::{DiscoverRequest, Discovered};

use super::extract::OptionalJson;
use crate::app::App;
use crate::discover::{Search, SearchError};
use crate::error::ApiError;

/// Answers when the time for answers is over. One search at a time: two would only hear each other's devices.
pub(super) async fn discover(
    State(app): State<App>,
    OptionalJson(request): OptionalJson<DiscoverRequest>,
) -> Result<Answer<Discovered>, ApiError> {
    let search = Search::parse(&request.addresses.unwrap_or_default(), request.timeout_ms)?;
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
