//! The bytes of a file → text, or why they are none.

use alloc::borrow::ToOwned;
use alloc::string::String;

use super::MAX_TEXT;

/// A file's text. Its lines end with a line feed, as those of a text field do.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Decoded {
    /// Without a byte order mark.
    pub text: String,
    /// How it was written.
    pub encoding: Encoding,
}

/// How characters are written in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Encoding {
    /// What everybody writes now.
    Utf8,
    /// With a byte order mark.
    Utf16,
    /// Not UTF-8: each byte is read as one character. Old editors for controllers write Western European comments so.
    Latin1,
}

impl Encoding {
    /// Its stable name.
    pub const fn word(self) -> &'static str {
        match self {
            Self::Utf8 => "utf-8",
            Self::Utf16 => "utf-16",
            Self::Latin1 => "latin-1",
        }
    }

    /// The one with this name; UTF-8, of which nothing is said, for any other.
    pub fn of_word(word: &str) -> Self {
        let all = [Self::Utf16, Self::Latin1];
        all.into_iter().find(|it| it.word() == word).unwrap_or(Self::Utf8)
    }
}

/// Why a file is not read.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NoText {
    /// It has nothing in it.
    #[error("there is nothing in it")]
    Empty,
    /// So many bytes are too many.
    #[error("a text has at most {MAX_TEXT} bytes; nothing of it was read")]
    TooBig(usize),
    /// It holds bytes that no text has: a picture, an archive, a project of an editor.
    #[error("it is no text: it holds bytes that no text has")]
    Binary,
}

/// Reads a file.
pub fn decode(bytes: &[u8]) -> Result<Decoded, NoText> {
    if bytes.len() > MAX_TEXT {
        return Err(NoText::TooBig(bytes.len()));
    }
    let (text, encoding) = match bytes {
        [] => return Err(NoText::Empty),
        [0xFF, 0xFE, rest @ ..] => (utf16(rest, u16::from_le_bytes)?, Encoding::Utf16),
        [0xFE, 0xFF, rest @ ..] => (utf16(rest, u16::from_be_bytes)?, Encoding::Utf16),
        [0xEF, 0xBB, 0xBF, rest @ ..] => (utf8(rest).ok_or(NoText::Binary)?, Encoding::Utf8),
        _ => match utf8(bytes) {
            Some(text) => (text, Encoding::Utf8),
            None => (bytes.iter().copied().map(char::from).collect(), Encoding::Latin1),
        },
    };
    if text.chars().any(is_of_no_text) {
        return Err(NoText::Binary);
    }
    if text.trim().is_empty() {
        return Err(NoText::Empty);
    }
    Ok(Decoded { text: with_line_feeds(&text), encoding })
}

/// Lines that end as those of a text field do, so that numbers of lines and places of characters are the same.
pub fn with_line_feeds(text: &str) -> String {
    text.replace("\r\n", "\n").replace('\r', "\n")
}

fn utf8(bytes: &[u8]) -> Option<String> {
    core::str::from_utf8(bytes).ok().map(str::to_owned)
}

fn utf16(bytes: &[u8], unit: fn([u8; 2]) -> u16) -> Result<String, NoText> {
    let (pairs, rest) = bytes.as_chunks::<2>();
    if !rest.is_empty() {
        return Err(NoText::Binary);
    }
    let units = pairs.iter().map(|pair| unit(*pair));
    char::decode_utf16(units).collect::<Result<_, _>>().map_err(|_| NoText::Binary)
}

/// Control characters, those of Latin-1 as well, but for tabs, ends of lines and of pages.
fn is_of_no_text(c: char) -> bool {
    c.is_control() && !matches!(c, '\t' | '\n' | '\r' | '\u{c}')
}

#[cfg(test)]
mod tests {
    use super::*;
    use alloc::vec;

    fn read(bytes: &[u8]) -> (String, Encoding) {
        let decoded = decode(bytes).expect("a text");
        (decoded.text, decoded.encoding)
    }

    #[test]
    fn a_text_is_read_as_it_was_written() {
        assert_eq!(read(b"a\r\nb\rc\n"), ("a\nb\nc\n".into(), Encoding::Utf8));
        assert_eq!(read(b"\xEF\xBB\xBF<x/>"), ("<x/>".into(), Encoding::Utf8));
        assert_eq!(read("(* dé *)".as_bytes()), ("(* dé *)".into(), Encoding::Utf8));
        assert_eq!(read(b"(* d\xE9bit *)"), ("(* débit *)".into(), Encoding::Latin1));
        assert_eq!(read(b"\xFF\xFEa\0\xE9\0"), ("aé".into(), Encoding::Utf16));
        assert_eq!(read(b"\xFE\xFF\0a\0\n"), ("a\n".into(), Encoding::Utf16));
    }

    #[test]
    fn what_is_no_text_is_told() {
        assert_eq!(decode(b""), Err(NoText::Empty));
        assert_eq!(decode(b" \n\t"), Err(NoText::Empty));
        assert_eq!(decode(b"\x89PNG\r\n\x1A\n\0\0"), Err(NoText::Binary));
        assert_eq!(decode(b"PK\x03\x04"), Err(NoText::Binary));
        assert_eq!(decode(b"\xFF\xFEa"), Err(NoText::Binary), "half a character");
        assert_eq!(decode(&vec![b'a'; MAX_TEXT + 1]), Err(NoText::TooBig(MAX_TEXT + 1)));
        assert_eq!(decode(&vec![b'a'; MAX_TEXT]).map(|it| it.text.len()), Ok(MAX_TEXT));
    }
}
