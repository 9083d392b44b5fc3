//! Errors at the edges: of a request ([`ApiError`], as `application/problem+json`) and of the process ([`RunError`]).

use std::net::SocketAddr;
use std::time::Duration;

use axum::http::{HeaderValue, StatusCode, header};
use axum::response::{IntoResponse, Response};
use cipdeck_shared::api::{Finding, Problem, ProblemCode};
use cipdeck_shared::config::{Block, BlockId};

use crate::history::HistoryError;
use crate::project::FilesError;
use crate::runner::Refused;
use crate::store::StoreError;

/// Why a request or a command was not carried out.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub(crate) enum ApiError {
    /// Not JSON, or not the JSON that is expected here.
    #[error("{0}")]
    Unreadable(String),
    /// Nobody has signed in, or the session has ended.
    #[error("{0}")]
    SignedOut(String),
    /// Who asks may not, or not now.
    #[error("{0}")]
    NotPermitted(String),
    /// No such address, no such block.
    #[error("{0}")]
    NotFound(String),
    /// A message is under way, or IN is TRUE.
    #[error("{0}")]
    Busy(String),
    /// It would contradict what is there.
    #[error("{0}")]
    Conflict(String),
    /// Somebody else has changed the block.
    #[error("block {} has revision {} by now: look at it and decide again", .0.id, .0.revision)]
    Stale(Box<Block>),
    /// Somebody else has changed a device, a group or a variable.
    #[error("{what} has revision {revision} by now: look at it and decide again")]
    Outdated {
        /// Its id.
        what: String,
        /// The revision that it has.
        revision: u64,
    },
    /// A body over its limit.
    #[error("the body is longer than {0} bytes")]
    TooLarge(usize),
    /// The configuration has errors; nothing was stored.
    #[error("the configuration has errors; nothing was stored")]
    Findings(Vec<Finding>),
    /// Later.
    #[error("{why}")]
    TooMany {
        /// When it is worth to try again.
        retry_after: Duration,
        /// What there is too much of.
        why: String,
    },
    /// The relay is stopping.
    #[error("{0}")]
    Unavailable(String),
    /// Our fault. The log has more.
    #[error("the relay failed: {0}")]
    Internal(String),
}

impl ApiError {
    /// There is no such block.
    pub(crate) fn no_block(id: BlockId) -> Self {
        Self::NotFound(format!("there is no block {id}"))
    }

    const fn kind(&self) -> (StatusCode, ProblemCode, &'static str) {
        match self {
            Self::Unreadable(_) => (StatusCode::BAD_REQUEST, ProblemCode::Unreadable, "Unreadable"),
            Self::SignedOut(_) => (StatusCode::UNAUTHORIZED, ProblemCode::SignedOut, "Signed out"),
            Self::NotPermitted(_) => (StatusCode::FORBIDDEN, ProblemCode::NotPermitted, "Not permitted"),
            Self::NotFound(_) => (StatusCode::NOT_FOUND, ProblemCode::NotFound, "Not found"),
            Self::Busy(_) => (StatusCode::CONFLICT, ProblemCode::Busy, "Busy"),
            Self::Conflict(_) => (StatusCode::CONFLICT, ProblemCode::Conflict, "Conflict"),
            Self::Stale(_) | Self::Outdated { .. } => {
                (StatusCode::CONFLICT, ProblemCode::StaleRevision, "Changed by somebody else")
            }
            Self::TooLarge(_) => (StatusCode::PAYLOAD_TOO_LARGE, ProblemCode::TooLarge, "Too large"),
            Self::Findings(_) => {
                (StatusCode::UNPROCESSABLE_ENTITY, ProblemCode::Findings, "Errors in the configuration")
            }
            Self::TooMany { .. } => (StatusCode::TOO_MANY_REQUESTS, ProblemCode::TooMany, "Too many"),
            Self::Unavailable(_) => {
                (StatusCode::SERVICE_UNAVAILABLE, ProblemCode::Unavailable, "Not available")
            }
            Self::Internal(_) => (StatusCode::INTERNAL_SERVER_ERROR, ProblemCode::Internal, "Internal error"),
        }
    }
}

impl From<ApiError> for Problem {
    fn from(error: ApiError) -> Self {
        let (status, code, title) = error.kind();
        let (detail, title, status) = (error.to_string(), title.to_owned(), status.as_u16());
        let (findings, current) = match error {
            ApiError::Findings(findings) => (Some(findings), None),
            ApiError::Stale(block) => (None, Some(*block)),
            _ => (None, None),
        };
        Self { title, status, code, detail, findings, current }
    }
}

/// Why a request was not carried out, for the log. It goes with the response, and is not sent.
#[derive(Clone, Debug)]
pub(crate) struct Refusal {
    /// The problem's stable name.
    pub(crate) code: ProblemCode,
    /// In words, where they are ours.
    pub(crate) why: String,
}

