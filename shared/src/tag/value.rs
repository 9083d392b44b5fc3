//! A value of a tag.

use alloc::borrow::ToOwned;
use alloc::string::{String, ToString};
use alloc::vec::Vec;
use core::fmt;

use super::kind::Type;
use super::name::Step;
use crate::config::write_hex;

/// A value of a tag, a member or an element. It prints as an engineer would write it.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// BOOL
    Bool(bool),
    /// SINT, INT, DINT, LINT and times
    Signed(i64),
    /// USINT, UINT, UDINT, ULINT, BYTE, WORD, DWORD, LWORD, BCD
    Unsigned(u64),
    /// REAL
    Real(f32),
    /// LREAL
    Lreal(f64),
    /// STRING: the bytes, of which nobody knows the encoding.
    Text(Vec<u8>),
    /// An array: all elements, the last index runs fastest.
    List(Vec<Self>),
    /// A structure.
    Members(Vec<(String, Self)>),
    /// Bytes of a type that is not known.
    Raw(Vec<u8>),
}

/// Why bytes or a text are no value of a type.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ValueError {
    /// Not as many bytes as the type has.
    #[error("{found} bytes do not fit: {what} has {needed}")]
    Length {
        /// The type.
        what: String,
        /// Bytes of the type.
        needed: usize,
        /// Bytes that are there.
        found: usize,
    },
    /// Another type than the one that is expected.
    #[error("{found} cannot be {what}")]
    Kind {
        /// The type.
        what: String,
        /// What was given.
        found: String,
    },
    /// A number outside of its type.
    #[error("{text} is outside of {what}: {min} to {max}")]
    Range {
        /// What was given.
        text: String,
        /// The type.
        what: &'static str,
        /// The smallest.
        min: String,
        /// The biggest.
        max: String,
    },
    /// A text that is no number.
    #[error("{text:?} is no {what}: {why}")]
    Unreadable {
        /// What was given.
        text: String,
        /// The type.
        what: &'static str,
        /// What to write instead.
        why: String,
    },
    /// A text that is too long.
    #[error("{length} bytes of text: at most {max} fit")]
    TextTooLong {
        /// Bytes that were given.
        length: usize,
        /// Bytes that fit.
        max: usize,
    },
    /// Not as many elements as the array has.
    #[error("{found} elements were given, the array has {needed}")]
    Count {
        /// Elements of the array.
        needed: usize,
        /// Elements that were given.
        found: usize,
    },
    /// A member is missing, unknown, or there twice.
    #[error("the member {0:?} {1}")]
    Member(String, &'static str),
    /// Scaling does not meet a number that the device can hold.
    #[error("{text} cannot be held exactly: the nearest are {below} and {above}")]
    Between {
        /// What was given.
        text: String,
        /// The next value below.
        below: String,
        /// The next value above.
        above: String,
    },
}

impl Value {
    /// The part that the steps lead to, of a value of this type.
    pub fn step(&self, kind: &Type, steps: &[Step]) -> Option<&Self> {
        let Some((step, rest)) = steps.split_first() else { return Some(self) };
        match (self, kind, step) {
            (Self::Members(members), Type::Structure(structure), Step::Member(name)) => {
                let (_, value) = members.iter().find(|(member, _)| member.eq_ignore_ascii_case(name))?;
                value.step(&structure.member(name)?.kind, rest)
            }
            (Self::List(elements), Type::Array(element, dimensions), Step::Index(indices)) => {
                elements.get(dimensions.position(indices)?)?.step(element, rest)
            }
            _ => None,
        }
    }

    /// A bit of a whole number.
    pub const fn bit(&self, bit: u8) -> Option<bool> {
        match self {
            Self::Signed(value) if bit < 64 => Some((*value >> bit) & 1 != 0),
            Self::Unsigned(value) if bit < 64 => Some((*value >> bit) & 1 != 0),
            _ => None,
        }
    }

