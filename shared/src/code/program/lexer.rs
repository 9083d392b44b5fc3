//! Text → tokens of Python or Rust.

use alloc::string::String;
use alloc::vec::Vec;

use super::escape::{bytes, text};
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
    /// Of an opening bracket: how many tokens further the one is that closes it. 0: none does.
    pub(in crate::code) close: usize,
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
    pair(&mut lexer.tokens);
    (lexer.tokens, lexer.remarks)
}

/// Finds the bracket that closes each one. Without it brackets inside of brackets would be counted again and again.
fn pair(tokens: &mut [Token<'_>]) {
    let mut open = Vec::new();
    for at in 0..tokens.len() {
        match tokens.get(at).filter(|token| token.kind == Kind::Sign).map_or("", |token| token.text) {
            "(" | "[" | "{" => open.push(at),
            ")" | "]" | "}" => {
                if let Some(start) = open.pop()
                    && let Some(token) = tokens.get_mut(start)
                {
                    token.close = at - start;
                }
            }
            _ => {}
        }
    }
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
            self.string(prefix, quote, language);
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

    fn string(&mut self, prefix: &'a str, quote: &'static str, language: Language) {
        let start = prefix.len() + quote.len();
        let body = self.rest.get(start..).unwrap_or_default();
        let has = |letter: char| prefix.chars().any(|c| c.eq_ignore_ascii_case(&letter));
        let one_line = language == Language::Python && quote.len() == 1;
        let Some(length) = end_of(body, quote, has('r'), one_line) else {
            let excerpt = self.rest.lines().next().unwrap_or_default();
            let what = RemarkKind::Unclosed("this string");
            self.remarks.push(Remark::error(self.line, self.column, excerpt, what));
            // It ends with its line. What it would have held is not known.
            return self.push(Kind::Sign, excerpt.len().max(1));
        };
        let inside = body.get(..length).unwrap_or_default();
        let whole = start + length + quote.len();
        // What stands in braces is made by the program.
        if has('f') && inside.contains('{') {
            return self.push(Kind::Sign, whole);
        }
        let kind = if has('b') {
            let raw = inside.is_ascii().then(|| inside.as_bytes().to_vec());
            (if has('r') { raw } else { bytes(inside, language) }).map(Kind::Bytes)
        } else if has('r') {
            Some(Kind::Text(inside.into()))
        } else {
            text(inside, language).map(Kind::Text)
        };
        if kind.is_none() {
            let excerpt = self.rest.get(..whole).unwrap_or_default();
            let what = RemarkKind::Expected("a string whose characters and escapes are known".into());
            self.remarks.push(Remark::error(self.line, self.column, excerpt, what));
        }
        self.push(kind.unwrap_or(Kind::Sign), whole);
    }

    fn push(&mut self, kind: Kind, length: usize) {
        let text = self.rest.get(..length).unwrap_or_default();
        self.tokens.push(Token { kind, text, line: self.line, column: self.column, close: 0 });
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
fn end_of(body: &str, quote: &str, raw: bool, one_line: bool) -> Option<usize> {
    let mut escaped = false;
    for (at, c) in body.char_indices() {
        if escaped {
            escaped = false;
        } else if c == '\\' && !raw {
            escaped = true;
        } else if body.get(at..).is_some_and(|rest| rest.starts_with(quote)) {
            return Some(at);
        } else if c == '\n' && one_line {
            return None;
        }
    }
    None
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
