//! A stored block: its configuration, its id and its revision.

use alloc::string::String;

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use super::block_config::BlockConfig;
use super::block_id::BlockId;

/// A block as the relay stores and sends it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
#[serde(try_from = "Map<String, Value>")]
pub struct Block {
    /// Given by the relay.
    pub id: BlockId,
    /// Counts up with every change; a change names the revision that it replaces.
    pub revision: u64,
    /// The pins.
    #[serde(flatten)]
    pub config: BlockConfig,
}

impl TryFrom<Map<String, Value>> for Block {
    type Error = String;

    fn try_from(mut members: Map<String, Value>) -> Result<Self, String> {
        let id = members.remove("id").ok_or("missing field `id`")?;
        let revision = members.remove("revision").ok_or("missing field `revision`")?;
        let id = id.as_str().and_then(|id| id.parse().ok());
        Ok(Self {
            id: id.ok_or("`id` is b and a number, such as b7")?,
            revision: revision.as_u64().ok_or("`revision` is a whole number from 0")?,
            config: BlockConfig::from_members(members)?,
        })
    }
}
