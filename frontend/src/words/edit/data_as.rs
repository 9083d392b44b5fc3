//! Data as bytes or as numbers of one type: `0A 00`, or `10` as UINT.

use std::fmt::Write;

use cipdeck_shared::config::{HexErrorKind, read_hex, read_number, space_hex, write_hex};

/// How data is shown and typed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum DataAs {
    /// Hexadecimal bytes.
    #[default]
    Bytes,
    /// 0..=255
    Usint,
    /// -32768..=32767
    Int,
    /// 0..=65535
    Uint,
    /// 32 bits with a sign.
    Dint,
    /// 32 bits without one.
    Udint,
    /// 32 bits, IEEE 754.
    Real,
}

impl DataAs {
    /// All of them.
    pub const ALL: [Self; 7] =
        [Self::Bytes, Self::Usint, Self::Int, Self::Uint, Self::Dint, Self::Udint, Self::Real];

    /// The type's name; empty for bytes.
    pub const fn word(self) -> &'static str {
        match self {
            Self::Bytes => "",
            Self::Usint => "USINT",
            Self::Int => "INT",
            Self::Uint => "UINT",
            Self::Dint => "DINT",
            Self::Udint => "UDINT",
            Self::Real => "REAL",
        }
    }

    /// The one with this name.
    pub fn of_word(word: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|it| it.word() == word)
    }

    /// How data of a layout is shown at first: `start: UINT; quantity: UINT` as UINT.
    pub fn of_layout(layout: &str) -> Self {
        let type_of = |field: &str| {
            let word = field.rsplit(':').next().unwrap_or_default();
            Self::of_word(word.split('[').next().unwrap_or_default().trim()).unwrap_or_default()
        };
        let types: Vec<_> = layout.split(';').map(type_of).collect();
        let are_words = types.iter().all(|it| matches!(it, Self::Uint | Self::Int));
        match types.first() {
            Some(first) if types.iter().all(|it| it == first) => *first,
            _ if are_words => Self::Uint,
            _ => Self::Bytes,
        }
    }

    const fn size(self) -> usize {
        match self {
            Self::Bytes | Self::Usint => 1,
            Self::Int | Self::Uint => 2,
            Self::Dint | Self::Udint | Self::Real => 4,
        }
    }

    const fn limits(self) -> (i64, i64) {
        match self {
            Self::Bytes | Self::Usint => (0, 0xFF),
            Self::Int => (-0x8000, 0x7FFF),
            Self::Uint => (0, 0xFFFF),
            Self::Dint => (-0x8000_0000, 0x7FFF_FFFF),
            Self::Udint | Self::Real => (0, 0xFFFF_FFFF),
        }
    }

    /// The text of some data; `None` where it does not divide into whole numbers, or a REAL would not come back as the
    /// same bytes.
    pub fn write(self, data: &[u8]) -> Option<String> {
        if self == Self::Bytes {
            return Some(space_hex(&write_hex(data)).to_ascii_uppercase());
        }
        if !data.len().is_multiple_of(self.size()) {
            return None;
        }
        let mut text = String::new();
        for bytes in data.chunks(self.size()) {
            let raw = bytes.iter().rev().fold(0_u32, |value, byte| value << 8 | u32::from(*byte));
            let space = if text.is_empty() { "" } else { " " };
            // Writing to a String cannot fail.
            let _ = match self {
                Self::Real => {
                    let value = f32::from_bits(raw);
                    if !value.is_finite() {
                        return None;
                    }
                    write!(text, "{space}{value}")
                }
                Self::Int => write!(text, "{space}{}", u16::try_from(raw).ok()?.cast_signed()),
                Self::Dint => write!(text, "{space}{}", raw.cast_signed()),
                _ => write!(text, "{space}{raw}"),
            };
        }
        Some(text)
    }

    /// The bytes of a text, or the piece of it that is none of these.
    pub fn read(self, text: &str) -> Result<Vec<u8>, String> {
        if self == Self::Bytes {
            return read_bytes(text);
        }
        let mut data = Vec::new();
        for piece in self.pieces(text) {
            let raw = self.read_one(piece).ok_or_else(|| self.why_not(piece))?;
            data.extend(raw.to_le_bytes().into_iter().take(self.size()));
        }
        Ok(data)
    }

    /// How many numbers some data is; for bytes, how many bytes.
    pub const fn count(self, data: &[u8]) -> usize {
        data.len() / self.size()
    }

    /// The numbers of a text. A comma in a REAL may be meant as its decimal point: it separates only beside a space.
    fn pieces(self, text: &str) -> impl Iterator<Item = &str> {
        let separators: &[char] = if self == Self::Real {
            &[' ', ';', '\t', '\r', '\n']
        } else {
            &[' ', ',', ';', '\t', '\r', '\n']
        };
        let pieces =
            text.split(separators).map(move |it| if self == Self::Real { it.trim_matches(',') } else { it });
        pieces.filter(|piece| !piece.is_empty())
    }

    fn why_not(self, piece: &str) -> String {
        let (low, high) = self.limits();
        match self {
            Self::Real if piece.contains(',') => {
                format!("“{piece}”: decimals have a point, 12.5; write a space between two numbers")
            }
            Self::Real => format!("“{piece}” is no REAL; write 12.5 or 1e3"),
            _ => format!("“{piece}” is no {}: {low} to {high}, or 16#0A", self.word()),
        }
    }

    fn read_one(self, piece: &str) -> Option<u32> {
        if self == Self::Real {
            let value: f32 = piece.parse().ok()?;
            // A number so small that nothing is left of it is none that somebody means.
            let is_lost = value == 0.0 && !is_zero(piece);
            return (value.is_finite() && !is_lost).then(|| value.to_bits());
        }
        let (low, high) = self.limits();
        let value = read_number(piece).ok().filter(|value| (low..=high).contains(value))?;
        // In range: the low 32 bits are the number's two's complement.
        u32::try_from(value & 0xFFFF_FFFF).ok()
    }
}

