//! Writing: the window, the ticket, and what has become of it.

use alloc::string::String;

use serde::{Deserialize, Serialize};

use super::secret::hide;

/// What everybody sees about writing, first and whenever it changes.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct WriteState {
    /// The open write window.
    pub window: Option<WindowView>,
    /// Nothing is written, whoever asks: only local access to the relay's machine turns this off.
    pub read_only: bool,
    /// Why writes stop although a window is open, such as an audit that cannot be written.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stopped: Option<String>,
}

/// The time in which writes are possible.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct WindowView {
    /// Who opened it.
    pub owner: String,
    /// When (RFC 3339).
    pub opened_at: String,
    /// When it closes in any case.
    pub ends_at: String,
    /// ms until then, when this was said: clocks differ.
    pub left_ms: u64,
}

/// `POST /api/v1/window`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct NewWindow {
    /// 1 to 60; 15 when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(feature = "openapi", schema(minimum = 1, maximum = 60))]
    pub minutes: Option<u32>,
}

/// `POST /api/v1/blocks/{id}/write`: the first half of a write.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct WriteRequest {
    /// The revision that the person has seen.
    pub revision: u64,
}

/// The second half of a write needs this. Good for one command of the caller who asked for it.
#[derive(Clone, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct WriteTicket {
    /// To be given as `ticket` with `run` or `in`.
    pub ticket: String,
    /// ms that it is good for.
    pub good_for_ms: u64,
    /// The revision that it is about.
    pub revision: u64,
    /// Message router bytes that will be sent, as hexadecimal text.
    pub request: String,
    /// What is there now, if it could be read.
    pub old: Option<ReadValue>,
    /// Why there is no old value.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub no_old: Option<String>,
    /// What will be there.
    pub new: Option<ReadValue>,
}

/// A value of a device, as bytes and in words.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct ReadValue {
    /// The bytes, as hexadecimal text.
    pub data: String,
    /// What they mean: with type, and unit where it is known.
    pub text: String,
}

/// A write that has been carried out, in the answer to its command.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct Written {
    /// What was there before.
    pub old: Option<ReadValue>,
    /// What was written.
    pub new: Option<ReadValue>,
    /// What was read afterwards; none where it could not be read.
    pub read_back: Option<ReadValue>,
    /// Whether what was read is what was written.
    pub is_equal: Option<bool>,
}

/// `GET` and `PUT /api/v1/read-only`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct ReadOnly {
    /// Nothing is written.
    pub read_only: bool,
}

hide!(WriteTicket);
