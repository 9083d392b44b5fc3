//! Where the keywords, comments, numbers, texts and names of a text are.

mod lexer;

use alloc::vec::Vec;
use core::ops::Range;

use self::lexer::{Grammar, Lexer};
use super::dialect::Dialect;
use super::text::{Lexeme, tokens};

/// What a part of a text is; the rest is plain.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Ink {
    /// A word of the language.
    Keyword,
    /// Nothing that is executed.
    Comment,
    /// A number.
    Number,
    /// A string.
    Text,
    /// A name, where the language tells it from other words: an element, an attribute, a member.
    Name,
}

/// The inked ranges of bytes, in order, without overlap. A text over [`super::MAX_TEXT`] stays plain.
pub fn highlight(dialect: Dialect, text: &str) -> Vec<(Range<usize>, Ink)> {
    if text.len() > super::MAX_TEXT {
        return Vec::new();
    }
    match dialect {
        Dialect::CcwSt
        | Dialect::SendReqEtc100
        | Dialect::SendReqEtc101
        | Dialect::DataExch
        | Dialect::SysmacSt => structured_text(text),
        Dialect::L5x => Lexer::new(text, &Grammar::XML).xml(),
        Dialect::Json => Lexer::new(text, &Grammar::JSON).words(),
        Dialect::Pycomm3 => Lexer::new(text, &Grammar::PYTHON).words(),
        Dialect::Rust => Lexer::new(text, &Grammar::RUST).words(),
        Dialect::Cli => Lexer::new(text, &Grammar::SHELL).words(),
        Dialect::Hex => Lexer::new(text, &Grammar::HEX).words(),
    }
}

/// Words of Structured Text and of Instruction List.
const KEYWORDS: [&str; 46] = [
    "VAR",
    "VAR_GLOBAL",
    "VAR_INPUT",
    "VAR_OUTPUT",
    "VAR_IN_OUT",
    "VAR_EXTERNAL",
    "VAR_TEMP",
    "END_VAR",
    "CONSTANT",
    "RETAIN",
    "AT",
    "ARRAY",
    "OF",
    "IF",
    "THEN",
    "ELSIF",
    "ELSE",
    "END_IF",
    "CASE",
    "END_CASE",
    "FOR",
    "TO",
    "BY",
    "DO",
    "END_FOR",
    "WHILE",
    "END_WHILE",
    "REPEAT",
    "UNTIL",
    "END_REPEAT",
    "RETURN",
    "EXIT",
    "AND",
    "OR",
    "XOR",
    "NOT",
    "MOD",
    "TRUE",
    "FALSE",
    "LD",
    "LDN",
    "ST",
    "CAL",
    "CALC",
    "JMPC",
    "JMPCN",
];

/// Types that declarations name.
const TYPES: [&str; 18] = [
    "BOOL",
    "BYTE",
    "WORD",
    "DWORD",
    "SINT",
    "USINT",
    "INT",
    "UINT",
    "DINT",
    "UDINT",
    "REAL",
    "STRING",
    "TIME",
    "MSG_CIPGENERIC",
    "CIPCONTROLCFG",
    "CIPAPPCFG",
    "CIPTARGETCFG",
    "CIPSTATUS",
];

fn structured_text(text: &str) -> Vec<(Range<usize>, Ink)> {
    let (tokens, _) = tokens(text, true);
    let mut member = false;
    let mut inked = Vec::new();
    for token in tokens {
        let is = |words: &[&str]| words.iter().any(|word| token.is_word(word));
        let ink = match token.lexeme {
            Lexeme::Comment => Some(Ink::Comment),
            Lexeme::Text => Some(Ink::Text),
            Lexeme::Number => Some(Ink::Number),
            Lexeme::Address => Some(Ink::Name),
            Lexeme::Name if member => Some(Ink::Name),
            Lexeme::Name if is(&KEYWORDS) || is(&TYPES) => Some(Ink::Keyword),
            Lexeme::Name | Lexeme::Sign => None,
        };
        member = token.is_sign(".");
        inked.extend(ink.map(|ink| (token.place.at..token.end(), ink)));
    }
    inked
}

#[cfg(test)]
mod tests {
    use super::*;
    use alloc::format;
    use alloc::string::String;

    fn inked(dialect: Dialect, text: &str) -> Vec<String> {
        highlight(dialect, text).into_iter().map(|(range, ink)| format!("{ink:?} {}", &text[range])).collect()
    }

    #[test]
    fn every_dialect_has_its_colours() {
        for (dialect, text, expected) in [
            (
                Dialect::CcwSt,
                "VAR a.Class := 16#0E; (* b *)",
                &["Keyword VAR", "Name Class", "Number 16#0E", "Comment (* b *)"][..],
            ),
            (Dialect::SysmacSt, "x := 'it$'s' // y", &["Text 'it$'s'", "Comment // y"]),
            (
                Dialect::L5x,
                "<?xml version=\"1.0\"?><!-- c --><Tag Name='x>y'>1 &lt; 2</Tag><![CDATA[<MSG>]]>",
                &[
                    "Comment <?xml version=\"1.0\"?>",
                    "Comment <!-- c -->",
                    "Keyword <Tag",
                    "Name Name",
                    "Text 'x>y'",
                    "Keyword >",
                    "Keyword </Tag",
                    "Keyword >",
                    "Text <![CDATA[<MSG>]]>",
                ],
            ),
            (
                Dialect::Json,
                "{\"a\": [1, true, \"b\\\"c\"]}",
                &["Name \"a\"", "Number 1", "Keyword true", "Text \"b\\\"c\""],
            ),
            (
                Dialect::Pycomm3,
                "with x(b'1') as y: # z\n n = 0x0E",
                &["Keyword with", "Text '1'", "Keyword as", "Comment # z", "Number 0x0E"],
            ),
            (
                Dialect::Rust,
                "let x: &'a str = \"s\"; // c\n /* d */ 5_u8",
                &["Keyword let", "Text \"s\"", "Comment // c", "Comment /* d */", "Number 5_u8"],
            ),
            (
                Dialect::Cli,
                "# c\ncipdeck send '4,1.2.3.4' --class 0x01",
                &[
                    "Comment # c",
                    "Keyword cipdeck",
                    "Keyword send",
                    "Text '4,1.2.3.4'",
                    "Name --class",
                    "Number 0x01",
                ],
            ),
            (Dialect::Hex, "# c\n0E 03", &["Comment # c", "Number 0E", "Number 03"]),
        ] {
            assert_eq!(inked(dialect, text), expected, "{dialect}");
        }
    }

    #[test]
    fn any_text_is_inked_in_order_at_whole_characters() {
        for text in
            ["\"ä", "<!-- é", "(* ö", "'\\", "/* ß", "<é \"", "b'\\", "# é", "<![CDATA[", "0x", "é'é'é\"é"]
        {
            for dialect in Dialect::ALL {
                let mut at = 0;
                for (range, _) in highlight(dialect, text) {
                    assert!(range.start >= at && range.end > range.start, "{dialect} {text}");
                    assert!(text.get(range.clone()).is_some(), "{dialect} {text}");
                    at = range.end;
                }
            }
        }
    }
}
