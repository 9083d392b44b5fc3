//! A stored block: its configuration, its id and its revision.

use alloc::string::{String, ToString};

use serde::{Deserialize, Serialize};

use super::block_config::BlockConfig;
use super::block_id::BlockId;
use super::msg_cip_generic::MsgCipGeneric;

/// A block as the relay stores and sends it.
///
/// It is read as a configuration whose unknown members have the id and the revision.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
#[serde(try_from = "MsgCipGeneric")]
pub struct Block {
    /// Given by the relay.
    pub id: BlockId,
    /// Counts up with every change; a change names the revision that it replaces.
    pub revision: u64,
    /// The pins.
    #[serde(flatten)]
    pub config: BlockConfig,
}

impl TryFrom<MsgCipGeneric> for Block {
    type Error = String;

    fn try_from(mut read: MsgCipGeneric) -> Result<Self, String> {
        let id = read.extra.remove("id").ok_or("missing field `id`")?;
        let revision = read.extra.remove("revision").ok_or("missing field `revision`")?;
        let id = id.as_str().and_then(|id| id.parse().ok());
        Ok(Self {
            id: id.ok_or_else(|| "`id` is b and a number, such as b7".to_string())?,
            revision: revision.as_u64().ok_or("`revision` is a whole number from 0")?,
            config: BlockConfig::of_kind(read)?,
        })
    }
}
