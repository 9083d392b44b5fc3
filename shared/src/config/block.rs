//! A stored block: its configuration, its id and its revision.

use serde::{Deserialize, Serialize};

use super::block_id::BlockId;
use super::msg_cip_generic::MsgCipGeneric;

/// A block as the relay stores and sends it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Block {
    /// Given by the relay.
    pub id: BlockId,
    /// Counts up with every change; a change names the revision that it replaces.
    pub revision: u64,
    /// The pins.
    #[serde(flatten)]
    pub config: MsgCipGeneric,
}

/// Whose limits apply to a block's messages.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Channel {
    /// As the controller: 4 buffers in all, 16 sessions.
    #[default]
    Controller,
    /// No limit of buffers or sessions.
    Monitor,
}
