//! Not written and not read yet: both say so.

use super::dialect::{Dialect, Language};
use super::remark::not_readable;
use super::{Code, Imported, change};
use crate::config::BlockConfig;

/// A block as a section.
pub(super) fn export(block: &BlockConfig, _language: Language) -> Code {
    change::not_written(block)
}

/// Blocks from a section; `dialect` is what it was taken for, or what the user says it is.
pub(super) fn import(text: &str, dialect: Dialect) -> Imported {
    not_readable(dialect, text)
}
