//! Text → tokens.

use alloc::vec::Vec;

use winnow::Parser;
use winnow::combinator::{alt, opt, repeat};
use winnow::error::EmptyError;
use winnow::token::{any, one_of, take_while};

use crate::code::remark::{Remark, RemarkKind};

/// A place in a text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::code) struct Place {
    /// From 1.
    pub(in crate::code) line: usize,
    /// In characters, from 1.
    pub(in crate::code) column: usize,
    /// In bytes, from 0.
    pub(in crate::code) at: usize,
}

/// What a token is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::code) enum Lexeme {
    /// An identifier or a keyword, also `Type#Value` of an enumeration.
    Name,
    /// `14`, `16#0E`, `USINT#14`, `1.5`, `T#3s`, `BOOL#1`.
    Number,
    /// `'…'`, `"…"`, and the quotes of word processors.
    Text,
    /// `%MW10`, `%MW10:5`.
    Address,
    /// An operator or a separator.
    Sign,
    /// `(* *)`, `/* */`, `//`. The tokens of a script have none.
    Comment,
}

/// A token.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::code) struct Token<'a> {
    /// What it is.
    pub(in crate::code) lexeme: Lexeme,
    /// As it is written.
    pub(in crate::code) text: &'a str,
    /// Where it begins.
    pub(in crate::code) place: Place,
}

impl Token<'_> {
    /// Whether it is this operator or separator.
    pub(in crate::code) fn is_sign(&self, sign: &str) -> bool {
        self.lexeme == Lexeme::Sign && self.text == sign
    }

    /// Whether it is this keyword, in any case.
    pub(in crate::code) fn is_word(&self, word: &str) -> bool {
        self.lexeme == Lexeme::Name && self.text.eq_ignore_ascii_case(word)
    }

    /// The byte after it.
    pub(in crate::code) const fn end(&self) -> usize {
        self.place.at + self.text.len()
    }
}

/// All tokens of a text, and what is none. Comments are among them only `with_comments`.
pub(in crate::code) fn tokens(text: &str, with_comments: bool) -> (Vec<Token<'_>>, Vec<Remark>) {
    let (mut tokens, mut remarks) = (Vec::new(), Vec::new());
    let mut rest = text;
    let mut place = Place { line: 1, column: 1, at: 0 };
    while !rest.is_empty() {
        let before = rest;
        let read = read(&mut rest);
        let length = before.len() - rest.len();
        let Some((taken, _)) = before.split_at_checked(length.max(1)).filter(|_| length > 0) else {
            break; // every reader takes something
        };
        match read {
            Read::Token(Lexeme::Comment) if !with_comments => {}
            Read::Token(lexeme) => tokens.push(Token { lexeme, text: taken, place }),
            Read::Unclosed(lexeme, what) => {
                remarks.push(Remark::error(place.line, place.column, taken, RemarkKind::Unclosed(what)));
                if lexeme != Lexeme::Comment || with_comments {
                    tokens.push(Token { lexeme, text: taken, place });
                }
            }
            Read::Space => {}
            Read::Unknown => {
                remarks.push(Remark::error(place.line, place.column, taken, RemarkKind::NotUnderstood));
            }
        }
        place = after(place, taken);
    }
    (tokens, remarks)
}

/// The place after some text.
fn after(place: Place, taken: &str) -> Place {
    let mut place = Place { at: place.at + taken.len(), ..place };
    for c in taken.chars() {
        if c == '\n' {
            place.line += 1;
            place.column = 1;
        } else {
            place.column += 1;
        }
    }
    place
}

enum Read {
    Token(Lexeme),
    Space,
    Unknown,
    Unclosed(Lexeme, &'static str),
}

/// Nobody looks at why a token is not another one.
type Nothing = EmptyError;

fn read(input: &mut &str) -> Read {
    let first = input.chars().next().unwrap_or_default();
    if first.is_whitespace() || first == '\u{feff}' {
        let _ = take_while::<_, _, Nothing>(1.., |c: char| c.is_whitespace() || c == '\u{feff}')
            .parse_next(input);
        return Read::Space;
    }
    if let Some(read) = comment(input) {
        return read;
    }
    if let Some(read) = text(input) {
        return read;
    }
    let lexeme = alt((
        name.value(Lexeme::Name),
        number.value(Lexeme::Number),
        address.value(Lexeme::Address),
        sign.value(Lexeme::Sign),
    ))
    .parse_next(input);
    match lexeme {
        Ok(Lexeme::Name) => typed(input),
        Ok(lexeme) => Read::Token(lexeme),
        Err(_) => {
            let _: Result<_, Nothing> = (any, take_while(0.., is_unknown)).take().parse_next(input);
            Read::Unknown
        }
    }
}

/// Characters that begin no token; a run of them is one remark.
fn is_unknown(c: char) -> bool {
    !(c.is_alphanumeric() || c.is_whitespace() || "_'\"%()[]{}:;,.=<>+-*/&^#@‘’“”".contains(c))
}

fn is_name(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}

fn name<'a>(input: &mut &'a str) -> Result<&'a str, Nothing> {
    (one_of(|c: char| c.is_alphabetic() || c == '_'), take_while(0.., is_name)).take().parse_next(input)
}

