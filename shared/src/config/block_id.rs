//! `b1`, `b2` …: names of blocks, given by the relay and never used again.

use alloc::string::String;
use core::fmt;
use core::str::FromStr;

use serde::{Deserialize, Serialize};

/// The number behind `b7`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
#[cfg_attr(feature = "openapi", schema(value_type = String, pattern = "^b(0|[1-9][0-9]{0,9})$", examples("b7")))]
#[serde(into = "String", try_from = "String")]
pub struct BlockId(pub u32);

impl fmt::Display for BlockId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "b{}", self.0)
    }
}

impl From<BlockId> for String {
    fn from(id: BlockId) -> Self {
        alloc::format!("{id}")
    }
}

impl FromStr for BlockId {
    type Err = BadBlockId;

    fn from_str(text: &str) -> Result<Self, BadBlockId> {
        let number = text.strip_prefix('b').and_then(|digits| digits.parse().ok()).map(Self);
        // "b+7" and "b07" parse as numbers, but are not how we write b7.
        number.filter(|id| String::from(*id) == text).ok_or(BadBlockId)
    }
}

impl TryFrom<String> for BlockId {
    type Error = BadBlockId;

    fn try_from(text: String) -> Result<Self, BadBlockId> {
        text.parse()
    }
}

/// The text is not `b` and a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("a block id is b and a number, such as b7")]
pub struct BadBlockId;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_its_own_spelling_is_an_id() {
        assert_eq!("b7".parse(), Ok(BlockId(7)));
        for text in ["7", "b", "b-1", "b+7", "b07", "B7", "b7 ", "b4294967296"] {
            assert_eq!(text.parse::<BlockId>(), Err(BadBlockId), "{text}");
        }
    }
}
