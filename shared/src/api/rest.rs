//! Bodies of REST requests and answers.

use alloc::string::{String, ToString};
use alloc::vec::Vec;

use serde::{Deserialize, Serialize};

use super::history::HistoryHealth;
use super::status::BlockStatus;
use crate::config::{Block, write_hex};
use crate::engine::Exchange;
use crate::plan::{self, Rule, Severity};

/// `GET /api/v1/health`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct Health {
    /// `ok`.
    pub status: String,
    /// The relay's version.
    pub version: String,
    /// How many blocks are stored; told to whoever may look.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub blocks: Option<usize>,
    /// Whether runs are being kept; told to whoever may look.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub history: Option<HistoryHealth>,
}

/// `GET /api/v1/ready`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct Ready {
    /// Everything works that messages need.
    pub ready: bool,
    /// What does not, and what that means; told to whoever may look.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub trouble: Vec<String>,
}

/// `POST /api/v1/blocks/{id}/in`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct InRequest {
    /// The new state of the input.
    #[serde(rename = "IN")]
    pub input: bool,
    /// For a block that may write: from `POST blocks/{id}/write`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ticket: Option<String>,
}

/// `POST /api/v1/blocks/{id}/run`; an empty body is allowed for a read.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct RunRequest {
    /// For a block that may write: from `POST blocks/{id}/write`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ticket: Option<String>,
}

/// `POST /api/v1/check` and `cipdeck check --json`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct Checked {
    /// All findings.
    pub findings: Vec<Finding>,
    /// Message router bytes as hexadecimal text; null with errors.
    pub request: Option<String>,
}

/// One finding in JSON.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct Finding {
    /// `AppCfg.MemberId[1]`
    pub field: String,
    /// error, warning or note.
    pub severity: Severity,
    /// The stable name of the rule.
    pub rule: String,
    /// English.
    pub message: String,
    /// Smallest allowed number.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub min: Option<i64>,
    /// Biggest allowed number.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub max: Option<i64>,
    /// What the controller would give.
    #[serde(rename = "ErrorID", default, skip_serializing_if = "Option::is_none")]
    pub error_id: Option<u16>,
    /// What the controller would give.
    #[serde(rename = "SubErrorID", default, skip_serializing_if = "Option::is_none")]
    pub sub_error_id: Option<u16>,
    /// What a SEND_REQ or DATA_EXCH would give.
    #[serde(rename = "Communication_Report", default, skip_serializing_if = "Option::is_none")]
    pub communication_report: Option<u8>,
}

impl From<&plan::Finding> for Finding {
    fn from(finding: &plan::Finding) -> Self {
        let (min, max) = match finding.rule {
            Rule::OutOfRange { min, max, .. } => (Some(min), Some(max)),
            _ => (None, None),
        };
        let ids = finding.error_ids();
        Self {
            field: finding.field.to_string(),
            severity: finding.severity,
            rule: finding.rule.name().to_string(),
            message: finding.rule.to_string(),
            min,
            max,
            error_id: ids.map(|(error_id, _)| error_id),
            sub_error_id: ids.and_then(|(_, sub_error_id)| sub_error_id),
            communication_report: finding.communication_report(),
        }
    }
}

/// Findings as JSON has them.
pub fn findings(findings: &[plan::Finding]) -> Vec<Finding> {
    findings.iter().map(Finding::from).collect()
}

/// One exchange of a block: what went out and what came back, as hexadecimal text.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct ExchangeView {
    /// When the message ended (RFC 3339).
    pub at: String,
    /// Message router request.
    pub request: String,
    /// Message router reply, if one came.
    pub response: Option<String>,
    /// Encapsulation frame that was written, if it was.
    pub request_frame: Option<String>,
    /// Encapsulation frame that was read, if one was.
    pub response_frame: Option<String>,
}

