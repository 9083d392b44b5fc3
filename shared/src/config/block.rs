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
