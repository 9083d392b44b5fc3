//! Parts of requests, whose rejections are problems like all others.

use std::net::{IpAddr, SocketAddr};
use std::str::FromStr;
use std::time::Duration;

use axum::extract::{ConnectInfo, FromRequest, FromRequestParts, Path, Request};
use axum::http::request::Parts;
use cipdeck_shared::config::{BadId, BlockId};
use futures_util::StreamExt;
use serde::de::DeserializeOwned;

use crate::error::ApiError;
use crate::project::MAX_ARCHIVE;

/// Bytes of a body.
const MAX_BODY: usize = 1024 * 1024;

/// Bytes that are read and thrown away, so that a client who is still writing hears the answer.
const MAX_DRAINED: usize = 16 * MAX_BODY;

/// Time for a body to arrive.
const TO_ARRIVE: Duration = Duration::from_secs(30);

/// A body as JSON, at most 1 MB.
#[derive(Debug)]
pub(super) struct Json<T>(pub(super) T);

/// A body as JSON; without a body the default.
#[derive(Debug)]
pub(super) struct OptionalJson<T>(pub(super) T);

/// A zip archive.
#[derive(Debug)]
pub(super) struct Archive(pub(super) Vec<u8>);

/// The block in the address.
#[derive(Clone, Copy, Debug)]
pub(super) struct Id(pub(super) BlockId);

/// The device, the group or the variable in the address.
#[derive(Clone, Copy, Debug)]
pub(super) struct PlantId<T>(pub(super) T);

/// The number in the address, of anything but a block.
#[derive(Clone, Copy, Debug)]
pub(super) struct Number(pub(super) u64);

/// The name in the address. Not printed: it may be a secret.
#[derive(Clone)]
pub(super) struct Name(pub(super) String);

/// Where the request comes from.
#[derive(Clone, Copy, Debug)]
pub(super) struct Peer(pub(super) IpAddr);

/// `?revision=3`
#[derive(Clone, Copy, Debug)]
pub(super) struct Revision(pub(super) u64);

impl<S: Sync, T: DeserializeOwned> FromRequest<S> for Json<T> {
    type Rejection = ApiError;

    async fn from_request(request: Request, _: &S) -> Result<Self, ApiError> {
        parse(&body(request, MAX_BODY).await?).map(Self)
    }
}

impl<S: Sync> FromRequest<S> for Archive {
    type Rejection = ApiError;

    async fn from_request(request: Request, _: &S) -> Result<Self, ApiError> {
        body(request, MAX_ARCHIVE).await.map(Self)
    }
}

impl<S: Sync, T: DeserializeOwned + Default> FromRequest<S> for OptionalJson<T> {
    type Rejection = ApiError;

    async fn from_request(request: Request, _: &S) -> Result<Self, ApiError> {
        let body = body(request, MAX_BODY).await?;
        if body.iter().all(u8::is_ascii_whitespace) { Ok(Self(T::default())) } else { parse(&body).map(Self) }
    }
}

impl<S: Send + Sync> FromRequestParts<S> for Id {
    type Rejection = ApiError;

    async fn from_request_parts(parts: &mut Parts, state: &S) -> Result<Self, ApiError> {
        let unknown = |text: &str| ApiError::NotFound(format!("there is no block {text}"));
        let Path(text) =
            Path::<String>::from_request_parts(parts, state).await.map_err(|_| unknown("like that"))?;
        text.parse().map(Self).map_err(|_| unknown(&text))
    }
}

impl<S: Send + Sync, T: FromStr<Err = BadId> + Send> FromRequestParts<S> for PlantId<T> {
    type Rejection = ApiError;

    async fn from_request_parts(parts: &mut Parts, state: &S) -> Result<Self, ApiError> {
        let unknown = |why: BadId| ApiError::NotFound(format!("there is nothing like that: {why}"));
        let text = Path::<String>::from_request_parts(parts, state).await.map(|Path(text)| text);
        text.unwrap_or_default().parse().map(Self).map_err(unknown)
    }
}

impl<S: Send + Sync> FromRequestParts<S> for Number {
    type Rejection = ApiError;

