//! Tokens → expressions, assignments and calls.
//!
//! Each parser looks at one token and knows what to do; none goes back further than that.

use alloc::boxed::Box;
use alloc::vec;
use alloc::vec::Vec;

use winnow::Parser;
use winnow::combinator::{delimited, opt, separated, terminated};
use winnow::stream::Stream;

use super::input::{Failure, Input, Parsed, deeper, is_next, name, sign};
use super::literal::{Literal, read_literal};
use super::syntax::{Argument, Call, Expression, Reference, Statement, Step};
use super::token::{Lexeme, Place, Token};

/// `x`, `x + y`, `x AND NOT y`.
pub(super) fn expression<'t, 'a: 't>(input: &mut Input<'t, 'a>) -> Parsed<Expression<'a>> {
    let first = deeper(input, operand)?;
    let place = first.place();
    let mut operators = Vec::new();
    let mut operands = vec![first];
    while let Some(token) = input.peek_token().filter(|token| is_operator(token)) {
        input.next_token();
        operators.push(token.text);
        operands.push(deeper(input, operand)?);
    }
    Ok(match (operands.pop(), operands.is_empty()) {
        (Some(only), true) => only,
        (last, _) => {
            operands.extend(last);
            Expression::Chain(operands, operators, place)
        }
    })
}

fn is_operator(token: &Token<'_>) -> bool {
    match token.lexeme {
        Lexeme::Sign => {
            matches!(token.text, "+" | "-" | "*" | "/" | "**" | "<" | ">" | "<=" | ">=" | "=" | "<>" | "&")
        }
        Lexeme::Name => ["AND", "OR", "XOR", "MOD"].iter().any(|word| token.is_word(word)),
        _ => false,
    }
}

fn operand<'t, 'a: 't>(input: &mut Input<'t, 'a>) -> Parsed<Expression<'a>> {
    let Some(token) = input.peek_token() else { return Err(Failure::expected(input, "a value")) };
    let place = token.place;
    match token.lexeme {
        Lexeme::Number | Lexeme::Text => number(input, token),
        Lexeme::Address => Ok(Expression::Reference(reference(input)?)),
        Lexeme::Name if token.is_word("NOT") => unary(input, token),
        Lexeme::Name if token.is_word("TRUE") || token.is_word("FALSE") => {
            input.next_token();
            Ok(Expression::Literal(Literal::Bool(token.is_word("TRUE")), place))
        }
        Lexeme::Name => {
            let name = reference(input)?;
            if !is_next(input, &["("]) {
                return Ok(Expression::Reference(name));
            }
            let arguments = arguments(input)?;
            Ok(Expression::Call(Box::new(Call { name, arguments })))
        }
        Lexeme::Sign => match token.text {
            "-" | "+" => unary(input, token),
            "[" => {
                let list = delimited(sign("["), elements, sign("]")).parse_next(input)?;
                Ok(Expression::List(list, place))
            }
            "(" => in_parentheses(input, place),
            _ => Err(Failure::expected(input, "a value")),
        },
        Lexeme::Comment => Err(Failure::expected(input, "a value")),
    }
}

/// A number or a text; `2(0)` in a list of initial values.
fn number<'t, 'a: 't>(input: &mut Input<'t, 'a>, token: &Token<'a>) -> Parsed<Expression<'a>> {
    let place = token.place;
    let literal = read_literal(token.text).map_err(|what| Failure::new(input, what))?;
    input.next_token();
    match literal {
        Literal::Integer(count) if is_next(input, &["("]) => {
            let values = delimited(sign("("), elements, sign(")")).parse_next(input)?;
            Ok(Expression::Repeated(count, values, place))
        }
        literal => Ok(Expression::Literal(literal, place)),
    }
}

fn unary<'t, 'a: 't>(input: &mut Input<'t, 'a>, token: &Token<'a>) -> Parsed<Expression<'a>> {
    input.next_token();
    let inside = deeper(input, operand)?;
    Ok(Expression::Unary(token.text, Box::new(inside), token.place))
}

/// `(x + y)`, or the initial value of a structure: `(Service := 14, Class := 1)`.
fn in_parentheses<'t, 'a: 't>(input: &mut Input<'t, 'a>, place: Place) -> Parsed<Expression<'a>> {
    sign("(").parse_next(input)?;
    let before = input.checkpoint();
    let member = terminated(name, sign(":=")).parse_next(input).is_ok();
    input.reset(&before);
    if member {
        let members =
            terminated(separated(1.., structure_member, sign(",")), opt(sign(","))).parse_next(input)?;
        sign(")").parse_next(input)?;
        return Ok(Expression::Structure(members, place));
    }
    terminated(expression, sign(")")).parse_next(input)
}

