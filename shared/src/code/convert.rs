//! A block of one kind as a block of another.

use alloc::vec;
use alloc::vec::Vec;

use super::BlockConfig;
use super::change::{Change, Grade, Why};
use super::dialect::Kind;

/// A block of another kind.
#[derive(Clone, Debug, PartialEq)]
pub struct Converted {
    /// The block.
    pub config: BlockConfig,
    /// Everything that it does not say as the first one does.
    pub changes: Vec<Change>,
}

/// Makes a block of a kind out of one of any kind.
pub fn convert(block: &BlockConfig, to: Kind) -> Converted {
    let changes = if Kind::of(block) == to {
        Vec::new()
    } else {
        vec![Change::new(&"kind", &Kind::of(block), &"", Grade::Request, Why::NotWritten)]
    };
    Converted { config: block.clone(), changes }
}
