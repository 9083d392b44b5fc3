//! Small lexers: just enough to give a text colours.

use alloc::vec::Vec;
use core::ops::Range;

use super::Ink;

/// What a language has.
#[expect(clippy::struct_excessive_bools, reason = "each language has some of these, in any combination")]
pub(super) struct Grammar {
    keywords: &'static [&'static str],
    /// What begins a comment up to the end of the line.
    line_comment: &'static [&'static str],
    /// `/* */`
    block_comment: bool,
    quotes: &'static str,
    /// A text before a colon is a name.
    keys: bool,
    /// `--class` is a name.
    options: bool,
    /// Two hexadecimal digits are a number.
    hex: bool,
}

impl Grammar {
    const NOTHING: Self = Self {
        keywords: &[],
        line_comment: &[],
        block_comment: false,
        quotes: "",
        keys: false,
        options: false,
        hex: false,
    };
    pub(super) const XML: Self = Self::NOTHING;
    pub(super) const JSON: Self =
        Self { keywords: &["true", "false", "null"], quotes: "\"", keys: true, ..Self::NOTHING };
    pub(super) const PYTHON: Self = Self {
        keywords: &[
            "from", "import", "with", "as", "def", "return", "if", "elif", "else", "for", "in", "not", "and",
            "or", "None", "True", "False", "print", "raise", "try", "except", "class", "assert",
        ],
        line_comment: &["#"],
        quotes: "\"'",
        ..Self::NOTHING
    };
    pub(super) const RUST: Self = Self {
        keywords: &[
            "use", "let", "mut", "fn", "async", "await", "pub", "struct", "impl", "for", "in", "if", "else",
            "match", "return", "const", "true", "false", "as", "mod", "dyn", "Ok", "Err", "Some", "None",
            "Result", "main",
        ],
        line_comment: &["//"],
        block_comment: true,
        quotes: "\"",
        ..Self::NOTHING
    };
    pub(super) const SHELL: Self = Self {
        keywords: &["cipdeck", "send"],
        line_comment: &["#"],
        quotes: "\"'",
        options: true,
        ..Self::NOTHING
    };
    pub(super) const HEX: Self = Self { line_comment: &["# ", "//"], hex: true, ..Self::NOTHING };
}

/// Goes through a text once.
pub(super) struct Lexer<'t, 'g> {
    text: &'t str,
    grammar: &'g Grammar,
    at: usize,
    inked: Vec<(Range<usize>, Ink)>,
}

impl<'t, 'g> Lexer<'t, 'g> {
    pub(super) const fn new(text: &'t str, grammar: &'g Grammar) -> Self {
        Self { text, grammar, at: 0, inked: Vec::new() }
    }

    fn rest(&self) -> &'t str {
        self.text.get(self.at..).unwrap_or_default()
    }

    /// Takes so many bytes, with a colour or without.
    fn take(&mut self, length: usize, ink: Option<Ink>) {
        let end = (self.at + length.max(1)).min(self.text.len());
        // Always at a whole character.
        let end =
            (end..=self.text.len()).find(|end| self.text.is_char_boundary(*end)).unwrap_or(self.text.len());
        self.inked.extend(ink.map(|ink| (self.at..end, ink)));
        self.at = end;
    }

    fn until(&self, close: &str, from: usize) -> usize {
        let rest = self.rest();
        let found = rest.get(from..).and_then(|after| after.find(close));
        found.map_or(rest.len(), |at| from + at + close.len())
    }

    /// Everything but XML.
    pub(super) fn words(mut self) -> Vec<(Range<usize>, Ink)> {
        while let Some(first) = self.rest().chars().next() {
            let rest = self.rest();
            if self.grammar.line_comment.iter().any(|mark| rest.starts_with(mark)) {
                self.take(rest.find('\n').unwrap_or(rest.len()), Some(Ink::Comment));
            } else if self.grammar.block_comment && rest.starts_with("/*") {
                self.take(self.until("*/", 2), Some(Ink::Comment));
            } else if self.grammar.quotes.contains(first) {
                self.quoted(first);
            } else if self.grammar.options && rest.starts_with("--") {
                self.take(length(rest, |c| c.is_alphanumeric() || c == '-'), Some(Ink::Name));
            } else if first.is_ascii_digit() || self.grammar.hex && first.is_ascii_hexdigit() {
                self.take(length(rest, |c| c.is_alphanumeric() || "_.#".contains(c)), Some(Ink::Number));
            } else if first.is_alphabetic() || first == '_' {
                let word = length(rest, |c| c.is_alphanumeric() || c == '_');
                let known = rest.get(..word).is_some_and(|word| self.grammar.keywords.contains(&word));
                // `b'…'` is a text with a letter before it.
                self.take(word, known.then_some(Ink::Keyword));
            } else {
                self.take(first.len_utf8(), None);
            }
        }
        self.inked
    }

    fn quoted(&mut self, quote: char) {
        let rest = self.rest();
        let mut escaped = false;
        let mut end = rest.len();
        for (at, c) in rest.char_indices().skip(1) {
            if c == quote && !escaped {
                end = at + c.len_utf8();
                break;
            }
            escaped = c == '\\' && !escaped;
        }
        let key =
            self.grammar.keys && rest.get(end..).is_some_and(|after| after.trim_start().starts_with(':'));
        self.take(end, Some(if key { Ink::Name } else { Ink::Text }));
    }

    /// Elements, attributes, comments, CDATA.
    pub(super) fn xml(mut self) -> Vec<(Range<usize>, Ink)> {
        let mut inside = false;
        while let Some(first) = self.rest().chars().next() {
            let rest = self.rest();
            if rest.starts_with("<!--") {
                self.take(self.until("-->", 4), Some(Ink::Comment));
            } else if rest.starts_with("<?") {
                self.take(self.until("?>", 2), Some(Ink::Comment));
            } else if rest.starts_with("<![CDATA[") {
                self.take(self.until("]]>", 9), Some(Ink::Text));
            } else if first == '<' {
                inside = true;
                let slash = if rest.starts_with("</") { 2 } else { 1 };
                let name = length(rest.get(slash..).unwrap_or_default(), |c| {
                    c.is_alphanumeric() || "_.:-".contains(c)
                });
                self.take(slash + name, Some(Ink::Keyword));
            } else if inside && (first == '>' || rest.starts_with("/>")) {
                inside = false;
                self.take(if first == '>' { 1 } else { 2 }, Some(Ink::Keyword));
            } else if inside && (first == '"' || first == '\'') {
                let close = if first == '"' { "\"" } else { "'" };
                self.take(self.until(close, 1), Some(Ink::Text));
            } else if inside && first.is_alphabetic() {
                self.take(length(rest, |c| c.is_alphanumeric() || "_.:-".contains(c)), Some(Ink::Name));
            } else {
                self.take(first.len_utf8(), None);
            }
        }
        self.inked
    }
}

/// Bytes up to the first character that is something else.
fn length(text: &str, is: impl Fn(char) -> bool) -> usize {
    text.find(|c| !is(c)).unwrap_or(text.len())
}