/// What may follow a name at once: `USINT#16#0E`, `T#1m_30s`, `T#-3.5s`, `Type#Value`.
fn typed(input: &mut &str) -> Read {
    let value = |c: char| is_name(c) || c == '#' || c == '.';
    let rest: Result<_, Nothing> =
        ('#', opt(one_of(['+', '-'])), take_while(1.., value)).take().parse_next(input);
    match rest {
        Ok(rest) => {
            let digit = |c: char| c.is_ascii_digit();
            let value = rest.trim_start_matches(['#', '+', '-']);
            let boolean = value.eq_ignore_ascii_case("TRUE") || value.eq_ignore_ascii_case("FALSE");
            Read::Token(if value.starts_with(digit) || boolean { Lexeme::Number } else { Lexeme::Name })
        }
        Err(_) => Read::Token(Lexeme::Name),
    }
}

/// A digit, and everything that cannot be anything else: what it is worth is seen later.
fn number<'a>(input: &mut &'a str) -> Result<&'a str, Nothing> {
    let digits =
        |input: &mut &'a str| -> Result<&'a str, Nothing> { take_while(1.., is_name).parse_next(input) };
    let sign = |input: &mut &'a str| -> Result<&'a str, Nothing> {
        // `1.5e-3`; the e is the last of the digits before.
        let exponent = (one_of(['+', '-']), take_while(1.., |c: char| c.is_ascii_digit()));
        exponent.take().parse_next(input)
    };
    let start = *input;
    (one_of(|c: char| c.is_ascii_digit()), take_while(0.., is_name)).take().parse_next(input)?;
    if input.starts_with('#') {
        return ('#', digits).take().parse_next(input).map(|_| taken(start, input));
    }
    let fraction = input.strip_prefix('.').is_some_and(|rest| rest.starts_with(|c: char| c.is_ascii_digit()));
    if fraction {
        ('.', digits).take().parse_next(input)?;
        if taken(start, input).ends_with(['e', 'E']) {
            let _ = opt(sign).parse_next(input);
        }
    }
    Ok(taken(start, input))
}

fn taken<'a>(start: &'a str, rest: &str) -> &'a str {
    start.get(..start.len() - rest.len()).unwrap_or_default()
}

fn address<'a>(input: &mut &'a str) -> Result<&'a str, Nothing> {
    let digit = |c: char| c.is_ascii_digit();
    let table = (':', take_while(1.., digit));
    let part = ('.', take_while(1.., is_name));
    (
        '%',
        one_of(|c: char| c.is_ascii_alphabetic()),
        take_while(0.., is_name),
        repeat::<_, _, (), _, _>(0.., part),
        opt(table),
    )
        .take()
        .parse_next(input)
}

const LONG_SIGNS: [&str; 9] = ["...", ":=", "=>", "<=", ">=", "<>", "**", "..", "::"];

fn sign<'a>(input: &mut &'a str) -> Result<&'a str, Nothing> {
    if let Some(mut sign) = LONG_SIGNS.into_iter().find(|sign| input.starts_with(sign)) {
        return sign.parse_next(input);
    }
    one_of(|c: char| "()[]{}:;,.=<>+-*/&^#@".contains(c)).take().parse_next(input)
}