    async fn from_request_parts(parts: &mut Parts, state: &S) -> Result<Self, ApiError> {
        let number = Path::<u64>::from_request_parts(parts, state).await;
        number
            .map(|Path(number)| Self(number))
            .map_err(|_| ApiError::NotFound("an id is a number".to_owned()))
    }
}

impl<S: Send + Sync> FromRequestParts<S> for Name {
    type Rejection = ApiError;

    async fn from_request_parts(parts: &mut Parts, state: &S) -> Result<Self, ApiError> {
        let name = Path::<String>::from_request_parts(parts, state).await;
        name.map(|Path(name)| Self(name))
            .map_err(|_| ApiError::NotFound("the name cannot be read".to_owned()))
    }
}

impl<S: Send + Sync> FromRequestParts<S> for Peer {
    type Rejection = ApiError;

    async fn from_request_parts(parts: &mut Parts, state: &S) -> Result<Self, ApiError> {
        let peer = ConnectInfo::<SocketAddr>::from_request_parts(parts, state).await;
        peer.map(|ConnectInfo(peer)| Self(peer.ip().to_canonical()))
            .map_err(|rejection| ApiError::Internal(rejection.body_text()))
    }
}

impl<S: Sync> FromRequestParts<S> for Revision {
    type Rejection = ApiError;

    async fn from_request_parts(parts: &mut Parts, _: &S) -> Result<Self, ApiError> {
        let mut pairs = parts.uri.query().unwrap_or_default().split('&');
        let revision =
            pairs.find_map(|pair| pair.strip_prefix("revision=")).and_then(|text| text.parse().ok());
        revision
            .map(Self)
            .ok_or_else(|| ApiError::Unreadable("say which revision you have seen: ?revision=3".to_owned()))
    }
}

async fn body(request: Request, most: usize) -> Result<Vec<u8>, ApiError> {
    let late = |_| ApiError::Unreadable(format!("the body did not arrive within {} s", TO_ARRIVE.as_secs()));
    tokio::time::timeout(TO_ARRIVE, arriving(request, most)).await.map_err(late)?
}

async fn arriving(request: Request, most: usize) -> Result<Vec<u8>, ApiError> {
    let mut chunks = request.into_body().into_data_stream();
    let (mut body, mut length) = (Vec::new(), 0_usize);
    while let Some(chunk) = chunks.next().await {
        let chunk =
            chunk.map_err(|error| ApiError::Unreadable(format!("the body did not arrive: {error}")))?;
        length = length.saturating_add(chunk.len());
        if length <= most {
            body.extend_from_slice(&chunk);
        } else if length > MAX_DRAINED {
            break;
        }
    }
    if length > most { Err(ApiError::TooLarge(most)) } else { Ok(body) }
}

/// Everything that the relay takes is an object. Read into a structure, an array would do, too: its members without
/// their names.
fn parse<T: DeserializeOwned>(body: &[u8]) -> Result<T, ApiError> {
    if !body.trim_ascii_start().starts_with(b"{") {
        return Err(ApiError::Unreadable("the body cannot be read: it has to be a JSON object".to_owned()));
    }
    serde_json::from_slice(body)
        .map_err(|error| ApiError::Unreadable(format!("the body cannot be read: {error}")))
}

#[cfg(test)]
mod tests {
    use axum::body::Body;
    use cipdeck_shared::api::RunRequest;

    use super::*;

    #[tokio::test(start_paused = true)]
    async fn a_body_that_does_not_end_is_given_up() {
        let beginning = futures_util::stream::iter([Ok::<_, std::io::Error>("{")]);
        let endless = Body::from_stream(beginning.chain(futures_util::stream::pending()));
        let refused = body(Request::new(endless), MAX_BODY).await.unwrap_err();
        assert!(refused.to_string().contains("within 30 s"), "{refused}");
    }

    #[test]
    fn members_without_their_names_are_no_request() {
        assert!(parse::<RunRequest>(b" {\"ticket\":null}").is_ok());
        for body in ["[null]", "[\"9f2c\"]", "null", "", "\"{\""] {
            assert!(matches!(parse::<RunRequest>(body.as_bytes()), Err(ApiError::Unreadable(_))), "{body}");
        }
    }
}
