//! Messages of the WebSocket at `/api/v1/ws`: JSON text.

use alloc::boxed::Box;
use alloc::string::String;
use alloc::vec::Vec;

use serde::{Deserialize, Serialize};

use super::rest::Answer;
use super::status::BlockStatus;
use super::target::TargetStatus;
use super::write::WriteState;
use crate::config::{Block, BlockId};

/// The `protocol` in `hello`.
pub const PROTOCOL_VERSION: u32 = 2;

/// What the relay says.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
#[serde(tag = "type", rename_all = "lowercase")]
pub enum ServerMessage {
    /// First.
    Hello {
        /// [`PROTOCOL_VERSION`].
        protocol: u32,
        /// The relay's version.
        relay: String,
    },
    /// Everything, at the start and whenever changes were dropped.
    Snapshot {
        /// Counts up by one with every snapshot and changes.
        seq: u64,
        /// All blocks.
        blocks: Vec<Block>,
        /// The status of each.
        statuses: Vec<BlockStatus>,
        /// All targets that blocks have been triggered for.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        targets: Vec<TargetStatus>,
    },
    /// What has changed: the newest per block.
    Changes {
        /// Counts up by one with every snapshot and changes.
        seq: u64,
        /// New statuses.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        statuses: Vec<BlockStatus>,
        /// New and changed blocks.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        blocks: Vec<Block>,
        /// Deleted blocks.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        removed: Vec<BlockId>,
        /// Targets that look different.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        targets: Vec<TargetStatus>,
        /// Targets that no block needs any more.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        targets_removed: Vec<String>,
    },
    /// Whether something may be written at all: first, and whenever it changes.
    Access(WriteState),
    /// The answer to a command.
    Answer {
        /// The command's own id.
        id: String,
        /// How it ended.
        #[serde(flatten)]
        answer: Box<Answer>,
    },
}

/// What a viewer says.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
#[serde(tag = "type", rename_all = "lowercase", deny_unknown_fields)]
pub enum ClientMessage {
    /// One shot, whatever `TriggerType`.
    Run {
        /// Comes back in the answer.
        id: String,
        /// Which block.
        block: BlockId,
        /// For a block that may write: from `POST blocks/{id}/write`.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        ticket: Option<String>,
    },
    /// Cancel what is running.
    Cancel {
        /// Comes back in the answer.
        id: String,
        /// Which block.
        block: BlockId,
    },
    /// Set the input.
    In {
        /// Comes back in the answer.
        id: String,
        /// Which block.
        block: BlockId,
        /// The new state.
        #[serde(rename = "IN")]
        input: bool,
        /// For a block that may write: from `POST blocks/{id}/write`.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        ticket: Option<String>,
    },
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn client_messages_are_as_documented() {
        for text in [
            r#"{"type":"run","id":"c1","block":"b7"}"#,
            r#"{"type":"run","id":"c1","block":"b7","ticket":"9f2c"}"#,
            r#"{"type":"cancel","id":"c1","block":"b7"}"#,
            r#"{"type":"in","id":"c2","block":"b7","IN":true}"#,
        ] {
            let message: ClientMessage = serde_json::from_str(text).unwrap();
            assert_eq!(serde_json::to_string(&message).unwrap(), text);
        }
        assert!(
            serde_json::from_str::<ClientMessage>(r#"{"type":"run","id":"c1","block":"b7","force":1}"#)
                .is_err()
        );
    }
}