/// `0e5` is 0, `1e-60` is not.
fn is_zero(number: &str) -> bool {
    let digits = number.split(['e', 'E']).next().unwrap_or_default();
    !digits.contains(|c| matches!(c, '1'..='9'))
}

/// Bytes of hexadecimal text, or why it is none.
pub(super) fn read_bytes(text: &str) -> Result<Vec<u8>, String> {
    read_hex(text).map_err(|error| {
        let at = error.position + 1;
        match error.kind {
            HexErrorKind::NotHex(c) => format!("“{c}” at character {at} is no hexadecimal digit"),
            HexErrorKind::OddDigits => format!("half a byte at character {at}: write two digits for each"),
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn data_is_read_as_it_is_written() {
        let data = [0x00, 0x00, 0x0A, 0x00, 0xFF, 0xFF, 0x48, 0xC1];
        for (data_as, text) in [
            (DataAs::Bytes, "00 00 0A 00 FF FF 48 C1"),
            (DataAs::Usint, "0 0 10 0 255 255 72 193"),
            (DataAs::Uint, "0 10 65535 49480"),
            (DataAs::Int, "0 10 -1 -16056"),
            (DataAs::Udint, "655360 3242786815"),
            (DataAs::Dint, "655360 -1052180481"),
        ] {
            assert_eq!(data_as.write(&data).as_deref(), Some(text));
            assert_eq!(data_as.read(text).unwrap(), data, "{text}");
        }
        assert_eq!(DataAs::Real.write(&[0, 0, 0x48, 0x41]).as_deref(), Some("12.5"));
        assert_eq!(DataAs::Real.read("12.5 -0").unwrap(), [0, 0, 0x48, 0x41, 0, 0, 0, 0x80]);
    }

    #[test]
    fn a_layout_says_how_data_is_shown() {
        for (layout, data_as) in [
            ("start: UINT; quantity: UINT", DataAs::Uint),
            ("start: UINT; quantity: UINT; register: INT[1]", DataAs::Uint),
            ("REAL", DataAs::Real),
            ("speed: REAL; run: BOOL", DataAs::Bytes),
            ("", DataAs::Bytes),
        ] {
            assert_eq!(DataAs::of_layout(layout), data_as, "{layout}");
        }
    }

    #[test]
    fn what_is_no_number_of_the_type_is_said() {
        for (data_as, text, piece) in [
            (DataAs::Uint, "0 65536", "65536"),
            (DataAs::Usint, "-1", "-1"),
            (DataAs::Int, "10 1x", "1x"),
            (DataAs::Real, "NaN", "NaN"),
        ] {
            assert!(data_as.read(text).unwrap_err().contains(piece));
        }
        assert!(
            DataAs::Real.read("12,5").unwrap_err().contains("decimals have a point"),
            "12.5, or 12 and 5?"
        );
        assert_eq!(DataAs::Real.read("12.5, 3; 0e5").unwrap().len(), 12, "a comma beside a space separates");
        assert!(DataAs::Real.read("1e-60").is_err(), "it would be sent as 0");
        assert_eq!(DataAs::Uint.read("12,5").map(|data| DataAs::Uint.count(&data)), Ok(2));
        assert!(DataAs::Bytes.read("0").is_err(), "half a byte");
    }

    #[test]
    fn data_that_is_not_of_the_type_is_not_shown_as_it() {
        assert_eq!(DataAs::Uint.write(&[1, 2, 3]), None);
        assert_eq!(DataAs::Real.write(&[0, 0, 0xC0, 0x7F]), None, "a NaN has many spellings");
    }
}
