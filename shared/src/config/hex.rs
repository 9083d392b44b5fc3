//! Bytes as people write them: `0A 0b`, `0x0A, 0x0B`, `0A-0B`, `16#0A`, `0Ah`. Never guessed: a lone digit is refused.

use alloc::string::String;
use alloc::vec::Vec;
use core::fmt::Write;

/// Reads hexadecimal text. Separators are white space, `,`, `;`, `:`, `-` and `_`.
pub fn read_hex(text: &str) -> Result<Vec<u8>, HexError> {
    let mut bytes = Vec::new();
    let mut position = 0;
    for token in text.split_inclusive(is_separator) {
        let word = token.trim_end_matches(is_separator);
        read_word(word, position, &mut bytes)?;
        position += token.chars().count();
    }
    Ok(bytes)
}

/// Lower case without spaces.
pub fn write_hex(bytes: &[u8]) -> String {
    let mut text = String::with_capacity(2 * bytes.len());
    for byte in bytes {
        // Writing to a String cannot fail.
        let _ = write!(text, "{byte:02x}");
    }
    text
}

/// For reading: `0a0b` is `0a 0b`.
pub fn space_hex(hex: &str) -> String {
    let mut text = String::with_capacity(hex.len() + hex.len() / 2);
    for (position, digit) in hex.chars().enumerate() {
        if position > 0 && position % 2 == 0 {
            text.push(' ');
        }
        text.push(digit);
    }
    text
}

/// Where hexadecimal text is unreadable.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct HexError {
    /// Character position, counted from 0.
    pub position: usize,
    /// What is wrong there.
    pub kind: HexErrorKind,
}

/// What is wrong with hexadecimal text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HexErrorKind {
    /// Not a hexadecimal digit.
    NotHex(char),
    /// A group of digits of odd length: half a byte is missing.
    OddDigits,
}

fn is_separator(c: char) -> bool {
    c.is_whitespace() || matches!(c, ',' | ';' | ':' | '-' | '_')
}

fn read_word(word: &str, position: usize, bytes: &mut Vec<u8>) -> Result<(), HexError> {
    let lead = ["0x", "0X", "16#"].into_iter().find(|prefix| word.starts_with(prefix)).map_or(0, str::len);
    let digits = word.get(lead..).unwrap_or_default();
    let digits = if lead == 0 { digits.strip_suffix(['h', 'H']).unwrap_or(digits) } else { digits };
    let position = position + lead;
    let mut half = None;
    let mut count = 0;
    for c in digits.chars() {
        let digit = c.to_digit(16).and_then(|digit| u8::try_from(digit).ok());
        let digit = digit.ok_or(HexError { position: position + count, kind: HexErrorKind::NotHex(c) })?;
        count += 1;
        half = match half {
            None => Some(digit),
            Some(high) => {
                bytes.push(high << 4 | digit);
                None
            }
        };
    }
    let empty = count == 0 && !word.is_empty();
    if half.is_some() || empty {
        return Err(HexError { position, kind: HexErrorKind::OddDigits });
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_people_paste_is_read() {
        for text in [
            "0a0b0c",
            "0A 0B 0C",
            "0x0A,0x0B,0x0C",
            "0A-0B-0C",
            "0A:0B:0C",
            "16#0A 16#0B\n16#0C",
            "0Ah 0Bh 0Ch",
        ] {
            assert_eq!(read_hex(text), Ok(alloc::vec![10, 11, 12]), "{text}");
        }
        assert_eq!(read_hex(" \n"), Ok(Vec::new()));
        assert_eq!(write_hex(&[0x0A, 0xFF]), "0aff");
        assert_eq!((space_hex("a10a").as_str(), space_hex("").as_str()), ("a1 0a", ""));
    }

    #[test]
    fn what_could_mean_two_things_is_refused_with_its_place() {
        for (text, position, kind) in [
            ("1 2 3", 0, HexErrorKind::OddDigits),
            ("0A0", 0, HexErrorKind::OddDigits),
            ("0A 0x", 5, HexErrorKind::OddDigits),
            ("0A 1x", 4, HexErrorKind::NotHex('x')),
            ("0A é0", 3, HexErrorKind::NotHex('é')),
        ] {
            assert_eq!(read_hex(text), Err(HexError { position, kind }), "{text}");
        }
    }
}
