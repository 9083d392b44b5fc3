//! Tokens one by one: what every parser of the grammar begins with.

use alloc::string::ToString;

use winnow::Parser;
use winnow::error::ParserError;
use winnow::stream::{Stateful, Stream, TokenSlice};

use super::token::{Lexeme, Token};
use crate::code::remark::RemarkKind;

/// Brackets inside of brackets.
pub(super) const MAX_DEPTH: usize = 48;

/// Tokens of the source `'a`, in a list that lives for `'t`; the state is the depth.
pub(super) type Input<'t, 'a> = Stateful<TokenSlice<'t, Token<'a>>, usize>;

/// Why a statement is not understood.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Failure {
    /// Tokens from there to the end.
    pub(super) left: usize,
    /// What is wrong.
    pub(super) what: RemarkKind,
}

/// What a parser has read, or why it has not.
pub(super) type Parsed<T> = Result<T, Failure>;

impl Failure {
    pub(super) fn new(input: &Input<'_, '_>, what: RemarkKind) -> Self {
        Self { left: input.eof_offset(), what }
    }

    pub(super) fn expected(input: &Input<'_, '_>, what: &str) -> Self {
        Self::new(input, RemarkKind::Expected(what.to_string()))
    }
}

impl<'t, 'a> ParserError<Input<'t, 'a>> for Failure {
    type Inner = Self;

    fn from_input(input: &Input<'t, 'a>) -> Self {
        Self::new(input, RemarkKind::NotUnderstood)
    }

    fn into_inner(self) -> Result<Self, Self> {
        Ok(self)
    }
}

/// The next token, if it is this sign.
pub(super) fn sign<'t, 'a: 't>(sign: &'static str) -> impl Parser<Input<'t, 'a>, &'t Token<'a>, Failure> {
    move |input: &mut Input<'t, 'a>| match input.peek_token() {
        Some(token) if token.is_sign(sign) => {
            input.next_token();
            Ok(token)
        }
        _ => Err(Failure::expected(input, sign)),
    }
}

/// The next token, if it is this keyword.
pub(super) fn word<'t, 'a: 't>(word: &'static str) -> impl Parser<Input<'t, 'a>, &'t Token<'a>, Failure> {
    move |input: &mut Input<'t, 'a>| match input.peek_token() {
        Some(token) if token.is_word(word) => {
            input.next_token();
            Ok(token)
        }
        _ => Err(Failure::expected(input, word)),
    }
}

pub(super) fn name<'t, 'a: 't>(input: &mut Input<'t, 'a>) -> Parsed<&'t Token<'a>> {
    match input.peek_token() {
        Some(token) if token.lexeme == Lexeme::Name => {
            input.next_token();
            Ok(token)
        }
        _ => Err(Failure::expected(input, "a name")),
    }
}

/// Whether the next token is one of these signs.
pub(super) fn is_next(input: &Input<'_, '_>, signs: &[&str]) -> bool {
    input.peek_token().is_some_and(|token| signs.iter().any(|sign| token.is_sign(sign)))
}

/// Runs a parser one level deeper.
pub(super) fn deeper<'t, 'a: 't, T>(
    input: &mut Input<'t, 'a>,
    parser: fn(&mut Input<'t, 'a>) -> Parsed<T>,
) -> Parsed<T> {
    if input.state >= MAX_DEPTH {
        return Err(Failure::new(input, RemarkKind::TooDeep));
    }
    input.state += 1;
    let parsed = parser(input);
    input.state -= 1;
    parsed
}
