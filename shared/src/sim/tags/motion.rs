//! Values that change by themselves, as functions of the time that is passed in.

use alloc::vec::Vec;
use core::fmt;
use core::str::FromStr;

use crate::engine::time::Instant;
use crate::sim::wave::wave;
use crate::tag::{Dialect, Elementary, Form, Type};

/// How a value changes. As text: the names in lower case. It begins at the value that the tag has at first; what is
/// written to it is gone at the next moment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Motion {
    /// A number goes up and down by a sixth of itself in 10 s; by 100 if it is 0.
    Sine,
    /// A number grows by 1 in 100 ms, and begins again at its end.
    Counter,
    /// A BOOL changes every second.
    Toggle,
    /// A STRING is another word every two seconds.
    Text,
}

/// The text is none of the names.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("a value moves as one of sine, counter, toggle, text")]
pub struct UnknownMotion;

const NAMES: [(Motion, &str); 4] = [
    (Motion::Sine, "sine"),
    (Motion::Counter, "counter"),
    (Motion::Toggle, "toggle"),
    (Motion::Text, "text"),
];

/// What a moving text says in turn.
const WORDS: [&[u8]; 4] = [b"heating", b"holding", b"cooling", b"waiting"];

const SINE_PERIOD_MS: u64 = 10_000;
/// Elements of an array follow each other.
const SINE_SHIFT_MS: u64 = 500;

impl FromStr for Motion {
    type Err = UnknownMotion;

    fn from_str(text: &str) -> Result<Self, UnknownMotion> {
        NAMES.iter().find(|row| row.1 == text).map(|row| row.0).ok_or(UnknownMotion)
    }
}

impl fmt::Display for Motion {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(NAMES.iter().find(|row| row.0 == *self).map_or("", |row| row.1))
    }
}

impl Motion {
    /// Whether a value of this type can change like this.
    pub(super) fn suits(self, kind: &Type) -> bool {
        match (self, kind) {
            (Self::Sine | Self::Counter, Type::Elementary(kind)) => {
                !matches!(kind.form(), Form::Bool | Form::Bcd) && *kind != Elementary::Enum
            }
            (Self::Toggle, Type::Elementary(Elementary::Bool)) | (Self::Text, Type::String(_)) => true,
            _ => false,
        }
    }

    /// The bytes of memory at this moment. `first` are those of the beginning, `index` is that of an element.
    pub(super) fn bytes(
        self,
        kind: &Type,
        dialect: Dialect,
        first: &[u8],
        index: usize,
        now: Instant,
    ) -> Option<Vec<u8>> {
        let millis = now.0 / 1_000;
        match (self, kind) {
            (Self::Text, _) => text(kind, dialect, millis),
            (Self::Toggle, _) => {
                let mut bytes = first.to_vec();
                let on = (millis / 1_000).is_multiple_of(2) == (*first.first()? != 0);
                *bytes.first_mut()? = on.into();
                Some(bytes)
            }
            (_, Type::Elementary(kind)) => {
                let shift = u64::try_from(index).ok()?.checked_mul(SINE_SHIFT_MS)?;
                let height = wave(Instant(now.0.wrapping_add(shift * 1_000)), SINE_PERIOD_MS);
                Some(self.number(*kind, first, height, millis / 100))
            }
            _ => None,
        }
    }

    /// `height` is -1000 to 1000.
    fn number(self, kind: Elementary, first: &[u8], height: i16, steps: u64) -> Vec<u8> {
        if kind.form() == Form::Float {
            // Below 2^24 each whole number is itself.
            let steps = u16::try_from(steps % 10_000).unwrap_or(0);
            if let Ok(bytes) = <[u8; 4]>::try_from(first) {
                return self.real(f32::from_le_bytes(bytes), height, steps).to_le_bytes().to_vec();
            }
            let bytes = <[u8; 8]>::try_from(first).unwrap_or_default();
            return self.lreal(f64::from_le_bytes(bytes), height, steps).to_le_bytes().to_vec();
        }
        let negative = kind.form() == Form::Signed && first.last().is_some_and(|byte| byte & 0x80 != 0);
        let mut wide = [if negative { 0xFF } else { 0 }; 8];
        for (to, from) in wide.iter_mut().zip(first) {
            *to = *from;
        }
        let value = i64::from_le_bytes(wide);
        let amplitude = if value == 0 { 100 } else { value / 6 };
        let moved = match self {
            Self::Counter => value.wrapping_add_unsigned(steps),
            // In this order it stays in range.
            _ => value
                .wrapping_add(amplitude / 1_000 * i64::from(height))
                .wrapping_add(amplitude % 1_000 * i64::from(height) / 1_000),
        };
        moved.to_le_bytes().iter().copied().take(first.len()).collect()
    }

    fn real(self, value: f32, height: i16, steps: u16) -> f32 {
        let amplitude = if value == 0.0 { 100.0 } else { value / 6.0 };
        let more = if self == Self::Counter { steps.into() } else { amplitude * f32::from(height) / 1_000.0 };
        value + more
    }

    fn lreal(self, value: f64, height: i16, steps: u16) -> f64 {
        let amplitude = if value == 0.0 { 100.0 } else { value / 6.0 };
        let more = if self == Self::Counter { steps.into() } else { amplitude * f64::from(height) / 1_000.0 };
        value + more
    }
}

/// A text as it lies in memory.
fn text(kind: &Type, dialect: Dialect, millis: u64) -> Option<Vec<u8>> {
    let turn = usize::try_from(millis / 2_000 % 4).ok()?;
    let word = WORDS.get(turn)?;
    let head = match dialect {
        Dialect::Logix => &[u8::try_from(word.len()).ok()?, 0, 0, 0][..],
        Dialect::Micro800 => &[u8::try_from(word.len()).ok()?],
        Dialect::Omron => &[],
    };
    let mut bytes = [head, word].concat();
    bytes.resize(kind.size(dialect), 0);
    Some(bytes)
}
