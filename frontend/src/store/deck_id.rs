//! Which entry of the deck: a block that the relay has stored, or one that exists in this browser only.

use std::{fmt, str::FromStr};

use cipdeck_shared::config::BlockId;

/// `b7` is stored in the relay, `new-2` is not stored yet.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum DeckId {
    /// The relay knows it.
    Stored(BlockId),
    /// A draft of this browser.
    New(u32),
}

impl DeckId {
    /// The relay's id, if the relay knows the block.
    pub const fn stored(self) -> Option<BlockId> {
        match self {
            Self::Stored(id) => Some(id),
            Self::New(_) => None,
        }
    }
}

impl fmt::Display for DeckId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Stored(id) => id.fmt(f),
            Self::New(number) => write!(f, "new-{number}"),
        }
    }
}

impl FromStr for DeckId {
    type Err = NotAnId;

    fn from_str(text: &str) -> Result<Self, NotAnId> {
        match text.strip_prefix("new-") {
            Some(number) => number.parse().map(Self::New).map_err(|_| NotAnId),
            None => text.parse().map(Self::Stored).map_err(|_| NotAnId),
        }
    }
}

/// The text names no entry.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NotAnId;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_id_reads_back_what_it_writes() {
        for id in [DeckId::Stored(BlockId(7)), DeckId::New(2)] {
            assert_eq!(id.to_string().parse(), Ok(id));
        }
        for text in ["", "7", "new-", "new-x", "drive"] {
            assert_eq!(text.parse::<DeckId>(), Err(NotAnId), "{text}");
        }
    }
}