    /// The number, for a scale or a chart. Over 2^53 it is rounded.
    #[expect(clippy::cast_precision_loss, reason = "the text has all digits")]
    pub fn number(&self) -> Option<f64> {
        match self {
            Self::Bool(value) => Some(if *value { 1.0 } else { 0.0 }),
            Self::Signed(value) => Some(*value as f64),
            Self::Unsigned(value) => Some(*value as f64),
            Self::Real(value) => Some(widened(*value)),
            Self::Lreal(value) => Some(*value),
            Self::Text(_) | Self::List(_) | Self::Members(_) | Self::Raw(_) => None,
        }
    }

    /// As JSON: numbers, texts, lists, objects. What JSON has no number for is a text (`"NaN"`); text that is not UTF-8
    /// and bytes of unknown types are hexadecimal.
    pub fn to_json(&self) -> serde_json::Value {
        use serde_json::Value as Json;
        let float = |number: f64| {
            let text = || Json::String(self.to_string());
            serde_json::Number::from_f64(number).map_or_else(text, Json::Number)
        };
        match self {
            Self::Bool(value) => Json::Bool(*value),
            Self::Signed(value) => Json::from(*value),
            Self::Unsigned(value) => Json::from(*value),
            Self::Real(value) => float(widened(*value)),
            Self::Lreal(value) => float(*value),
            Self::Text(bytes) => match core::str::from_utf8(bytes) {
                Ok(text) => Json::String(text.to_owned()),
                Err(_) => Json::String(write_hex(bytes)),
            },
            Self::List(elements) => Json::Array(elements.iter().map(Self::to_json).collect()),
            Self::Members(members) => {
                Json::Object(members.iter().map(|(name, value)| (name.clone(), value.to_json())).collect())
            }
            Self::Raw(bytes) => Json::String(write_hex(bytes)),
        }
    }
}

/// The number that the shortest text of a REAL means: 0.1 stays 0.1.
fn widened(value: f32) -> f64 {
    let mut buffer = zmij::Buffer::new();
    buffer.format(value).parse().unwrap_or_else(|_| value.into())
}

impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut buffer = zmij::Buffer::new();
        let whole = |text: &str| text.strip_suffix(".0").unwrap_or(text).to_owned();
        match self {
            Self::Bool(value) => f.write_str(if *value { "TRUE" } else { "FALSE" }),
            Self::Signed(value) => write!(f, "{value}"),
            Self::Unsigned(value) => write!(f, "{value}"),
            Self::Real(value) => f.write_str(&whole(buffer.format(*value))),
            Self::Lreal(value) => f.write_str(&whole(buffer.format(*value))),
            Self::Text(bytes) => quoted(bytes, f),
            Self::List(elements) => {
                for (place, element) in elements.iter().enumerate() {
                    write!(f, "{}{element}", if place == 0 { "[" } else { ", " })?;
                }
                f.write_str(if elements.is_empty() { "[]" } else { "]" })
            }
            Self::Members(members) => {
                for (place, (name, value)) in members.iter().enumerate() {
                    write!(f, "{}{name}: {value}", if place == 0 { "{" } else { ", " })?;
                }
                f.write_str(if members.is_empty() { "{}" } else { "}" })
            }
            Self::Raw(bytes) => f.write_str(&crate::config::space_hex(&write_hex(bytes))),
        }
    }
}

/// In quotation marks; what is not text is `\xNN`.
fn quoted(bytes: &[u8], f: &mut fmt::Formatter<'_>) -> fmt::Result {
    f.write_str("\"")?;
    for chunk in bytes.utf8_chunks() {
        for c in chunk.valid().chars() {
            match c {
                '"' | '\\' => write!(f, "\\{c}")?,
                c if c.is_control() => {
                    for byte in c.encode_utf8(&mut [0; 4]).bytes() {
                        write!(f, "\\x{byte:02X}")?;
                    }
                }
                c => write!(f, "{c}")?,
            }
        }
        for byte in chunk.invalid() {
            write!(f, "\\x{byte:02X}")?;
        }
    }
    f.write_str("\"")
}
