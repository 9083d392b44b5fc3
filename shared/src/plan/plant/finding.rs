//! What can be wrong with devices, groups and variables, and how it is said.

use alloc::string::String;
use core::fmt;

use crate::config::PathError;
use crate::plan::Rule;

/// Something that keeps an entry from being stored.
#[derive(Clone, Debug, PartialEq)]
pub struct PlantFinding {
    /// `period_ms`, `variables[3].address`, `line 4.address`.
    pub field: String,
    /// What is wrong there.
    pub rule: PlantRule,
}

/// What is wrong. The page translates [`PlantRule::key`]; `Display` is the English text.
#[derive(Clone, Debug, PartialEq)]
pub enum PlantRule {
    /// A text that must not be empty.
    Missing,
    /// A text that is too long, in characters.
    TextTooLong {
        /// How long it may be.
        max: usize,
    },
    /// A number outside its range.
    OutOfRange {
        /// What was given.
        value: i64,
        /// The smallest that is allowed.
        min: i64,
        /// The biggest that is allowed.
        max: i64,
    },
    /// The path cannot be used.
    Path(PathError),
    /// The address is no name of a tag; in English, why.
    Address(String),
    /// The type cannot be read; in English, why.
    Type(String),
    /// The parent has no such member or element.
    NotInParent,
    /// No such variable in the group.
    NoParent,
    /// A variable inside of itself, or too deep.
    ParentLoop,
    /// A factor of 0, or no number at all.
    Factor,
    /// The smallest is over the biggest.
    MinOverMax,
    /// A cell that is no number.
    NotANumber(String),
    /// A cell that is neither yes nor no.
    NotYesOrNo(String),
    /// A cell with a word that is none of these.
    NotAWord {
        /// What was given.
        found: String,
        /// What may stand there.
        words: &'static str,
    },
    /// A column that nobody knows.
    UnknownColumn(String),
    /// A line with more cells than there are columns, or a quotation mark that does not end.
    BadLine,
    /// More than can be added at once, or than there may be.
    TooMany {
        /// How many there may be.
        max: usize,
    },
}

impl PlantRule {
    /// Every key that [`Self::key`] can return.
    pub const KEYS: [&'static str; 17] = [
        "missing",
        "text_too_long",
        "out_of_range",
        "path",
        "address",
        "type",
        "not_in_parent",
        "no_parent",
        "parent_loop",
        "factor",
        "min_over_max",
        "not_a_number",
        "not_yes_or_no",
        "not_a_word",
        "unknown_column",
        "bad_line",
        "too_many_entries",
    ];

    /// The rule's stable name in JSON.
    pub const fn key(&self) -> &'static str {
        match self {
            Self::Missing => "missing",
            Self::TextTooLong { .. } => "text_too_long",
            Self::OutOfRange { .. } => "out_of_range",
            Self::Path(_) => "path",
            Self::Address(_) => "address",
            Self::Type(_) => "type",
            Self::NotInParent => "not_in_parent",
            Self::NoParent => "no_parent",
            Self::ParentLoop => "parent_loop",
            Self::Factor => "factor",
            Self::MinOverMax => "min_over_max",
            Self::NotANumber(_) => "not_a_number",
            Self::NotYesOrNo(_) => "not_yes_or_no",
            Self::NotAWord { .. } => "not_a_word",
            Self::UnknownColumn(_) => "unknown_column",
            Self::BadLine => "bad_line",
            Self::TooMany { .. } => "too_many_entries",
        }
    }
}

impl fmt::Display for PlantRule {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Missing => f.write_str("must not be empty"),
            Self::TextTooLong { max } => write!(f, "at most {max} characters"),
            Self::OutOfRange { value, min, max } => write!(f, "{value} is outside {min} to {max}"),
            Self::Path(error) => Rule::Path(*error).fmt(f),
            Self::Address(why) | Self::Type(why) => f.write_str(why),
            Self::NotInParent => f.write_str("the parent has no such member or element"),
            Self::NoParent => f.write_str("the group has no such variable, or it is wrong itself"),
            Self::ParentLoop => {
                f.write_str("a variable cannot be a part of itself, or of more than 16 others")
            }
            Self::Factor => f.write_str("the factor is a number other than 0, the offset a number"),
            Self::MinOverMax => f.write_str("the smallest number is over the biggest"),
            Self::NotANumber(found) => write!(f, "{found:?} is no number"),
            Self::NotYesOrNo(found) => write!(f, "{found:?} is neither yes nor no"),
            Self::NotAWord { found, words } => write!(f, "{found:?} is none of {words}"),
            Self::UnknownColumn(name) => write!(f, "there is no column {name:?}"),
            Self::BadLine => f.write_str("more cells than columns, or a quotation mark that does not end"),
            Self::TooMany { max } => write!(f, "at most {max}"),
        }
    }
}
