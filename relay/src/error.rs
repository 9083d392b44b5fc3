//! Errors at the edges: of a request ([`ApiError`], as `application/problem+json`) and of the process ([`RunError`]).

use std::net::SocketAddr;

use axum::http::{HeaderValue, StatusCode, header};
use axum::response::{IntoResponse, Response};

/// Why a request was not carried out.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[expect(dead_code, reason = "bodies are read once there are blocks")]
pub(crate) enum ApiError {
    /// Not JSON, or not the JSON that is expected here.
    #[error("{0}")]
    Unreadable(String),
    /// Who asks may not, or a write that nobody has confirmed.
    #[error("{0}")]
    NotPermitted(String),
    /// No such address.
    #[error("{0}")]
    NotFound(String),
    /// A body over its limit.
    #[error("the body is longer than {0} bytes")]
    TooLarge(usize),
}

impl ApiError {
    const fn kind(&self) -> (StatusCode, &'static str) {
        match self {
            Self::Unreadable(_) => (StatusCode::BAD_REQUEST, "unreadable"),
            Self::NotPermitted(_) => (StatusCode::FORBIDDEN, "not_permitted"),
            Self::NotFound(_) => (StatusCode::NOT_FOUND, "not_found"),
            Self::TooLarge(_) => (StatusCode::PAYLOAD_TOO_LARGE, "too_large"),
        }
    }
}

impl IntoResponse for ApiError {
    fn into_response(self) -> Response {
        let (status, code) = self.kind();
        let body = serde_json::json!({
            "title": code.replace('_', " "), "status": status.as_u16(), "code": code, "detail": self.to_string(),
        });
        let content_type = HeaderValue::from_static("application/problem+json");
        (status, [(header::CONTENT_TYPE, content_type)], body.to_string()).into_response()
    }
}

/// Why the relay cannot start or had to stop.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    /// The address is in use, or not ours.
    #[error("cannot listen on {0}: {1}")]
    Bind(SocketAddr, #[source] std::io::Error),
    /// The listener is broken.
    #[error("cannot listen: {0}")]
    Listen(#[source] std::io::Error),
    /// Not a loopback address.
    #[error(
        "{0} is not a loopback address: without users and roles the relay listens on 127.0.0.1 or [::1] only"
    )]
    NotLoopback(SocketAddr),
    /// The server failed.
    #[error("the server failed: {0}")]
    Serve(#[source] std::io::Error),
    /// The server's task ended by itself.
    #[error("the server stopped unexpectedly")]
    Stopped,
}
