//! Text → tokens of Python or Rust.

use alloc::string::String;
use alloc::vec::Vec;

use crate::code::remark::{Remark, RemarkKind};

/// What a program is written in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::code) enum Language {
    /// `#` begins a comment; strings may have three quotes.
    Python,
    /// `//` and `/* */` are comments.
    Rust,
}

/// What a token is.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::code) enum Kind {
    /// An identifier or a keyword.
    Name,
    /// A whole number.
    Number(i64),
    /// `3.0`
    Real(f64),
    /// A string.
    Text(String),
    /// `b"\x01"`
    Bytes(Vec<u8>),
    /// One character of anything else.
    Sign,
}

/// A token.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::code) struct Token<'a> {
    pub(in crate::code) kind: Kind,
    pub(in crate::code) text: &'a str,
    /// From 1.
    pub(in crate::code) line: usize,
    /// In characters, from 1.
    pub(in crate::code) column: usize,
}

impl Token<'_> {
    /// Whether it is this name or sign.
    pub(in crate::code) fn is(&self, text: &str) -> bool {
        matches!(self.kind, Kind::Name | Kind::Sign) && self.text == text
    }
}

/// All tokens of a text, and strings that have no end.
pub(in crate::code) fn tokens(text: &str, language: Language) -> (Vec<Token<'_>>, Vec<Remark>) {
    let mut lexer = Lexer { rest: text, line: 1, column: 1, tokens: Vec::new(), remarks: Vec::new() };
    while let Some(c) = lexer.rest.chars().next() {
        let before = lexer.rest.len();
        lexer.step(c, language);
        if lexer.rest.len() == before {
            lexer.take(c.len_utf8());
        }
    }
    (lexer.tokens, lexer.remarks)
}

struct Lexer<'a> {
    rest: &'a str,
    line: usize,
    column: usize,
    tokens: Vec<Token<'a>>,
    remarks: Vec<Remark>,
}

impl<'a> Lexer<'a> {
    fn step(&mut self, c: char, language: Language) {
        let rest = self.rest;
        if c.is_whitespace() {
            self.take(c.len_utf8());
        } else if (language == Language::Python && c == '#')
            || (language == Language::Rust && rest.starts_with("//"))
        {
            self.take(rest.find('\n').unwrap_or(rest.len()));
        } else if language == Language::Rust && rest.starts_with("/*") {
            self.take(block_comment(rest));
        } else if let Some((prefix, quote)) = opening(rest, language) {
            self.string(prefix, quote);
        } else if c.is_alphabetic() || c == '_' {
            let end = rest.find(|c: char| !(c.is_alphanumeric() || c == '_')).unwrap_or(rest.len());
            self.push(Kind::Name, end);
        } else if c.is_ascii_digit() {
            self.number();
        } else {
            self.push(Kind::Sign, c.len_utf8());
        }
    }

    /// `147`, `0x93`, `0b1`, `1_000u16`, `2.5`.
    fn number(&mut self) {
        let rest = self.rest;
        let end = rest.find(|c: char| !(c.is_ascii_alphanumeric() || c == '_')).unwrap_or(rest.len());
        let after = rest.get(end..).unwrap_or_default();
        let fraction = after.strip_prefix('.').filter(|rest| rest.starts_with(|c: char| c.is_ascii_digit()));
        if let Some(fraction) = fraction {
            let digits = fraction.find(|c: char| !(c.is_ascii_digit() || c == '_')).unwrap_or(fraction.len());
            let end = end + 1 + digits;
            let number = rest.get(..end).unwrap_or_default().replace('_', "").parse();
            return self.push(number.map_or(Kind::Sign, Kind::Real), end);
        }
        let text = rest.get(..end).unwrap_or_default().replace('_', "").to_ascii_lowercase();
        let radix =
            [("0x", 16), ("0b", 2), ("0o", 8)].into_iter().find(|(prefix, _)| text.starts_with(prefix));
        let digits = text.get(if radix.is_some() { 2 } else { 0 }..).unwrap_or_default();
        // A type behind it, as in 14u8.
        let types = ["usize", "u8", "u16", "u32", "u64", "i8", "i16", "i32", "i64"];
        let digits = types.into_iter().find_map(|kind| digits.strip_suffix(kind)).unwrap_or(digits);
        let number = i64::from_str_radix(digits, radix.map_or(10, |(_, radix)| radix));
        self.push(number.map_or(Kind::Sign, Kind::Number), end);
    }

    fn string(&mut self, prefix: &'a str, quote: &'static str) {
        let start = prefix.len() + quote.len();
        let body = self.rest.get(start..).unwrap_or_default();
        let raw = prefix.contains(['r', 'R']);
        let Some(length) = end_of(body, quote, raw) else {
            let excerpt = self.rest.lines().next().unwrap_or_default();
            let what = RemarkKind::Unclosed("this string");
            self.remarks.push(Remark::error(self.line, self.column, excerpt, what));
            // It ends with its line.
            return self.push(Kind::Text(String::new()), excerpt.len().max(1));
        };
        let inside = body.get(..length).unwrap_or_default();
        let is_bytes = prefix.contains(['b', 'B']);
        let bytes = if raw { inside.as_bytes().to_vec() } else { unescaped(inside, is_bytes) };
        let kind = if is_bytes {
            Kind::Bytes(bytes)
        } else {
            Kind::Text(String::from_utf8(bytes).unwrap_or_else(|_| inside.into()))
        };
        self.push(kind, start + length + quote.len());
    }

