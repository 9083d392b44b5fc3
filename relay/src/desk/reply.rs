//! What came of a message: a reply, or why there is none; and who a device says that it is.

use cipdeck_shared::engine::poll::Failure;
use cipdeck_shared::engine::{Cause, CauseKind};
use cipdeck_shared::wire::{
    Epath, GeneralStatus, IdentityAttributes, MessageRouterReply, MessageRouterRequest, ServiceCode, TooLong,
};

use crate::error::ApiError;
use crate::runner::{Ended, Refused};

/// Why a device did not answer.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Lost {
    /// What became of the message.
    pub(crate) why: Why,
    /// In words.
    pub(crate) reason: String,
}

/// What became of a message that brought no reply.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Why {
    /// It was not sent: the relay must not ask this device.
    Denied,
    /// No answer came, or none that could be used.
    Silent,
    /// The device answered that it takes no such message: an encapsulation status.
    NotTaken,
}

impl Lost {
    /// For whoever asks one question after the other.
    pub(crate) fn failure(&self) -> Failure {
        let reason = self.reason.clone();
        match self.why {
            Why::Denied | Why::Silent => Failure::Lost { reason },
            Why::NotTaken => Failure::NotTaken { reason },
        }
    }

    /// Without an answer, for a reason of our own.
    pub(crate) const fn silent(reason: String) -> Self {
        Self { why: Why::Silent, reason }
    }

    /// For somebody who has asked for an answer of the device.
    pub(crate) fn into_error(self) -> ApiError {
        match self.why {
            Why::Denied => ApiError::NotPermitted(self.reason),
            Why::Silent => ApiError::Conflict(format!("the device does not answer: {}", self.reason)),
            Why::NotTaken => ApiError::Conflict(format!("the device refuses: {}", self.reason)),
        }
    }
}

/// Get_Attributes_All of Identity, which every device has. CIP Vol 1, 5A-2.
pub(crate) fn identity_request() -> Result<MessageRouterRequest, TooLong> {
    MessageRouterRequest::new(ServiceCode::GetAttributesAll, Epath::object(0x01, 1), Vec::new())
}

/// The message router reply, or why there is none.
pub(crate) fn reply(ended: &Result<Ended, Refused>) -> Result<&[u8], Lost> {
    let ended = match ended {
        Ok(ended) => ended,
        Err(refused) => {
            let is_denied = matches!(refused, Refused::NotPermitted(_));
            let why = if is_denied { Why::Denied } else { Why::Silent };
            return Err(Lost { why, reason: refused.to_string() });
        }
    };
    let cause = ended.view.cause.as_ref();
    let is_answer = cause.is_none_or(|cause| cause.what == CauseKind::RefusedByDevice);
    match ended.exchange.response().filter(|_| is_answer) {
        Some(reply) => Ok(reply),
        None => Err(Lost {
            why: match cause.map(|cause| &cause.what) {
                Some(CauseKind::NotPermitted) => Why::Denied,
                Some(CauseKind::EncapsulationStatus) => Why::NotTaken,
                _ => Why::Silent,
            },
            reason: cause.map_or_else(|| "there was no answer".to_owned(), in_words),
        }),
    }
}

/// Who the device says that it is.
pub(crate) fn identity(reply: &[u8]) -> Result<IdentityAttributes, String> {
    let reply = MessageRouterReply::decode(reply).map_err(|error| error.to_string())?;
    if reply.status != GeneralStatus::Success {
        return Err(format!("it does not say what it is: {}", reply.status));
    }
    IdentityAttributes::decode(reply.data).map_err(|error| format!("it does not say what it is: {error}"))
}

fn in_words(cause: &Cause) -> String {
    let words = match &cause.what {
        CauseKind::Timeout => "no answer in time",
        CauseKind::Refused => "nobody listens at its TCP port",
        CauseKind::Unreachable => "it cannot be reached",
        CauseKind::Unresolved => "its name is unknown",
        CauseKind::SessionRefused => "it opens no session",
        CauseKind::EncapsulationStatus => "it does not take the message",
        CauseKind::Malformed => "its answer makes no sense",
        CauseKind::Closed => "it closed the connection",
        CauseKind::Limit => "too many sessions or connections",
        // In its own words.
        CauseKind::NotPermitted => "",
        other => other.word(),
    };
    match (&cause.detail, words) {
        (Some(detail), "") => detail.clone(),
        (Some(detail), words) => format!("{words}: {detail}"),
        (None, words) => words.to_owned(),
    }
}
