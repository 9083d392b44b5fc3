//! A stored block: its configuration, its id and its revision.

use serde::{Deserialize, Serialize};

use super::block_id::BlockId;
use super::msg_cip_generic::MsgCipGeneric;

/// A block as the relay stores and sends it.
///
/// It is read as a configuration whose unknown members have the id and the revision: one way to read configurations
/// instead of two saves 10 kB of the page.
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
    pub config: MsgCipGeneric,
}

impl TryFrom<MsgCipGeneric> for Block {
    type Error = &'static str;

    fn try_from(mut config: MsgCipGeneric) -> Result<Self, Self::Error> {
        let id = config.extra.remove("id").ok_or("missing field `id`")?;
        let revision = config.extra.remove("revision").ok_or("missing field `revision`")?;
        let id = id.as_str().and_then(|id| id.parse().ok());
        Ok(Self {
            id: id.ok_or("`id` is b and a number, such as b7")?,
            revision: revision.as_u64().ok_or("`revision` is a whole number from 0")?,
            config,
        })
    }
}