impl ExchangeView {
    /// What the engine kept of a message that ended `at`.
    pub fn new(at: String, exchange: &Exchange) -> Self {
        let hex = |bytes: &Option<Vec<u8>>| bytes.as_deref().map(write_hex);
        Self {
            at,
            request: write_hex(&exchange.request),
            response: exchange.response().map(write_hex),
            request_frame: hex(&exchange.request_frame),
            response_frame: hex(&exchange.response_frame),
        }
    }
}

/// `application/problem+json`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct Problem {
    /// The code in words.
    pub title: String,
    /// HTTP status.
    pub status: u16,
    /// Stable name.
    pub code: ProblemCode,
    /// What is wrong and what to do.
    pub detail: String,
    /// With `findings`: all of them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub findings: Option<Vec<Finding>>,
    /// With `stale_revision`: the block as it is now.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub current: Option<Block>,
}

/// Stable names of problems.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(from = "String", into = "String")]
#[non_exhaustive]
pub enum ProblemCode {
    /// 400
    Unreadable,
    /// 401: sign in first, or again.
    SignedOut,
    /// 403
    NotPermitted,
    /// 404
    NotFound,
    /// 409
    Busy,
    /// 409: it would contradict what is there.
    Conflict,
    /// 409
    StaleRevision,
    /// 413
    TooLarge,
    /// 422
    Findings,
    /// 429: later.
    TooMany,
    /// 500
    Internal,
    /// 503: the relay is stopping, or the block's run was ended by its deletion.
    Unavailable,
    /// A code that this version does not know.
    Other(String),
}

impl ProblemCode {
    /// All that this version knows.
    pub const ALL: [Self; 12] = [
        Self::Unreadable,
        Self::SignedOut,
        Self::NotPermitted,
        Self::NotFound,
        Self::Busy,
        Self::Conflict,
        Self::StaleRevision,
        Self::TooLarge,
        Self::Findings,
        Self::TooMany,
        Self::Internal,
        Self::Unavailable,
    ];

    /// The word in JSON.
    pub fn word(&self) -> &str {
        match self {
            Self::Unreadable => "unreadable",
            Self::SignedOut => "signed_out",
            Self::NotPermitted => "not_permitted",
            Self::NotFound => "not_found",
            Self::Busy => "busy",
            Self::Conflict => "conflict",
            Self::StaleRevision => "stale_revision",
            Self::TooLarge => "too_large",
            Self::Findings => "findings",
            Self::TooMany => "too_many",
            Self::Internal => "internal",
            Self::Unavailable => "unavailable",
            Self::Other(word) => word,
        }
    }
}

impl ProblemCode {
    /// The HTTP status that it comes with.
    pub const fn status(&self) -> u16 {
        match self {
            Self::Unreadable => 400,
            Self::SignedOut => 401,
            Self::NotPermitted => 403,
            Self::NotFound => 404,
            Self::Busy | Self::Conflict | Self::StaleRevision => 409,
            Self::TooLarge => 413,
            Self::Findings => 422,
            Self::TooMany => 429,
            Self::Unavailable => 503,
            Self::Internal | Self::Other(_) => 500,
        }
    }
}

impl From<String> for ProblemCode {
    fn from(word: String) -> Self {
        Self::ALL.into_iter().find(|code| code.word() == word).unwrap_or(Self::Other(word))
    }
}

impl From<ProblemCode> for String {
    fn from(code: ProblemCode) -> Self {
        code.word().into()
    }
}

#[cfg(feature = "openapi")]
impl utoipa::PartialSchema for ProblemCode {
    fn schema() -> utoipa::openapi::RefOr<utoipa::openapi::Schema> {
        utoipa::openapi::ObjectBuilder::new()
            .schema_type(utoipa::openapi::Type::String)
            .examples(Self::ALL.map(String::from))
            .description(Some("The stable name of a problem. New ones may appear."))
            .into()
    }
}

#[cfg(feature = "openapi")]
impl utoipa::ToSchema for ProblemCode {}

/// What a command over the WebSocket is answered with.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
#[serde(rename_all = "lowercase")]
pub enum Answer {
    /// It was carried out; the status at its end.
    Status(BlockStatus),
    /// It was not carried out.
    Problem(Problem),
}
