//! Tokens → expressions, declarations and calls.
//!
//! Each parser looks at one token and knows what to do; none goes back further than that.

use alloc::boxed::Box;
use alloc::string::ToString;
use alloc::vec;
use alloc::vec::Vec;

use winnow::Parser;
use winnow::combinator::{delimited, opt, preceded, separated, terminated};
use winnow::error::ParserError;
use winnow::stream::{Stateful, Stream, TokenSlice};

use super::literal::{Literal, read_literal};
use super::syntax::{Argument, Call, Declaration, Declared, Expression, Reference, Statement, Step};
use super::token::{Lexeme, Place, Token};
use crate::code::remark::RemarkKind;

/// Brackets inside of brackets.
const MAX_DEPTH: usize = 48;

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

type Parsed<T> = Result<T, Failure>;

impl Failure {
    pub(super) fn new(input: &Input<'_, '_>, what: RemarkKind) -> Self {
        Self { left: input.eof_offset(), what }
    }

    fn expected(input: &Input<'_, '_>, what: &str) -> Self {
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
fn deeper<'t, 'a: 't, T>(
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
