//! Declarations: names, types with their bounds, and initial values.

use alloc::vec;
use alloc::vec::Vec;

use winnow::Parser;
use winnow::combinator::{delimited, opt, preceded, separated};
use winnow::stream::Stream;

use super::grammar::{expression, reference};
use super::input::{Failure, Input, MAX_DEPTH, Parsed, is_next, name, sign, word};
use super::syntax::{Declaration, Declared, Expression};
use super::token::{Lexeme, Place, Token};
use crate::code::remark::RemarkKind;

/// `a, b AT %MW10 : INT := 5`, without what ends it.
pub(super) fn declaration<'t, 'a: 't>(input: &mut Input<'t, 'a>, constant: bool) -> Parsed<Declaration<'a>> {
    let names: Vec<&Token<'a>> = separated(1.., name, sign(",")).parse_next(input)?;
    let at = opt(preceded(word("AT"), reference)).parse_next(input)?.map(|reference| reference.root);
    sign(":").parse_next(input)?;
    let kind = declared(input)?;
    let initial = if is_next(input, &[":="]) {
        sign(":=").parse_next(input)?;
        Some(initial(input)?)
    } else {
        None
    };
    let names = names.into_iter().map(|token| (token.text, token.place)).collect();
    Ok(Declaration { names, at, kind, initial, constant })
}

/// An initial value; an array's may stand without brackets.
fn initial<'t, 'a: 't>(input: &mut Input<'t, 'a>) -> Parsed<Expression<'a>> {
    let first = expression(input)?;
    if !is_next(input, &[","]) {
        return Ok(first);
    }
    let place = first.place();
    let mut list = vec![first];
    while is_next(input, &[","]) {
        sign(",").parse_next(input)?;
        list.push(expression(input)?);
    }
    Ok(Expression::List(list, place))
}

/// `ARRAY [0..4, 1..2] OF STRING[80]`
fn declared<'t, 'a: 't>(input: &mut Input<'t, 'a>) -> Parsed<Declared<'a>> {
    let (mut all, mut slip) = (Vec::new(), None);
    while opt(word("ARRAY")).parse_next(input)?.is_some() {
        if all.len() >= MAX_DEPTH {
            return Err(Failure::new(input, RemarkKind::TooDeep));
        }
        sign("[").parse_next(input)?;
        loop {
            let (bounds, slipped) = bounds(input)?;
            all.push(bounds);
            slip = slip.or(slipped);
            if is_next(input, &["]"]) {
                break;
            }
            sign(",").parse_next(input)?;
        }
        sign("]").parse_next(input)?;
        word("OF").parse_next(input)?;
    }
    let name = name(input)?.text;
    let length = if is_next(input, &["["]) {
        Some(delimited(sign("["), whole, sign("]")).parse_next(input)?)
    } else if is_next(input, &["("]) {
        Some(delimited(sign("("), whole, sign(")")).parse_next(input)?)
    } else {
        None
    };
    Ok(Declared { bounds: all, name, length, slip })
}

/// `0..4`; also `0...4` and `0.4`, which manuals print.
fn bounds<'t, 'a: 't>(input: &mut Input<'t, 'a>) -> Parsed<((i128, i128), Option<Place>)> {
    let token = input.peek_token();
    let slipped = token.filter(|token| token.lexeme == Lexeme::Number).and_then(|token| {
        let (low, high) = token.text.split_once('.')?;
        let whole = |digits: &str| digits.parse::<i64>().ok().map(i128::from);
        Some(((whole(low)?, whole(high)?), Some(token.place)))
    });
    if let Some(bounds) = slipped {
        input.next_token();
        return Ok(bounds);
    }
    let low = whole(input)?;
    let dots = input.peek_token().filter(|token| token.is_sign("...")).map(|token| token.place);
    if dots.is_some() {
        input.next_token();
    } else {
        sign("..").parse_next(input)?;
    }
    let high = whole(input)?;
    Ok(((low, high), dots))
}

/// A whole number, perhaps with a sign.
fn whole<'t, 'a: 't>(input: &mut Input<'t, 'a>) -> Parsed<i128> {
    let before = input.checkpoint();
    let parsed = expression(input)?;
    parsed.integer().ok_or_else(|| {
        input.reset(&before);
        Failure::expected(input, "a whole number")
    })
}
