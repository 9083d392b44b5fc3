//! What an import has to say about a place in the text.

use alloc::string::{String, ToString};
use core::fmt;

use crate::plan::Severity;

/// Characters of an excerpt; more are cut off with an ellipsis.
const MAX_EXCERPT: usize = 80;

/// A place in the text, and what is to be said about it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Remark {
    /// From 1.
    pub line: usize,
    /// In characters, from 1.
    pub column: usize,
    /// Error: not understood, and therefore left out. Warning: understood, but probably not as meant. Note: good to
    /// know.
    pub severity: Severity,
    /// The text there.
    pub excerpt: String,
    /// What is to be said.
    pub what: RemarkKind,
}

/// What is to be said about a place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum RemarkKind {
    /// Nothing is known of this text.
    NotUnderstood,
    /// Something else should stand here.
    Expected(String),
    /// A comment or a string has no end.
    Unclosed(&'static str),
    /// A value that depends on the program.
    NotConstant(String),
    /// The number does not fit.
    OutOfRange {
        /// What it is.
        member: String,
        /// Smallest.
        low: i64,
        /// Largest.
        high: i64,
    },
    /// A member or parameter that this block does not have.
    UnknownMember(String),
    /// A member that has to be told and is not.
    Missing(String),
    /// The same thing is told twice; the last counts.
    Twice(String),
    /// Understood, and changes nothing about the message.
    NoEffect(String),
    /// What is sent, or where to, is not what the text says.
    Change(super::Change),
    /// The text names no device.
    NoDevice,
    /// Too deep, too long.
    TooDeep,
    /// Over [`super::MAX_TEXT`].
    TextTooLong {
        /// Bytes.
        limit: usize,
    },
    /// Over [`super::MAX_BLOCKS`].
    TooManyBlocks {
        /// Messages.
        limit: usize,
    },
    /// There is more to be said than anybody would read.
    TooManyRemarks {
        /// Remarks that are left out.
        more: usize,
    },
    /// Anything else, in words.
    Told(String),
}

impl Remark {
    /// Not understood.
    pub fn error(line: usize, column: usize, excerpt: &str, what: RemarkKind) -> Self {
        Self { line, column, severity: Severity::Error, excerpt: cut(excerpt), what }
    }

    /// Understood, but …
    pub fn warning(line: usize, column: usize, excerpt: &str, what: RemarkKind) -> Self {
        Self { severity: Severity::Warning, ..Self::error(line, column, excerpt, what) }
    }

    /// Good to know.
    pub fn note(line: usize, column: usize, excerpt: &str, what: RemarkKind) -> Self {
        Self { severity: Severity::Note, ..Self::error(line, column, excerpt, what) }
    }
}

/// One line of it, not too long.
fn cut(excerpt: &str) -> String {
    // Only its beginning is looked at: many remarks may be about one long line.
    let mut line = excerpt.trim_start().chars().take_while(|c| !matches!(c, '\n' | '\r'));
    let mut cut: String = line.by_ref().take(MAX_EXCERPT).collect();
    if line.next().is_some() {
        cut.push('…');
    } else {
        cut.truncate(cut.trim_end().len());
    }
    cut
}

/// For the remarks of a piece that does not begin at the first line.
pub(super) fn move_down(remarks: &mut [Remark], lines: usize) {
    for remark in remarks {
        remark.line += lines;
    }
}

/// `3:14: error: not understood: foo bar`
impl fmt::Display for Remark {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let severity = match self.severity {
            Severity::Error => "error",
            Severity::Warning => "warning",
            Severity::Note => "note",
        };
        write!(f, "{}:{}: {severity}: {}", self.line, self.column, self.what)?;
        if self.excerpt.is_empty() { Ok(()) } else { write!(f, ": {}", self.excerpt) }
    }
}

impl fmt::Display for RemarkKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotUnderstood => f.write_str("not understood, left out"),
            Self::Expected(what) => write!(f, "{what} is expected here"),
            Self::Unclosed(what) => write!(f, "{what} has no end"),
            Self::NotConstant(member) => write!(f, "{member} is not a constant: write its value"),
            Self::OutOfRange { member, low, high } => write!(f, "{member} is {low} to {high}"),
            Self::UnknownMember(member) => write!(f, "{member} is not known, left out"),
            Self::Missing(member) => write!(f, "{member} is missing"),
            Self::Twice(member) => write!(f, "{member} is told more than once; the last one counts"),
            Self::NoEffect(what) => write!(f, "{what} changes nothing about the message"),
            Self::Change(change) => change.fmt(f),
            Self::NoDevice => f.write_str(
                "the text names no device: the path is 0,0, the built-in simulated device; write where it goes",
            ),
            Self::TooDeep => f.write_str("nested too deep"),
            Self::TextTooLong { limit } => write!(f, "a text has at most {limit} bytes; nothing of it was read"),
            Self::TooManyBlocks { limit } => {
                write!(f, "a text has at most {limit} messages; those from here on were not read")
            }
            Self::TooManyRemarks { more } => write!(f, "and {more} more remarks, from here on"),
            Self::Told(words) => f.write_str(words),
        }
    }
}

impl RemarkKind {
    /// In words of the moment.
    pub fn told(words: &impl ToString) -> Self {
        Self::Told(words.to_string())
    }
}
