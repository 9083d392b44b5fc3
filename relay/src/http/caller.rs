//! Who has sent a request.

use std::convert::Infallible;

use axum::extract::{FromRequestParts, Request, State};
use axum::http::request::Parts;
use axum::middleware::Next;
use axum::response::{IntoResponse, Response};

use crate::actor::Actor;
use crate::app::App;
use crate::error::ApiError;

/// The caller of a route that asks for one.
#[derive(Clone, Debug)]
pub(crate) struct Caller(pub(crate) Actor);

/// The caller of a route that answers anybody.
#[derive(Clone, Debug)]
pub(crate) struct MaybeCaller(pub(crate) Option<Actor>);

/// Finds out who calls, and answers nobody else.
pub(super) async fn identify(State(app): State<App>, mut request: Request, next: Next) -> Response {
    match app.local {
        Some(role) => {
            request.extensions_mut().insert(Actor::local(role, "127.0.0.1"));
        }
        None if request.uri().path() != "/api/v1/health" && request.uri().path().starts_with("/api") => {
            return ApiError::SignedOut("sign in first".to_owned()).into_response();
        }
        None => {}
    }
    next.run(request).await
}

impl<S: Sync> FromRequestParts<S> for Caller {
    type Rejection = ApiError;

    async fn from_request_parts(parts: &mut Parts, _: &S) -> Result<Self, ApiError> {
        let actor = parts.extensions.get::<Actor>().cloned();
        actor.map(Self).ok_or_else(|| ApiError::SignedOut("sign in first".to_owned()))
    }
}

impl<S: Sync> FromRequestParts<S> for MaybeCaller {
    type Rejection = Infallible;

    async fn from_request_parts(parts: &mut Parts, _: &S) -> Result<Self, Infallible> {
        Ok(Self(parts.extensions.get::<Actor>().cloned()))
    }
}
