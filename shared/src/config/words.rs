//! Words as Control Expert shows them: `0000 030E 0120`.

use alloc::string::String;
use alloc::vec::Vec;
use core::fmt;

use super::number::read_number;

/// Why a table of words cannot be read, and where.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WordsError {
    /// Characters before the word that is wrong.
    pub position: usize,
    /// What is wrong with it.
    pub kind: WordsErrorKind,
}

/// What is wrong with a word.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum WordsErrorKind {
    /// Neither four hexadecimal digits nor a marked number: nobody can tell whether `10` is ten or sixteen.
    Unmarked(String),
    /// A number that no word holds: 0 to 65535, or -32768 to -1 as an INT.
    OutOfRange(i64),
}

impl fmt::Display for WordsError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let at = self.position + 1;
        match &self.kind {
            WordsErrorKind::Unmarked(word) => {
                write!(f, "'{word}' at character {at}: write four hexadecimal digits (030E), or 16#30E")
            }
            WordsErrorKind::OutOfRange(value) => {
                write!(f, "{value} at character {at} does not fit into a word: 0 to 65535")
            }
        }
    }
}

impl core::error::Error for WordsError {}

/// Reads words between spaces, commas, semicolons and line ends. Exactly four digits are hexadecimal; everything else
/// has to be marked: `16#30E`, `0x30E`, `30Eh`.
pub fn read_words(text: &str) -> Result<Vec<u16>, WordsError> {
    let mut words = Vec::new();
    let mut position = 0;
    for piece in text.split([' ', '\t', '\r', '\n', ',', ';', '\u{a0}']) {
        if !piece.is_empty() {
            words.push(read_word(piece).map_err(|kind| WordsError { position, kind })?);
        }
        position += piece.chars().count() + 1;
    }
    Ok(words)
}

fn read_word(piece: &str) -> Result<u16, WordsErrorKind> {
    if piece.len() == 4 && piece.bytes().all(|byte| byte.is_ascii_hexdigit()) {
        return u16::from_str_radix(piece, 16).map_err(|_| WordsErrorKind::Unmarked(piece.into()));
    }
    let is_marked = piece.contains('#') || piece.contains(['x', 'X']) || piece.ends_with(['h', 'H']);
    let value = is_marked.then(|| read_number(piece).ok()).flatten();
    let value = value.ok_or_else(|| WordsErrorKind::Unmarked(piece.into()))?;
    u16::try_from(value)
        .or_else(|_| i16::try_from(value).map(i16::cast_unsigned))
        .map_err(|_| WordsErrorKind::OutOfRange(value))
}

/// `0000 030E 0120`
pub fn write_words(words: &[u16]) -> String {
    let mut text = String::with_capacity(words.len() * 5);
    for word in words {
        if !text.is_empty() {
            text.push(' ');
        }
        for shift in [12, 8, 4, 0] {
            let digit = u32::from(word >> shift & 0xF);
            text.extend(char::from_digit(digit, 16).map(|digit| digit.to_ascii_uppercase()));
        }
    }
    text
}

/// The bytes of words, low byte first.
pub fn bytes_of(words: &[u16]) -> Vec<u8> {
    words.iter().flat_map(|word| word.to_le_bytes()).collect()
}

/// Words that hold bytes, low byte first; the high byte of a half word is 0.
pub fn words_of(bytes: &[u8]) -> Vec<u16> {
    bytes.chunks(2).map(|pair| pair.iter().rev().fold(0, |word, byte| word << 8 | u16::from(*byte))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use alloc::vec;

    #[test]
    fn words_are_read_as_they_are_written_down() {
        let product_name = vec![0x0000, 0x030E, 0x0120, 0x0124, 0x0730];
        assert_eq!(read_words("0000 030E 0120 0124 0730"), Ok(product_name.clone()));
        assert_eq!(read_words("16#0000, 16#30e; 0x120\n124h\t0730"), Ok(product_name.clone()));
        assert_eq!(write_words(&product_name), "0000 030E 0120 0124 0730");
        assert_eq!(read_words(" -16#1 "), Ok(vec![0xFFFF]), "as an INT");
        assert_eq!(read_words(""), Ok(vec![]));
    }

    #[test]
    fn what_could_mean_two_numbers_is_refused_where_it_stands() {
        for (text, position, word) in
            [("0000 10", 5, "10"), ("03E", 0, "03E"), ("0000,0120,1234A", 10, "1234A"), ("00é0", 0, "00é0")]
        {
            let unmarked = WordsErrorKind::Unmarked(word.into());
            assert_eq!(read_words(text), Err(WordsError { position, kind: unmarked }), "{text}");
        }
        let too_big = WordsErrorKind::OutOfRange(0x10000);
        assert_eq!(read_words("16#10000"), Err(WordsError { position: 0, kind: too_big }));
    }

    #[test]
    fn the_low_byte_comes_first() {
        assert_eq!(bytes_of(&[0x030E, 0x0120]), [0x0E, 0x03, 0x20, 0x01]);
        assert_eq!(words_of(&[0x0E, 0x03, 0x20]), [0x030E, 0x0020]);
    }
}
