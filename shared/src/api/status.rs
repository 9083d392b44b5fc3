//! The status of a block in JSON.

use alloc::string::String;
use alloc::vec::Vec;

use serde::{Deserialize, Serialize};

use super::words::WordsStatus;
use super::write::Written;
use crate::config::{BlockId, write_hex};
use crate::dissect::Decoded;
use crate::engine::{BlockView, Cause, CipStatus, Phase, StatusBits};

/// Most edges in one message.
pub const MAX_EDGES: usize = 16;

/// Everything that a viewer sees of a running block.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct BlockStatus {
    /// Which block.
    pub block: BlockId,
    /// The input.
    #[serde(rename = "IN")]
    pub input: bool,
    /// The output: finished successfully.
    #[serde(rename = "Q")]
    pub q: bool,
    /// The manual's status.
    #[serde(rename = "Status")]
    pub status: CipStatus,
    /// Message router bytes, as hexadecimal text, of the message that this status is about. The block may have been
    /// changed since: what `ResData` means follows from this request alone.
    #[serde(default)]
    pub request: String,
    /// Bytes in `ResData`.
    #[serde(rename = "ResLength")]
    pub res_length: u16,
    /// Reply data as hexadecimal text.
    #[serde(rename = "ResData")]
    pub res_data: String,
    /// How far the message is.
    pub phase: Phase,
    /// Place in the queue: 1 is next; 0 is not queued.
    pub position: usize,
    /// What happened, on an error.
    pub cause: Option<Cause>,
    /// How many times the block has ended with DN or ER since the relay started.
    pub runs: u64,
    /// µs from the last written byte to the decoded reply.
    pub reply_us: Option<u64>,
    /// µs from trigger to DN or ER.
    pub elapsed_us: Option<u64>,
    /// When the status last changed (RFC 3339).
    pub at: Option<String>,
    /// \[µs since the trigger, StatusBits\], since the last message to this viewer.
    pub edges: Vec<(u64, StatusBits)>,
    /// Edges that did not fit.
    pub edges_dropped: u64,
    /// The last success.
    pub last: Option<LastSuccess>,
    /// Of a SEND_REQ or DATA_EXCH.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub words: Option<WordsStatus>,
    /// In the answer to a write that has been carried out: what was there, what is there now.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub written: Option<Written>,
}

/// The last success of a block, kept while a new run clears `ResData`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct LastSuccess {
    /// Message router bytes of the request that it answers, as hexadecimal text.
    #[serde(default)]
    pub request: String,
    /// Reply data as hexadecimal text.
    #[serde(rename = "ResData")]
    pub res_data: String,
    /// Its length.
    #[serde(rename = "ResLength")]
    pub res_length: u16,
    /// When (RFC 3339).
    pub at: String,
    /// What `ResData` means by the block's `ResLayout`; empty without one.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub decoded: Vec<Decoded>,
}

impl LastSuccess {
    /// What a status with Q TRUE leaves behind.
    pub fn of(status: &BlockStatus, at: String) -> Self {
        let (request, res_data) = (status.request.clone(), status.res_data.clone());
        Self { request, res_data, res_length: status.res_length, at, decoded: Vec::new() }
    }
}

impl BlockStatus {
    /// From the engine's view. `at` and `last` belong to the caller, who has a wall clock; so do `words`: most pages have no
    /// blocks with them.
    pub fn new(block: BlockId, view: &BlockView, at: Option<String>, last: Option<LastSuccess>) -> Self {
        Self {
            block,
            input: view.input,
            q: view.q,
            status: view.status,
            request: write_hex(&view.request),
            // ResData is at most 490 bytes.
            res_length: u16::try_from(view.res_data.len()).unwrap_or(u16::MAX),
            res_data: write_hex(&view.res_data),
            phase: view.phase,
            position: view.position,
            cause: view.cause.clone(),
            runs: view.runs,
            reply_us: view.reply_us,
            elapsed_us: view.elapsed_us,
            at,
            edges: view.edges.clone(),
            edges_dropped: view.edges_dropped,
            last,
            words: None,
            written: None,
        }
    }
}
