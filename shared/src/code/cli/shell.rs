//! Words of a POSIX shell: quotes, backslashes, comments and lines that go on.

use alloc::string::{String, ToString};
use alloc::vec::Vec;

/// A word that the shell gives on as it is.
pub(super) fn quoted(word: &str) -> String {
    let is_plain =
        |c: char| c.is_ascii_alphanumeric() || matches!(c, ',' | '.' | ':' | '/' | '_' | '-' | '+' | '=');
    if !word.is_empty() && word.chars().all(is_plain) {
        return word.to_string();
    }
    let mut quoted = String::from("'");
    quoted.push_str(&word.replace('\'', "'\\''"));
    quoted.push('\'');
    quoted
}

/// One word, and where it begins.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Word {
    pub(super) text: String,
    pub(super) line: usize,
    pub(super) column: usize,
    /// An operator between commands, such as `;`, `|` or the end of a line; it has no text of its own.
    pub(super) ends: bool,
}

/// All words. An error is the place of a quote that nothing closes.
pub(super) fn words(text: &str) -> (Vec<Word>, Option<(usize, usize)>) {
    let mut reader = Reader::default();
    let mut chars = text.chars().peekable();
    while let Some(c) = chars.next() {
        let place = (reader.line, reader.column);
        reader.count(c);
        match (reader.quote, c) {
            (Some(quote), c) if c == quote => reader.quote = None,
            (Some('"') | None, '\\') => match chars.next() {
                // Lines of Windows.
                Some('\r') if chars.peek() == Some(&'\n') => {
                    chars.next().into_iter().for_each(|c| reader.count(c));
                }
                Some('\n') => reader.count('\n'),
                // Inside of double quotes a backslash is itself before most characters.
                Some(next) => {
                    reader.count(next);
                    if reader.quote.is_some() && !matches!(next, '"' | '\\' | '$' | '`') {
                        reader.push('\\', place);
                    }
                    reader.push(next, place);
                }
                None => {}
            },
            (None, '\'' | '"') => {
                reader.quote = Some(c);
                reader.opened = place;
                reader.begin(place);
            }
            (None, '#') if reader.word.is_none() => {
                while chars.peek().is_some_and(|c| *c != '\n') {
                    chars.next().into_iter().for_each(|c| reader.count(c));
                }
            }
            (None, '\n' | ';' | '|' | '&' | '>' | '<' | '(' | ')') => reader.end_command(c, place),
            (None, c) if c.is_whitespace() => reader.end_word(),
            (_, c) => reader.push(c, place),
        }
    }
    reader.end_word();
    let unclosed = reader.quote.map(|_| reader.opened);
    (reader.words, unclosed)
}

struct Reader {
    words: Vec<Word>,
    word: Option<Word>,
    quote: Option<char>,
    opened: (usize, usize),
    line: usize,
    column: usize,
}

impl Default for Reader {
    fn default() -> Self {
        Self { words: Vec::new(), word: None, quote: None, opened: (1, 1), line: 1, column: 1 }
    }
}

impl Reader {
    fn count(&mut self, c: char) {
        (self.line, self.column) = if c == '\n' { (self.line + 1, 1) } else { (self.line, self.column + 1) };
    }

    fn begin(&mut self, (line, column): (usize, usize)) -> &mut String {
        let new = || Word { text: String::new(), line, column, ends: false };
        &mut self.word.get_or_insert_with(new).text
    }

    fn push(&mut self, c: char, place: (usize, usize)) {
        self.begin(place).push(c);
    }

    fn end_word(&mut self) {
        self.words.extend(self.word.take());
    }

    fn end_command(&mut self, c: char, (line, column): (usize, usize)) {
        self.end_word();
        let text = if c == '\n' { String::new() } else { c.to_string() };
        self.words.push(Word { text, line, column, ends: true });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(text: &str) -> Vec<String> {
        words(text).0.into_iter().map(|word| word.text).collect()
    }

    #[test]
    fn a_quoted_word_is_read_as_it_was() {
        for word in ["", "a b", "it's", "'; DROP", "$(x)`y`", "\\", "a\nb", "4,10.0.0.1", "--x", "é🦀", "#"]
        {
            let (read, unclosed) = words(&quoted(word));
            assert_eq!((read.len(), read[0].text.as_str(), unclosed), (1, word, None), "{word}");
        }
    }

    #[test]
    fn words_are_separated_as_a_shell_does() {
        assert_eq!(texts("a  'b c'\"d\\\"e\\n\" f\\ g"), ["a", "b cd\"e\\n", "f g"]);
        assert_eq!(texts("a \\\n  b # c 'd\ne#f"), ["a", "b", "", "e#f"]);
        assert_eq!(texts("a \\\r\n  b\r\nc"), ["a", "b", "", "c"]);
        assert_eq!(texts("a;b|c"), ["a", ";", "b", "|", "c"]);
        assert_eq!(words("a\n 'b").1, Some((2, 2)));
    }
}
