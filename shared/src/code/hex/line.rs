//! One line of bytes.

use alloc::string::ToString;
use alloc::vec::Vec;

use winnow::Parser;
use winnow::combinator::{alt, opt, preceded, terminated};
use winnow::error::EmptyError;
use winnow::token::{one_of, take_while};

use crate::code::remark::RemarkKind;

/// What a line says.
pub(super) enum Line {
    /// It is empty, or a comment.
    Nothing,
    /// Bytes; of a dump with their offset.
    Bytes {
        bytes: Vec<u8>,
        offset: Option<usize>,
        /// The line ends with a comma.
        goes_on: bool,
    },
    /// From 1.
    Wrong(usize, RemarkKind),
}

/// Bytes in one line of a dump, whatever program has written it.
const MAX_DUMP_LINE: usize = 32;

/// Reads a line that comes after so many bytes of an open request.
pub(super) fn read(line: &str, so_far: usize, goes_on: bool) -> Line {
    let content = without_comment(line);
    let indent = content.len() - content.trim_start().len();
    let content = content.trim();
    if content.is_empty() {
        return Line::Nothing;
    }
    if !goes_on && let Some((offset, rest)) = dump(content, so_far) {
        return match dump_bytes(rest) {
            Some(bytes) => Line::Bytes { bytes, offset: Some(offset), goes_on: false },
            None => wrong(line, indent + content.len() - rest.len()),
        };
    }
    let mut bytes = Vec::new();
    let mut rest = content;
    while !rest.is_empty() {
        let at = indent + content.len() - rest.len();
        if word.parse_next(&mut rest).is_ok_and(|digits| push(&mut bytes, digits)) {
            let _ = separators(&mut rest);
        } else {
            return wrong(line, at);
        }
    }
    Line::Bytes { bytes, offset: None, goes_on: content.ends_with(',') }
}

/// Whether a line can be nothing but bytes.
pub(in crate::code) fn is_hex(line: &str) -> bool {
    match read(line, 0, false) {
        // A lone number may be anything.
        Line::Bytes { bytes, .. } => bytes.len() > 1,
        Line::Nothing | Line::Wrong(..) => dump(line.trim(), usize::MAX).is_some(),
    }
}

fn wrong(line: &str, at: usize) -> Line {
    let column = line.get(..at).map_or(1, |before| before.chars().count() + 1);
    let what = RemarkKind::Expected("bytes as two hexadecimal digits, such as 0E 03 20 01".to_string());
    Line::Wrong(column, what)
}

/// `#` and `//` begin a comment, but not in `16#0E`.
fn without_comment(line: &str) -> &str {
    let hash = line.match_indices('#').map(|(at, _)| at);
    let hash =
        hash.filter(|at| line.get(..*at).is_some_and(|it| it.is_empty() || it.ends_with([' ', '\t']))).min();
    let end = hash.into_iter().chain(line.find("//")).min();
    line.get(..end.unwrap_or(line.len())).unwrap_or_default()
}

/// The offset at the start of a line of a dump: `0010  `, `00000010: `. It is the number of bytes so far, or 0.
fn dump(content: &str, so_far: usize) -> Option<(usize, &str)> {
    let digits = content.find(|c: char| !c.is_ascii_hexdigit())?;
    let (offset, rest) = content.split_at_checked(digits)?;
    let marked = rest.starts_with(": ") || rest.starts_with("  ") || rest.starts_with(['\t', '|']);
    if !(4..=8).contains(&offset.len()) || !marked {
        return None;
    }
    let offset = usize::from_str_radix(offset, 16).ok()?;
    let fits = offset == 0 || offset == so_far || so_far == usize::MAX;
    fits.then(|| (offset, rest.trim_start_matches([':', ' ', '\t', '|'])))
}

/// The bytes of a line of a dump. What follows them has to be the same bytes as text.
fn dump_bytes(rest: &str) -> Option<Vec<u8>> {
    let mut bytes = Vec::new();
    let mut rest = rest;
    while !rest.is_empty() && bytes.len() <= MAX_DUMP_LINE {
        if is_text_of(rest, &bytes) {
            return Some(bytes);
        }
        let digits = plain.parse_next(&mut rest).ok()?;
        if !push(&mut bytes, digits) {
            return None;
        }
        // Two spaces stand in the middle, and before the text.
        if is_text_of(rest.trim_start(), &bytes) {
            return Some(bytes);
        }
        let _ = separators(&mut rest);
    }
    rest.is_empty().then_some(bytes)
}

/// `....$.0.` or `|....$.0.|`: one character for each byte, a point for what cannot be shown.
fn is_text_of(text: &str, bytes: &[u8]) -> bool {
    let text = text.strip_prefix('|').map_or(text, |text| text.strip_suffix('|').unwrap_or(text));
    let shown = |(c, byte): (char, &u8)| c == '.' || c == char::from(*byte);
    !bytes.is_empty() && text.chars().count() == bytes.len() && text.chars().zip(bytes).all(shown)
}

type Nothing = EmptyError;

/// The digits of a word: `0E`, `0e03`, `0x0E`, `16#0E`, `0Eh`, `$0E`, `\x0E`.
fn word<'a>(input: &mut &'a str) -> Result<&'a str, Nothing> {
    let _ = opt(one_of(['{', '[', '(', '"', '\''])).parse_next(input)?;
    let marked = preceded(alt(("0x", "0X", "16#", "\\x", "$")), plain);
    alt((marked, terminated(plain, opt(one_of(['h', 'H']))))).parse_next(input)
}

fn plain<'a>(input: &mut &'a str) -> Result<&'a str, Nothing> {
    take_while(1.., |c: char| c.is_ascii_hexdigit()).parse_next(input)
}

/// Between words, also nothing: `\x0E\x03`. What closes a list closes it here.
fn separators<'a>(input: &mut &'a str) -> Result<&'a str, Nothing> {
    take_while(0.., |c: char| c.is_whitespace() || ",;:-_}])\"'".contains(c)).parse_next(input)
}

/// Half a byte is not guessed.
fn push(bytes: &mut Vec<u8>, digits: &str) -> bool {
    if !digits.len().is_multiple_of(2) {
        return false;
    }
    let pairs = (0..digits.len()).step_by(2).map(|at| u8::from_str_radix(digits.get(at..at + 2)?, 16).ok());
    let pairs: Option<Vec<u8>> = pairs.collect();
    pairs.map(|pairs| bytes.extend(pairs)).is_some()
}
