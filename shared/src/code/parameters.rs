//! Pasted tables of parameters. Not read yet: it says so.

use super::Imported;
use super::dialect::Dialect;
use super::remark::not_readable;

/// Blocks from a table.
pub(super) fn import(text: &str) -> Imported {
    not_readable(Dialect::CcwSt, text)
}

/// Whether a line is a row of such a table.
pub(super) fn is_row(_line: &str) -> bool {
    false
}