/// `(* (* nested *) *)`, `/* */`, `//`.
fn comment(input: &mut &str) -> Option<Read> {
    if input.starts_with("//") {
        let _ = take_while::<_, _, Nothing>(1.., |c| c != '\n').parse_next(input);
        return Some(Read::Token(Lexeme::Comment));
    }
    let (open, close) = [("(*", "*)"), ("/*", "*/")].into_iter().find(|(open, _)| input.starts_with(open))?;
    let mut depth = 0_usize;
    while !input.is_empty() {
        let step: Result<_, Nothing> =
            alt((open.value(Some(true)), close.value(Some(false)), any.value(None))).parse_next(input);
        match step {
            Ok(Some(true)) => depth += 1,
            Ok(Some(false)) => depth = depth.saturating_sub(1),
            Ok(None) => continue,
            Err(_) => break,
        }
        if depth == 0 {
            return Some(Read::Token(Lexeme::Comment));
        }
    }
    Some(Read::Unclosed(Lexeme::Comment, "this comment"))
}

/// Up to the quote, or to the end of the line. `$` takes the next character's meaning away.
fn text(input: &mut &str) -> Option<Read> {
    let open = input.chars().next()?;
    let close = match open {
        '\'' | '"' => open,
        '‘' | '’' => '’',
        '“' | '”' => '”',
        _ => return None,
    };
    let mut escaped = false;
    let mut end = None;
    for (at, c) in input.char_indices().skip(1) {
        if c == '\n' {
            *input = input.get(at..).unwrap_or_default();
            return Some(Read::Unclosed(Lexeme::Text, "this string"));
        }
        if c == close && !escaped {
            end = Some(at + c.len_utf8());
            break;
        }
        escaped = c == '$' && !escaped;
    }
    let Some(end) = end else {
        *input = "";
        return Some(Read::Unclosed(Lexeme::Text, "this string"));
    };
    *input = input.get(end..).unwrap_or_default();
    Some(Read::Token(Lexeme::Text))
}

#[cfg(test)]
mod tests {
    use super::*;
    use alloc::string::String;

    fn shown(text: &str) -> String {
        let (tokens, remarks) = tokens(text, true);
        let tokens = tokens.iter().map(|token| alloc::format!("{:?} {}", token.lexeme, token.text));
        let remarks = remarks.iter().map(|remark| alloc::format!("! {remark}"));
        tokens.chain(remarks).collect::<Vec<_>>().join("\n")
    }

    #[test]
    fn every_kind_of_token_is_told_from_the_others() {
        for (text, expected) in [
            ("a_1 := 14;", "Name a_1\nSign :=\nNumber 14\nSign ;"),
            ("16#0E 2#1010_0001 8#17 1_000", "Number 16#0E\nNumber 2#1010_0001\nNumber 8#17\nNumber 1_000"),
            ("USINT#16#0E INT#-5 BOOL#TRUE", "Number USINT#16#0E\nNumber INT#-5\nNumber BOOL#TRUE"),
            ("T#3s TIME#1m_30s T#2.5s", "Number T#3s\nNumber TIME#1m_30s\nNumber T#2.5s"),
            ("_eKIND#_NONE", "Name _eKIND#_NONE"),
            ("1.5 1.5e-3 0..4 0.3", "Number 1.5\nNumber 1.5e-3\nNumber 0\nSign ..\nNumber 4\nNumber 0.3"),
            ("%MW10 %MW10:5 %MX0.3", "Address %MW10\nAddress %MW10:5\nAddress %MX0.3"),
            ("Tab_Gest[1].0", "Name Tab_Gest\nSign [\nNumber 1\nSign ]\nSign .\nNumber 0"),
            ("'it$'s' \"b\" ‘x’", "Text 'it$'s'\nText \"b\"\nText ‘x’"),
            ("(* a (* b *) c *)d// e\nf", "Comment (* a (* b *) c *)\nName d\nComment // e\nName f"),
            ("réseau", "Name réseau"),
        ] {
            assert_eq!(shown(text), expected, "{text}");
        }
    }

    #[test]
    fn what_is_no_token_is_remarked_at_its_place() {
        assert_eq!(
            shown("a\n  é ?? b"),
            "Name a\nName é\nName b\n! 2:5: error: not understood, left out: ??"
        );
        assert_eq!(shown("a (* b"), "Name a\nComment (* b\n! 1:3: error: this comment has no end: (* b");
        assert_eq!(shown("'b\nc"), "Text 'b\nName c\n! 1:1: error: this string has no end: 'b");
    }

    #[test]
    fn a_long_run_of_anything_ends() {
        for unit in ["(*", "'", "a ", "((((", "1.", "%", "§", "$'", "//", "#"] {
            let text = unit.repeat((1 << 17) / unit.len());
            let (tokens, remarks) = tokens(&text, true);
            assert!(tokens.len() + remarks.len() > 0, "{unit}");
        }
    }
}
