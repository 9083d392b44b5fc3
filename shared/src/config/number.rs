//! Numbers as engineers write them: `147`, `0x93`, `93h`, `16#93`.

/// Reads a whole number, decimal or marked as hexadecimal. Digits may be grouped by `_`.
pub fn read_number(text: &str) -> Result<i64, NumberError> {
    let text = text.trim();
    if text.is_empty() {
        return Err(NumberError::Empty);
    }
    let (negative, magnitude) = text.strip_prefix('-').map_or((false, text), |rest| (true, rest));
    let lower = magnitude.to_ascii_lowercase();
    let (digits, radix) = if let Some(digits) = lower.strip_prefix("0x").or_else(|| lower.strip_prefix("16#"))
    {
        (digits, 16)
    } else if let Some(digits) = lower.strip_suffix('h') {
        (digits, 16)
    } else if lower.bytes().any(|b| matches!(b, b'a'..=b'f')) && lower.bytes().all(|b| b.is_ascii_hexdigit())
    {
        return Err(NumberError::UnmarkedHex);
    } else {
        (lower.as_str(), 10)
    };
    let digits = digits.replace('_', "");
    let unsigned = digits.bytes().next().is_some_and(|first| first.is_ascii_hexdigit());
    if !unsigned {
        return Err(NumberError::Unreadable);
    }
    let value = i64::from_str_radix(&digits, radix).map_err(|error| match error.kind() {
        core::num::IntErrorKind::PosOverflow => NumberError::TooBig,
        _ => NumberError::Unreadable,
    })?;
    Ok(if negative { -value } else { value })
}

/// Why a text is not a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NumberError {
    /// Nothing was typed.
    #[error("a number is missing")]
    Empty,
    /// Letters a to f without a mark: could be meant as hexadecimal, is not guessed.
    #[error("hexadecimal needs a mark: 0x93, 93h or 16#93")]
    UnmarkedHex,
    /// Not a number.
    #[error("not a number; write 147, 0x93, 93h or 16#93")]
    Unreadable,
    /// Over 64 bits.
    #[error("the number is far too big")]
    TooBig,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_spelling_of_147_is_read() {
        for text in ["147", " 147 ", "0x93", "0X93", "93h", "93H", "16#93", "0x0093", "1_47"] {
            assert_eq!(read_number(text), Ok(147), "{text}");
        }
        assert_eq!(read_number("-1"), Ok(-1));
    }

    #[test]
    fn what_is_not_a_number_is_said() {
        for (text, error) in [
            ("", NumberError::Empty),
            ("1x", NumberError::Unreadable),
            ("1.5", NumberError::Unreadable),
            ("0x", NumberError::Unreadable),
            ("--1", NumberError::Unreadable),
            ("+1", NumberError::Unreadable),
            ("0x-1", NumberError::Unreadable),
            ("3F", NumberError::UnmarkedHex),
            ("99999999999999999999", NumberError::TooBig),
        ] {
            assert_eq!(read_number(text), Err(error), "{text}");
        }
    }
}
