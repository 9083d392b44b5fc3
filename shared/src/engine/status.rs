//! What a block shows: StatusBits, CIPSTATUS, the phase, and the cause behind the manual's numbers.

use alloc::string::String;
use alloc::vec::Vec;

use serde::{Deserialize, Serialize};

/// `Status.StatusBits`. 2080-RM001D p. 179; bits 5 and 6 from document 13032001.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
#[serde(transparent)]
pub struct StatusBits(pub u16);

impl StatusBits {
    /// Enabled: IN is TRUE, or the message has not ended yet.
    pub const EN: u16 = 1;
    /// Enabled and waiting to send: a communication buffer has been allocated.
    pub const EW: u16 = 1 << 1;
    /// Started: the message has been written, the reply is awaited.
    pub const ST: u16 = 1 << 2;
    /// Error.
    pub const ER: u16 = 1 << 3;
    /// Done.
    pub const DN: u16 = 1 << 4;
    /// Completing this message closed the CIP connection.
    pub const CIPCONN: u16 = 1 << 5;
    /// Completing this message closed the EtherNet/IP session.
    pub const EIPSESS: u16 = 1 << 6;

    /// Bits and their names, in the manual's order.
    pub const NAMES: [(u16, &'static str); 7] = [
        (Self::EN, "EN"),
        (Self::EW, "EW"),
        (Self::ST, "ST"),
        (Self::ER, "ER"),
        (Self::DN, "DN"),
        (Self::CIPCONN, "CIPCONN"),
        (Self::EIPSESS, "EIPSESS"),
    ];

    /// Whether a bit is set.
    pub const fn has(self, bit: u16) -> bool {
        self.0 & bit != 0
    }
}

/// CIPSTATUS. 2080-RM001D p. 191.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct CipStatus {
    /// TRUE when the block has met an error.
    #[serde(rename = "Error")]
    pub error: bool,
    /// Error code; `table::block_error` explains it.
    #[serde(rename = "ErrorID")]
    pub error_id: u16,
    /// For `ErrorID` 224 the CIP general status.
    #[serde(rename = "SubErrorID")]
    pub sub_error_id: u16,
    /// For `ErrorID` 224 the first word of the additional status.
    #[serde(rename = "ExtErrorID")]
    pub ext_error_id: u16,
    /// EN, EW, ST, ER, DN …
    #[serde(rename = "StatusBits")]
    pub status_bits: StatusBits,
}

/// How far a message is, finer than the bits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
#[serde(rename_all = "lowercase")]
pub enum Phase {
    /// Never triggered, or reset.
    #[default]
    Idle,
    /// In the wait queue: no buffer is free (EN).
    Waiting,
    /// Holds a buffer and waits for its target (EN, EW).
    Buffered,
    /// Holds a buffer while the TCP connection and the session are made (EN, EW).
    Connecting,
    /// Written; the reply is awaited (EN, ST).
    Sent,
    /// Success (DN).
    Done,
    /// Error (ER).
    Failed,
}

impl Phase {
    /// Between trigger and end.
    pub const fn is_busy(self) -> bool {
        matches!(self, Self::Waiting | Self::Buffered | Self::Connecting | Self::Sent)
    }
}

/// What happened, beside the manual's numbers.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct Cause {
    /// What happened.
    pub what: CauseKind,
    /// The request had been written when it ended without an answer: the device may have carried it out.
    #[serde(default, skip_serializing_if = "core::ops::Not::not")]
    pub may_have_acted: bool,
    /// The device has answered with success, so it has acted, although the block failed.
    #[serde(default, skip_serializing_if = "core::ops::Not::not")]
    pub has_acted: bool,
    /// The encapsulation status, for `session_refused` and `encapsulation_status`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub status: Option<u32>,
    /// The byte at which a reply stopped to make sense, for `malformed`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub byte: Option<usize>,
    /// Who refused, for `refused_by_device` where it was not the object that was asked.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub by: Option<RefusedBy>,
    /// Words of the route or path that were left where it was refused, if the router says so.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub remaining_path: Option<u8>,
    /// All words of the additional status, for `refused_by_device`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub additional: Vec<u16>,
    /// More, in English: what the operating system or the decoder said.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub detail: Option<String>,
}

