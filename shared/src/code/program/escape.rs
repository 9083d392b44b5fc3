//! What is between the quotes of a literal, as the language reads it.

use alloc::string::String;
use alloc::vec::Vec;
use core::str::Chars;

use super::lexer::Language;

/// A character as it is written, or the number of one that is escaped.
enum Part {
    Plain(char),
    Code(u32),
}

/// The text; `None`: the language refuses it, or it depends on a table of names.
pub(super) fn text(inside: &str, language: Language) -> Option<String> {
    parts(inside, language, false)?
        .into_iter()
        .map(|part| match part {
            Part::Plain(c) => Some(c),
            Part::Code(code) => char::from_u32(code),
        })
        .collect()
}

/// The bytes; `None`: the language refuses them.
pub(super) fn bytes(inside: &str, language: Language) -> Option<Vec<u8>> {
    parts(inside, language, true)?
        .into_iter()
        .map(|part| match part {
            // Neither language takes others in bytes.
            Part::Plain(c) => u8::try_from(c).ok().filter(u8::is_ascii),
            Part::Code(code) => u8::try_from(code).ok(),
        })
        .collect()
}

fn parts(inside: &str, language: Language, is_bytes: bool) -> Option<Vec<Part>> {
    let mut parts = Vec::new();
    let mut chars = inside.chars();
    while let Some(c) = chars.next() {
        if c != '\\' {
            parts.push(Part::Plain(c));
            continue;
        }
        let escaped = chars.next()?;
        let code = match (escaped, language) {
            ('\n', Language::Python) => continue,
            ('\n', Language::Rust) => {
                let rest = chars.as_str().trim_start_matches([' ', '\t', '\n', '\r']);
                chars = rest.chars();
                continue;
            }
            ('\\' | '\'' | '"', _) => u32::from(escaped),
            ('n', _) => 10,
            ('r', _) => 13,
            ('t', _) => 9,
            ('x', _) => digits(&mut chars, 2)?,
            ('0', Language::Rust) => 0,
            ('u', Language::Rust) if !is_bytes => braced(&mut chars)?,
            (_, Language::Rust) => return None,
            ('a', Language::Python) => 7,
            ('b', Language::Python) => 8,
            ('f', Language::Python) => 12,
            ('v', Language::Python) => 11,
            ('0'..='7', Language::Python) => octal(escaped, &mut chars),
            ('u', Language::Python) if !is_bytes => digits(&mut chars, 4)?,
            ('U', Language::Python) if !is_bytes => digits(&mut chars, 8)?,
            ('N', Language::Python) if !is_bytes => return None,
            // Anything else stays as it is, with its backslash.
            (other, Language::Python) => {
                parts.extend([Part::Plain('\\'), Part::Plain(other)]);
                continue;
            }
        };
        parts.push(Part::Code(code));
    }
    Some(parts)
}

/// So many hexadecimal digits.
fn digits(chars: &mut Chars<'_>, count: usize) -> Option<u32> {
    (0..count).try_fold(0, |code, _| Some(code << 4 | chars.next()?.to_digit(16)?))
}

/// `{1F980}`
fn braced(chars: &mut Chars<'_>) -> Option<u32> {
    let (code, rest) = chars.as_str().strip_prefix('{')?.split_once('}')?;
    *chars = rest.chars();
    u32::from_str_radix(code, 16).ok()
}

/// One to three digits, the first of which is taken already.
fn octal(first: char, chars: &mut Chars<'_>) -> u32 {
    let mut code = first.to_digit(8).unwrap_or_default();
    for _ in 0..2 {
        let Some(digit) = chars.clone().next().and_then(|c| c.to_digit(8)) else { break };
        chars.next();
        code = code * 8 + digit;
    }
    code
}

#[cfg(test)]
mod tests {
    use super::*;
    use alloc::vec;

    #[test]
    fn escapes_are_those_of_their_language() {
        let python = |inside| bytes(inside, Language::Python);
        assert_eq!(python(r"\x0e\012\0\18\a\b\f\v\n"), Some(vec![14, 10, 0, 1, b'8', 7, 8, 12, 11, 10]));
        assert_eq!(python(r"\q\u0041"), Some(br"\q\u0041".to_vec()));
        assert_eq!(text(r"\u00e9\U0001F980", Language::Python), Some("é🦀".into()));
        let rust = |inside| bytes(inside, Language::Rust);
        assert_eq!(rust(r"\x0e\012\'"), Some(vec![14, 0, b'1', b'2', b'\'']));
        assert_eq!(rust("a\\\n   b"), Some(b"ab".to_vec()));
        assert_eq!(text(r"\u{1F980}", Language::Rust), Some("🦀".into()));
    }

    #[test]
    fn what_a_language_refuses_is_no_text() {
        for inside in [r"\xZ1", r"\x4", "é", r"\777", "\\"] {
            assert_eq!(bytes(inside, Language::Python), None, "{inside}");
        }
        for inside in [r"\N{DASH}", r"\uD800", r"\U00110000", r"\u12"] {
            assert_eq!(text(inside, Language::Python), None, "{inside}");
        }
        for inside in [r"\q", r"\u{}", r"\u{110000}", r"\u41"] {
            assert_eq!(text(inside, Language::Rust), None, "{inside}");
        }
    }
}