fn structure_member<'t, 'a: 't>(input: &mut Input<'t, 'a>) -> Parsed<(&'a str, Expression<'a>)> {
    let name = terminated(name, sign(":=")).parse_next(input)?;
    Ok((name.text, expression(input)?))
}

/// `1, 2(0), x`
pub(super) fn elements<'t, 'a: 't>(input: &mut Input<'t, 'a>) -> Parsed<Vec<Expression<'a>>> {
    if is_next(input, &["]", ")"]) {
        return Ok(Vec::new());
    }
    terminated(separated(1.., expression, sign(",")), opt(sign(","))).parse_next(input)
}

/// `a.b[2].0`, `%MW10`.
pub(super) fn reference<'t, 'a: 't>(input: &mut Input<'t, 'a>) -> Parsed<Reference<'a>> {
    let root = match input.peek_token() {
        Some(token) if matches!(token.lexeme, Lexeme::Name | Lexeme::Address) => token,
        _ => return Err(Failure::expected(input, "a variable")),
    };
    input.next_token();
    let mut steps = Vec::new();
    loop {
        if is_next(input, &["["]) {
            let indexes = delimited(sign("["), elements, sign("]")).parse_next(input)?;
            steps.push(Step::Index(indexes));
        } else if is_next(input, &["."]) {
            sign(".").parse_next(input)?;
            steps.push(member_or_bit(input)?);
        } else {
            return Ok(Reference { root: root.text, steps, place: root.place });
        }
    }
}

fn member_or_bit<'t, 'a: 't>(input: &mut Input<'t, 'a>) -> Parsed<Step<'a>> {
    match input.peek_token() {
        Some(token) if token.lexeme == Lexeme::Name => {
            input.next_token();
            Ok(Step::Member(token.text))
        }
        Some(token) if token.lexeme == Lexeme::Number => match read_literal(token.text) {
            Ok(Literal::Integer(bit)) => {
                input.next_token();
                Ok(Step::Bit(bit))
            }
            _ => Err(Failure::expected(input, "a member or a bit")),
        },
        _ => Err(Failure::expected(input, "a member or a bit")),
    }
}

/// `(IN := x, y, Q => z)`
pub(super) fn arguments<'t, 'a: 't>(input: &mut Input<'t, 'a>) -> Parsed<Vec<Argument<'a>>> {
    sign("(").parse_next(input)?;
    let mut arguments = Vec::new();
    if is_next(input, &[")"]) {
        sign(")").parse_next(input)?;
        return Ok(arguments);
    }
    loop {
        arguments.push(deeper(input, argument)?);
        if is_next(input, &[")"]) {
            sign(")").parse_next(input)?;
            return Ok(arguments);
        }
        if !is_next(input, &[","]) {
            return Err(Failure::expected(input, ", or )"));
        }
        input.next_token();
    }
}

fn argument<'t, 'a: 't>(input: &mut Input<'t, 'a>) -> Parsed<Argument<'a>> {
    let Some(place) = input.peek_token().map(|token| token.place) else {
        return Err(Failure::expected(input, ")"));
    };
    let before = input.checkpoint();
    let mut formal = None;
    if let Ok(token) = name(input) {
        if is_next(input, &[":=", "=>"]) {
            let output = is_next(input, &["=>"]);
            input.next_token();
            formal = Some((token.text, output));
        } else {
            input.reset(&before);
        }
    }
    let value = if is_next(input, &[",", ")"]) { None } else { Some(expression(input)?) };
    let (name, output) = formal.map_or((None, false), |(name, output)| (Some(name), output));
    Ok(Argument { name, output, value, place })
}

/// `a := 5`, `fb(x)`, without what ends it.
pub(super) fn assignment_or_call<'t, 'a: 't>(input: &mut Input<'t, 'a>) -> Parsed<Statement<'a>> {
    let target = reference(input)?;
    if is_next(input, &["("]) {
        let arguments = arguments(input)?;
        return Ok(Statement::Call(Call { name: target, arguments }));
    }
    sign(":=").parse_next(input)?;
    let value = expression(input)?;
    Ok(Statement::Assignment { target, value })
}
