//! What can be said about a form before it is sent. The relay checks all of it again.

use yew::AttrValue;

use super::i18n::tr;

/// A user's name: 1 to 64 of `a-z 0-9 . _ -`.
pub fn name(text: &str) -> Option<AttrValue> {
    let is_allowed = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || "._-".contains(c);
    match text {
        "" => Some(tr!("check.name_missing")),
        text if text.len() > LONGEST_NAME => Some(tr!("check.name_long")),
        text if !text.chars().all(is_allowed) => Some(tr!("check.name_characters")),
        _ => None,
    }
}

/// A new password: at least 12 characters.
pub fn password(text: &str) -> Option<AttrValue> {
    let missing = SHORTEST_PASSWORD.saturating_sub(text.chars().count());
    (missing > 0).then(|| tr!("check.password_short", missing = missing))
}

/// The set-up code: 12 characters; spaces, dashes and case do not matter.
pub fn code(text: &str) -> Option<AttrValue> {
    let count = text.chars().filter(|c| !c.is_whitespace() && *c != '-').count();
    (count != CODE).then(|| tr!("check.code_length", count = count))
}

/// Something that must not be left empty.
pub fn needed(text: &str) -> Option<AttrValue> {
    text.trim().is_empty().then_some(tr!("check.missing"))
}

/// A number in a range.
pub fn number(text: &str, smallest: u32, biggest: u32) -> Result<u32, AttrValue> {
    let number = cipdeck_shared::config::read_number(text).ok().and_then(|number| u32::try_from(number).ok());
    number
        .filter(|number| (smallest..=biggest).contains(number))
        .ok_or_else(|| tr!("check.number", smallest = smallest, biggest = biggest))
}

/// Bytes.
const LONGEST_NAME: usize = 64;
/// Characters.
const SHORTEST_PASSWORD: usize = 12;
/// Characters.
const CODE: usize = 12;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_the_relay_would_refuse_is_told_at_the_field() {
        assert_eq!(name("anna.b-2_x"), None);
        for wrong in ["", "Anna", "anna b", "änne", &"a".repeat(65)] {
            assert!(name(wrong).is_some(), "{wrong}");
        }
        assert_eq!(password("correct horse"), None);
        assert_eq!(password("ä".repeat(12).as_str()), None, "characters, not bytes");
        assert!(password("short").unwrap().contains('7'), "says how many are missing");
        assert_eq!(code("7H2K-9PQX-M4RT"), None);
        assert_eq!(code(" 7h2k 9pqx m4rt "), None);
        assert!(code("7H2K-9PQX").unwrap().contains('8'));
    }

    #[test]
    fn numbers_are_read_in_both_radices() {
        assert_eq!(number("0x10", 1, 127), Ok(16));
        assert_eq!(number("16", 1, 127), Ok(16));
        for wrong in ["", "0", "128", "-1", "x"] {
            assert!(number(wrong, 1, 127).is_err(), "{wrong}");
        }
    }
}
