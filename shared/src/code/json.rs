//! Not written and not read yet: both say so.

use super::dialect::Dialect;
use super::remark::not_readable;
use super::{Code, Imported, change};
use crate::config::BlockConfig;

/// A block as text.
pub(super) fn export(block: &BlockConfig) -> Code {
    change::not_written(block)
}

/// Blocks from text.
pub(super) fn import(text: &str) -> Imported {
    not_readable(Dialect::Json, text)
}
