//! Which parts of a text are written in which dialect.

use alloc::borrow::Cow;
use alloc::vec;
use alloc::vec::Vec;

use super::dialect::Dialect;

/// How a piece is read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Form {
    /// A table of parameters.
    Parameters,
    /// Code.
    Code(Dialect),
}

/// Some lines of the text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Piece<'a> {
    /// How it is read.
    pub(super) form: Form,
    /// From 1.
    pub(super) first_line: usize,
    /// Whole lines. What belongs to another piece is blank.
    pub(super) text: Cow<'a, str>,
}

/// The pieces of a text.
pub(super) fn pieces(text: &str, dialect: Option<Dialect>) -> Vec<Piece<'_>> {
    let form = dialect.map_or(Form::Parameters, Form::Code);
    vec![Piece { form, first_line: 1, text: Cow::Borrowed(text) }]
}
