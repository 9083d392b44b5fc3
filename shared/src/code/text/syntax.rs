//! What statements are made of.

use alloc::boxed::Box;
use alloc::string::String;
use alloc::vec::Vec;
use core::fmt::Write;

use super::literal::Literal;
use super::token::Place;

/// A statement, or a declaration.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::code) enum Statement<'a> {
    /// `a, b AT %MW10 : ARRAY [0..4] OF INT := [16#0000, 2(0)];`
    Declaration(Declaration<'a>),
    /// `a.b[2] := expression;`
    Assignment {
        /// What is set.
        target: Reference<'a>,
        /// To what.
        value: Expression<'a>,
    },
    /// `fb(IN := x, Q => y);`
    Call(Call<'a>),
}

/// Variables of one type.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::code) struct Declaration<'a> {
    /// As written, with their places.
    pub(in crate::code) names: Vec<(&'a str, Place)>,
    /// `%MW10`.
    pub(in crate::code) at: Option<&'a str>,
    /// Of which type.
    pub(in crate::code) kind: Declared<'a>,
    /// The value at the start.
    pub(in crate::code) initial: Option<Expression<'a>>,
    /// `VAR CONSTANT`.
    pub(in crate::code) constant: bool,
}

/// A declared type.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::code) struct Declared<'a> {
    /// Bounds of each dimension; empty: no array.
    pub(in crate::code) bounds: Vec<(i128, i128)>,
    /// Of the element.
    pub(in crate::code) name: &'a str,
    /// `STRING[80]`, `STRING(80)`.
    pub(in crate::code) length: Option<i128>,
    /// Bounds were written `[0.3]` or `[0...3]`: a slip of printed manuals.
    pub(in crate::code) slip: Option<Place>,
}

impl Declared<'_> {
    /// Whether it is this type, in any case.
    pub(in crate::code) fn is(&self, name: &str) -> bool {
        self.name.eq_ignore_ascii_case(name)
    }

    /// How many elements it has: 1 if it is no array.
    pub(in crate::code) fn elements(&self) -> i128 {
        let of = |(low, high): &(i128, i128)| high.saturating_sub(*low).saturating_add(1);
        self.bounds.iter().map(of).fold(1, i128::saturating_mul)
    }
}

/// A call of a block or a function.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::code) struct Call<'a> {
    /// The instance or the function.
    pub(in crate::code) name: Reference<'a>,
    /// In their order.
    pub(in crate::code) arguments: Vec<Argument<'a>>,
}

/// `IN := x`, `Q => y`, or `x`.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::code) struct Argument<'a> {
    /// Of a formal argument.
    pub(in crate::code) name: Option<&'a str>,
    /// `=>`.
    pub(in crate::code) output: bool,
    /// What is given; `None`: left out, as in `f(a, , b)` or `Q => `.
    pub(in crate::code) value: Option<Expression<'a>>,
    /// Where it begins.
    pub(in crate::code) place: Place,
}

impl<'a> Call<'a> {
    /// Whether this is called, in any case.
    pub(in crate::code) fn is(&self, name: &str) -> bool {
        self.name.steps.is_empty() && self.name.root.eq_ignore_ascii_case(name)
    }

    /// By its name if the call is formal, else by its position from 0.
    pub(in crate::code) fn argument(&self, position: usize, name: &str) -> Option<&Argument<'a>> {
        let named = |argument: &&Argument<'a>| argument.name.is_some_and(|n| n.eq_ignore_ascii_case(name));
        self.arguments
            .iter()
            .find(named)
            .or_else(|| self.arguments.get(position).filter(|argument| argument.name.is_none()))
    }
}

/// `a.b[2].0`, `%MW10`.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::code) struct Reference<'a> {
    /// As written.
    pub(in crate::code) root: &'a str,
    /// What follows.
    pub(in crate::code) steps: Vec<Step<'a>>,
    /// Where it begins.
    pub(in crate::code) place: Place,
}

/// A part of a reference.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::code) enum Step<'a> {
    /// `.b`
    Member(&'a str),
    /// `[2]`, `[i, 3]`
    Index(Vec<Expression<'a>>),
    /// `.0`: a bit.
    Bit(i128),
}

impl Reference<'_> {
    /// `a.b[2]` in lower case; `None` if an index is not constant.
    pub(in crate::code) fn key(&self) -> Option<String> {
        let mut key = self.root.to_ascii_lowercase();
        for step in &self.steps {
            match step {
                Step::Member(name) => {
                    key.push('.');
                    key.push_str(&name.to_ascii_lowercase());
                }
                Step::Bit(bit) => {
                    let _ = write!(key, ".{bit}");
                }
                Step::Index(indexes) => {
                    for (n, index) in indexes.iter().enumerate() {
                        let _ = write!(key, "{}{}", if n == 0 { '[' } else { ',' }, index.integer()?);
                    }
                    key.push(']');
                }
            }
        }
        Some(key)
    }
}

/// Something with a value.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::code) enum Expression<'a> {
    /// A constant.
    Literal(Literal, Place),
    /// A variable.
    Reference(Reference<'a>),
    /// `ADDR('…')`
    Call(Box<Call<'a>>),
    /// `[1, 2(0)]`, or `1, 2` where an initial value stands without brackets.
    List(Vec<Self>, Place),
    /// `2(0)`, `2(1, 2)`
    Repeated(i128, Vec<Self>, Place),
    /// `(Service := 14, Class := 1)`
    Structure(Vec<(&'a str, Self)>, Place),
    /// `-x`, `NOT x`
    Unary(&'a str, Box<Self>, Place),
    /// `x + y * z`, flat: a long one nests no deeper than a short one. One operator less than operands.
    Chain(Vec<Self>, Vec<&'a str>, Place),
}

impl<'a> Expression<'a> {
    /// Where it begins.
    pub(in crate::code) fn place(&self) -> Place {
        match self {
            Self::Literal(_, place)
            | Self::List(_, place)
            | Self::Repeated(_, _, place)
            | Self::Structure(_, place)
            | Self::Unary(_, _, place)
            | Self::Chain(_, _, place) => *place,
            Self::Reference(reference) => reference.place,
            Self::Call(call) => call.name.place,
        }
    }

    /// The variable, if it is one.
    pub(in crate::code) const fn reference(&self) -> Option<&Reference<'a>> {
        match self {
            Self::Reference(reference) => Some(reference),
            _ => None,
        }
    }

    /// The text, if it is one.
    pub(in crate::code) fn text(&self) -> Option<&str> {
        match self {
            Self::Literal(Literal::Text(text), _) => Some(text),
            _ => None,
        }
    }
}