impl Cause {
    /// A cause without particulars.
    pub const fn new(what: CauseKind) -> Self {
        Self {
            what,
            may_have_acted: false,
            has_acted: false,
            status: None,
            byte: None,
            by: None,
            remaining_path: None,
            additional: Vec::new(),
            detail: None,
        }
    }

    /// A timeout during which frames came in that did not answer the request.
    pub(super) fn after_dropping(self, frames: u64) -> Self {
        let told = || {
            alloc::format!(
                "{frames} replies came that were not for this request (another sender context, connection or sequence count)"
            )
        };
        Self { detail: (frames > 0).then(told), ..self }
    }
}

/// Who refused a message before it reached its object.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
#[serde(rename_all = "snake_case")]
pub enum RefusedBy {
    /// A router on the way: its Connection Manager answers Unconnected_Send itself.
    Router,
    /// The Connection Manager that was to open the connection.
    ForwardOpen,
}

/// What happened. New kinds may appear: a reader keeps the word of one it does not know.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(from = "String", into = "String")]
#[non_exhaustive]
pub enum CauseKind {
    /// The device answered with a CIP error.
    RefusedByDevice,
    /// Time ran out.
    Timeout,
    /// Nobody listens at the TCP port.
    Refused,
    /// The address cannot be reached.
    Unreachable,
    /// The name is unknown.
    Unresolved,
    /// RegisterSession was refused.
    SessionRefused,
    /// The target answered with an encapsulation status.
    EncapsulationStatus,
    /// The answer made no sense.
    Malformed,
    /// The target closed the TCP connection.
    Closed,
    /// Too many sessions or connections.
    Limit,
    /// The reply is longer than `ResDataSize`.
    TooSmall,
    /// The configuration has errors.
    Invalid,
    /// Cancelled by the user.
    Cancelled,
    /// The relay did not permit the write.
    NotPermitted,
    /// A kind that this version does not know.
    Other(String),
}

impl CauseKind {
    /// All that this version knows.
    pub const ALL: [Self; 14] = [
        Self::RefusedByDevice,
        Self::Timeout,
        Self::Refused,
        Self::Unreachable,
        Self::Unresolved,
        Self::SessionRefused,
        Self::EncapsulationStatus,
        Self::Malformed,
        Self::Closed,
        Self::Limit,
        Self::TooSmall,
        Self::Invalid,
        Self::Cancelled,
        Self::NotPermitted,
    ];

    /// The word in JSON.
    pub fn word(&self) -> &str {
        match self {
            Self::RefusedByDevice => "refused_by_device",
            Self::Timeout => "timeout",
            Self::Refused => "refused",
            Self::Unreachable => "unreachable",
            Self::Unresolved => "unresolved",
            Self::SessionRefused => "session_refused",
            Self::EncapsulationStatus => "encapsulation_status",
            Self::Malformed => "malformed",
            Self::Closed => "closed",
            Self::Limit => "limit",
            Self::TooSmall => "too_small",
            Self::Invalid => "invalid",
            Self::Cancelled => "cancelled",
            Self::NotPermitted => "not_permitted",
            Self::Other(word) => word,
        }
    }
}

impl From<String> for CauseKind {
    fn from(word: String) -> Self {
        Self::ALL.into_iter().find(|kind| kind.word() == word).unwrap_or(Self::Other(word))
    }
}

impl From<CauseKind> for String {
    fn from(kind: CauseKind) -> Self {
        kind.word().into()
    }
}

#[cfg(feature = "openapi")]
impl utoipa::PartialSchema for CauseKind {
    fn schema() -> utoipa::openapi::RefOr<utoipa::openapi::Schema> {
        utoipa::openapi::ObjectBuilder::new()
            .schema_type(utoipa::openapi::Type::String)
            .examples(Self::ALL.map(String::from))
            .description(Some("What happened. New words may appear."))
            .into()
    }
}

#[cfg(feature = "openapi")]
impl utoipa::ToSchema for CauseKind {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cause_reads_back_from_its_word_and_an_unknown_one_keeps_it() {
        let other = CauseKind::Other("sunspots".into());
        for kind in CauseKind::ALL.into_iter().chain([other]) {
            let json = serde_json::to_string(&kind).unwrap();
            assert_eq!(json, alloc::format!("\"{}\"", kind.word()));
            assert_eq!(serde_json::from_str::<CauseKind>(&json).unwrap(), kind);
        }
    }
}