impl ApiError {
    /// What the log says of it. Nothing that was sent is repeated: people mistype secrets, and addresses can be some.
    pub(crate) fn refusal(&self) -> Refusal {
        let why = match self {
            Self::Unreadable(_) => "it could not be read".to_owned(),
            Self::NotFound(_) => "nothing is there".to_owned(),
            error => error.to_string(),
        };
        Refusal { code: self.kind().1, why }
    }
}

impl IntoResponse for ApiError {
    fn into_response(self) -> Response {
        let status = self.kind().0;
        let refusal = self.refusal();
        let retry_after = match &self {
            Self::TooMany { retry_after, .. } => Some(HeaderValue::from(retry_after.as_secs() + 1)),
            _ => None,
        };
        // A problem has string keys only, which is all that could fail.
        let body = serde_json::to_string(&Problem::from(self)).unwrap_or_default();
        let content_type = HeaderValue::from_static("application/problem+json");
        let mut response = (status, [(header::CONTENT_TYPE, content_type)], body).into_response();
        if status == StatusCode::UNAUTHORIZED {
            // It has to be there, and makes no browser ask for a password.
            let how = HeaderValue::from_static("Bearer realm=\"cipdeck\"");
            response.headers_mut().insert(header::WWW_AUTHENTICATE, how);
        }
        response.extensions_mut().insert(refusal);
        if let Some(retry_after) = retry_after {
            response.headers_mut().insert(header::RETRY_AFTER, retry_after);
        }
        response
    }
}

impl From<Refused> for ApiError {
    fn from(refused: Refused) -> Self {
        match refused {
            Refused::UnknownBlock => Self::NotFound(refused.to_string()),
            Refused::Busy => Self::Busy(refused.to_string()),
            Refused::NotPermitted(_) => Self::NotPermitted(refused.to_string()),
            Refused::Unavailable => Self::Unavailable(refused.to_string()),
        }
    }
}

impl From<StoreError> for ApiError {
    fn from(error: StoreError) -> Self {
        match error {
            StoreError::Closed | StoreError::Files(FilesError::Write { .. }) => {
                Self::Unavailable(error.to_string())
            }
            // What somebody has to put right in the folder, or with what is sent.
            StoreError::Files(_) | StoreError::TooMany(_) => Self::Conflict(error.to_string()),
            error => Self::Internal(error.to_string()),
        }
    }
}

impl From<HistoryError> for ApiError {
    fn from(error: HistoryError) -> Self {
        match error {
            HistoryError::Closed => Self::Unavailable(error.to_string()),
            error @ HistoryError::Sqlite(_) => Self::Internal(error.to_string()),
        }
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
    /// Somebody at this machine acts without signing in, and others could reach it.
    #[error(
        "[local] lets everybody act without signing in: that is for loopback only. Listen on 127.0.0.1 instead of {0}, or \
         leave out [local] and make accounts"
    )]
    LocalForOthers(SocketAddr),
    /// Names of tunnels, together with local access: who comes through a tunnel comes from this machine.
    #[error(
        "[local] lets everybody on this machine act without signing in, and whoever comes through a tunnel or a proxy comes \
         from this machine: leave out allow_hosts, or leave out [local] and make accounts"
    )]
    LocalThroughTunnel,
    /// There is no certificate to serve with.
    #[error("{0}")]
    Tls(String),
    /// Not a loopback address.
    #[error(
        "{0} is not a loopback address: only `listen` in the settings takes the relay to where others can reach it"
    )]
    NotLoopback(SocketAddr),
    /// The database cannot be used.
    #[error("{0}")]
    Store(String),
    /// The project's folder says something that cannot be, or cannot be written.
    #[error("{0}")]
    Project(String),
    /// The audit cannot even be opened.
    #[error("{0}")]
    Audit(String),
    /// A line of the list of targets makes no sense.
    #[error("the lists cannot be used: {0}")]
    List(String),
    /// The server's task ended by itself.
    #[error("the server stopped unexpectedly")]
    Stopped,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_problem_is_documented_with_its_status() {
        let text = include_str!("../../docs/REST.md");
        let block = Block {
            id: BlockId(1),
            revision: 2,
            config: cipdeck_shared::config::MsgCipGeneric::product_name("0,0").into(),
        };
        for error in [
            ApiError::Unreadable(String::new()),
            ApiError::SignedOut(String::new()),
            ApiError::NotPermitted(String::new()),
            ApiError::NotFound(String::new()),
            ApiError::Busy(String::new()),
            ApiError::Conflict(String::new()),
            ApiError::Stale(Box::new(block)),
            ApiError::TooLarge(1),
            ApiError::Findings(Vec::new()),
            ApiError::TooMany { retry_after: Duration::ZERO, why: String::new() },
            ApiError::Unavailable(String::new()),
            ApiError::Internal(String::new()),
        ] {
            let problem = Problem::from(error);
            assert_eq!(problem.code.status(), problem.status, "{:?}", problem.code);
            let problem = serde_json::to_value(problem).unwrap();
            let row = format!("| `{}` | {} |", problem["code"].as_str().unwrap(), problem["status"]);
            assert!(text.contains(&row), "docs/REST.md lacks {row}");
        }
    }
}