    fn push(&mut self, kind: Kind, length: usize) {
        let text = self.rest.get(..length).unwrap_or_default();
        self.tokens.push(Token { kind, text, line: self.line, column: self.column });
        self.take(length);
    }

    fn take(&mut self, length: usize) {
        let (taken, rest) = self.rest.split_at_checked(length).unwrap_or((self.rest, ""));
        for c in taken.chars() {
            (self.line, self.column) =
                if c == '\n' { (self.line + 1, 1) } else { (self.line, self.column + 1) };
        }
        self.rest = rest;
    }
}

/// Prefix and quotes of a string that begins here.
fn opening(text: &str, language: Language) -> Option<(&str, &'static str)> {
    // At most two letters stand before the quotes.
    let (end, _) = text.char_indices().take(3).find(|(_, c)| matches!(c, '"' | '\''))?;
    let (prefix, rest) = text.split_at_checked(end)?;
    let quotes: &[&'static str] = match language {
        Language::Python => &["\"\"\"", "'''", "\"", "'"],
        Language::Rust => &["\""],
    };
    let is_prefix = prefix.chars().all(|c| "bBrRfFuU".contains(c));
    let quote = quotes.iter().find(|quote| rest.starts_with(**quote))?;
    is_prefix.then_some((prefix, *quote))
}

/// Where the closing quotes are.
fn end_of(body: &str, quote: &str, raw: bool) -> Option<usize> {
    let mut escaped = false;
    for (at, c) in body.char_indices() {
        if escaped {
            escaped = false;
        } else if c == '\\' && !raw {
            escaped = true;
        } else if body.get(at..).is_some_and(|rest| rest.starts_with(quote)) {
            return Some(at);
        } else if c == '\n' && quote == "'" {
            return None;
        }
    }
    None
}

/// A byte of a byte string is the byte itself; a character of a string is written in UTF-8.
fn unescaped(text: &str, is_bytes: bool) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut chars = text.chars();
    let push = |bytes: &mut Vec<u8>, code: u32| match u8::try_from(code) {
        Ok(byte) if is_bytes => bytes.push(byte),
        _ => {
            let c = char::from_u32(code).unwrap_or(char::REPLACEMENT_CHARACTER);
            bytes.extend_from_slice(c.encode_utf8(&mut [0; 4]).as_bytes());
        }
    };
    while let Some(c) = chars.next() {
        if c != '\\' {
            push(&mut bytes, c.into());
            continue;
        }
        match chars.next() {
            Some('x') => push(&mut bytes, digits(&mut chars, 2)),
            Some('u') if chars.as_str().starts_with('{') => {
                let code =
                    chars.as_str().get(1..).and_then(|rest| rest.split('}').next()).unwrap_or_default();
                push(&mut bytes, u32::from_str_radix(code, 16).unwrap_or(0xFFFD));
                chars.by_ref().find(|c| *c == '}');
            }
            Some('u') => push(&mut bytes, digits(&mut chars, 4)),
            Some('U') => push(&mut bytes, digits(&mut chars, 8)),
            Some('n') => bytes.push(b'\n'),
            Some('r') => bytes.push(b'\r'),
            Some('t') => bytes.push(b'\t'),
            Some('0') => bytes.push(0),
            Some('\n') | None => {}
            Some(c) => push(&mut bytes, c.into()),
        }
    }
    bytes
}

fn digits(chars: &mut core::str::Chars<'_>, count: usize) -> u32 {
    chars.by_ref().take(count).fold(0, |code, c| code << 4 | c.to_digit(16).unwrap_or(0))
}

fn block_comment(text: &str) -> usize {
    let mut depth = 0_usize;
    let bytes = text.as_bytes();
    let mut at = 0;
    while let Some(pair) = bytes.get(at..at + 2) {
        match pair {
            b"/*" => (depth, at) = (depth + 1, at + 2),
            b"*/" => (depth, at) = (depth.saturating_sub(1), at + 2),
            _ => at += 1,
        }
        if depth == 0 {
            return at;
        }
    }
    text.len()
}

#[cfg(test)]
mod tests {
    use super::*;
    use alloc::vec;

    fn kinds(text: &str, language: Language) -> Vec<Kind> {
        tokens(text, language).0.into_iter().map(|token| token.kind).collect()
    }

    #[test]
    fn constants_of_both_languages_are_read() {
        let text = |text: &str| Kind::Text(text.into());
        assert_eq!(
            kinds("0x0E 1_000 2.5 b'\\x01a' '''x\n''' \"\\\"\\u00e9\" # y", Language::Python),
            vec![
                Kind::Number(14),
                Kind::Number(1000),
                Kind::Real(2.5),
                Kind::Bytes(vec![1, 97]),
                text("x\n"),
                text("\"é")
            ]
        );
        assert_eq!(
            kinds("14u8 0x93_u16 /* /* */ */ b\"\\xff\" \"\\u{1F980}\" // y", Language::Rust),
            vec![Kind::Number(14), Kind::Number(0x93), Kind::Bytes(vec![255]), text("🦀")]
        );
    }

    #[test]
    fn any_text_ends() {
        for text in ["'", "\"\"\"", "b'", "/*", "\\", "0x", "9999999999999999999999", "'\\", "é'"] {
            for language in [Language::Python, Language::Rust] {
                let _ = tokens(text, language);
            }
        }
        assert_eq!(tokens("x\n 'y", Language::Python).1[0].line, 2);
    }
}
