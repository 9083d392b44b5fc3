//! Ways in which a message fails, and the manual's numbers for each.

use alloc::string::{String, ToString};
use alloc::vec::Vec;

use crate::wire::{DecodeError, EncapsulationStatus, GeneralStatus};

use super::status::{Cause, CauseKind, Phase, RefusedBy};

/// Why a message failed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Failure {
    /// The device answered with a CIP error and all words of its additional status.
    RefusedByDevice(GeneralStatus, Vec<u16>),
    /// A router or the Connection Manager refused it before it reached its object.
    RefusedOnTheWay {
        /// Who.
        by: RefusedBy,
        /// Its general status.
        status: GeneralStatus,
        /// All words of its additional status.
        words: Vec<u16>,
        /// Words of the path that were left.
        remaining_path: Option<u8>,
    },
    /// No TCP connection: the reason and what the operating system said.
    NotConnected(ConnectError, String),
    /// RegisterSession was refused.
    SessionRefused(EncapsulationStatus),
    /// The target answered the message with an encapsulation status.
    EncapsulationStatus(EncapsulationStatus),
    /// The answer made no sense.
    Malformed(DecodeError),
    /// The target closed the TCP connection.
    Closed,
    /// No session is free.
    Limit,
    /// The reply is longer than `ResDataSize`: the device has acted.
    TooSmall {
        /// Bytes of the reply's data.
        length: usize,
    },
    /// The configuration has errors: the controller's SubErrorID, and what is wrong.
    Invalid(u16, String),
    /// Cancelled by the user.
    Cancelled,
    /// The owner did not permit the message: why.
    NotPermitted(String),
    /// Time ran out.
    Timeout,
}

/// Why there is no TCP connection.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ConnectError {
    /// Nobody listens at the port.
    Refused,
    /// The address cannot be reached.
    Unreachable,
    /// The name is unknown.
    Unresolved,
    /// The owner did not permit a connection there.
    NotPermitted,
}

/// "Unconnected request timed out": the target behind the router may have got it.
const NO_ANSWER_BEHIND_ROUTER: u16 = 0x0204;

impl Failure {
    /// Whether the target, or somebody on the way, has answered.
    pub(super) const fn is_answer(&self) -> bool {
        matches!(self, Self::RefusedByDevice(..) | Self::RefusedOnTheWay { by: RefusedBy::Router, .. })
    }

    /// `ErrorID`, `SubErrorID`, `ExtErrorID` in a phase. Codes: `data/micro800_error_ids.tsv`.
    pub(super) fn error_ids(&self, phase: Phase) -> (u16, u16, u16) {
        match self {
            Self::RefusedByDevice(status, words) | Self::RefusedOnTheWay { status, words, .. } => {
                (224, status.0.into(), words.first().copied().unwrap_or(0))
            }
            Self::Timeout => (55, timeout_in(phase), 0),
            Self::Closed => (55, if phase == Phase::Sent { 115 } else { 113 }, 0),
            Self::SessionRefused(_) => (55, 113, 0),
            Self::NotConnected(..) => (210, 0, 0),
            Self::EncapsulationStatus(_) | Self::Malformed(_) => (69, 65, 0),
            Self::Limit => (209, 0, 0),
            Self::TooSmall { .. } => (33, 48, 0),
            Self::Invalid(sub_error_id, _) => (33, *sub_error_id, 0),
            // The manual has no number for a refusal by us; for the block it is a cancelled message.
            Self::Cancelled | Self::NotPermitted(_) => (217, 0, 0),
        }
    }

    /// What is said beside the numbers.
    pub(super) fn cause(&self, phase: Phase) -> Cause {
        let written = phase == Phase::Sent;
        let cause = |what| Cause { may_have_acted: written, ..Cause::new(what) };
        match self {
            Self::RefusedByDevice(_, words) => {
                Cause { additional: words.clone(), ..Cause::new(CauseKind::RefusedByDevice) }
            }
            Self::RefusedOnTheWay { by, words, remaining_path, .. } => Cause {
                by: Some(*by),
                remaining_path: *remaining_path,
                additional: words.clone(),
                may_have_acted: *by == RefusedBy::Router && words.first() == Some(&NO_ANSWER_BEHIND_ROUTER),
                ..Cause::new(CauseKind::RefusedByDevice)
            },
            Self::NotConnected(error, detail) => {
                let what = match error {
                    ConnectError::Refused => CauseKind::Refused,
                    ConnectError::Unreachable => CauseKind::Unreachable,
                    ConnectError::Unresolved => CauseKind::Unresolved,
                    ConnectError::NotPermitted => CauseKind::NotPermitted,
                };
                Cause { detail: Some(detail.clone()), ..Cause::new(what) }
            }
            Self::SessionRefused(status) => {
                Cause { status: Some(status.0), ..Cause::new(CauseKind::SessionRefused) }
            }
            Self::EncapsulationStatus(status) => {
                Cause { status: Some(status.0), ..cause(CauseKind::EncapsulationStatus) }
            }
            Self::Malformed(error) => {
                Cause { byte: Some(error.at), detail: Some(error.to_string()), ..cause(CauseKind::Malformed) }
            }
            Self::Closed => cause(CauseKind::Closed),
            Self::Limit => Cause::new(CauseKind::Limit),
            Self::TooSmall { length } => Cause {
                has_acted: true,
                detail: Some(alloc::format!("the reply has {length} bytes")),
                ..Cause::new(CauseKind::TooSmall)
            },
            Self::Invalid(_, detail) => {
                Cause { detail: Some(detail.clone()), ..Cause::new(CauseKind::Invalid) }
            }
            Self::Cancelled => cause(CauseKind::Cancelled),
            Self::NotPermitted(why) => {
                let detail = (!why.is_empty()).then(|| why.clone());
                Cause { detail, ..Cause::new(CauseKind::NotPermitted) }
            }
            Self::Timeout => cause(CauseKind::Timeout),
        }
    }
}

/// `SubErrorID` of `ErrorID` 55: where the time ran out.
const fn timeout_in(phase: Phase) -> u16 {
    match phase {
        Phase::Waiting => 112,
        Phase::Connecting => 113,
        Phase::Sent => 115,
        _ => 114,
    }
}
