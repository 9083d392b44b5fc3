//! What an expression is worth, as far as that does not depend on the program.

use alloc::vec;
use alloc::vec::Vec;

use super::literal::{Literal, SIZES};
use super::memory::Memory;
use super::syntax::{Call, Expression};

/// Variables that stand for each other.
const MAX_HOPS: usize = 8;

/// Values that one calculation looks at.
const MAX_WORK: u32 = 10_000;

impl Expression<'_> {
    /// A whole number, without looking at variables.
    pub(in crate::code) fn integer(&self) -> Option<i128> {
        Work { memory: None, left: MAX_WORK }.integer(self, 0).filter(|value| SIZES.contains(value))
    }

    /// A whole number; variables are what they hold.
    pub(in crate::code) fn integer_in(&self, memory: &Memory<'_, '_>) -> Option<i128> {
        Work { memory: Some(memory), left: MAX_WORK }.integer(self, 0).filter(|value| SIZES.contains(value))
    }

    /// TRUE or FALSE, also 1 or 0; variables are what they hold.
    pub(in crate::code) fn truth_in(&self, memory: &Memory<'_, '_>) -> Option<bool> {
        match self {
            Self::Literal(Literal::Bool(value), _) => Some(*value),
            Self::Unary(operator, inside, _) if operator.eq_ignore_ascii_case("NOT") => {
                inside.truth_in(memory).map(|value| !value)
            }
            Self::Reference(reference) => memory.value(&reference.key()?)?.truth_literal(),
            _ => self.truth_literal(),
        }
    }

    fn truth_literal(&self) -> Option<bool> {
        match (self, self.integer()) {
            (Self::Literal(Literal::Bool(value), _), _) => Some(*value),
            (_, Some(0)) => Some(false),
            (_, Some(1)) => Some(true),
            _ => None,
        }
    }
}

/// One calculation.
struct Work<'m, 's, 'a> {
    memory: Option<&'m Memory<'s, 'a>>,
    left: u32,
}

impl Work<'_, '_, '_> {
    fn integer(&mut self, expression: &Expression<'_>, hops: usize) -> Option<i128> {
        self.left = self.left.checked_sub(1)?;
        if self.memory.is_some_and(|memory| !memory.look()) {
            return None;
        }
        match expression {
            Expression::Literal(Literal::Integer(value), _) => Some(*value),
            Expression::Literal(Literal::Bool(value), _) => Some(i128::from(*value)),
            Expression::Reference(reference) if hops < MAX_HOPS => {
                let value = self.memory?.value(&reference.key()?)?;
                self.integer(value, hops + 1)
            }
            Expression::Unary(operator, inside, _) => {
                let value = self.integer(inside, hops)?;
                match *operator {
                    "-" => value.checked_neg(),
                    "+" => Some(value),
                    _ => None,
                }
            }
            Expression::Chain(operands, operators, _) => {
                let values: Option<Vec<i128>> =
                    operands.iter().map(|operand| self.integer(operand, hops)).collect();
                chain(values?, operators)
            }
            Expression::Call(call) => self.function(call, hops),
            _ => None,
        }
    }

    /// The functions that take numbers apart: shifts, bits, and conversions that change no value.
    fn function(&mut self, call: &Call<'_>, hops: usize) -> Option<i128> {
        if !call.name.steps.is_empty() || call.arguments.len() > 2 {
            return None;
        }
        let values: Option<Vec<i128>> = call
            .arguments
            .iter()
            .map(|argument| argument.value.as_ref().and_then(|value| self.integer(value, hops)))
            .collect();
        let name = call.name.root.to_ascii_uppercase();
        let values = values?;
        match (name.as_str(), values.as_slice()) {
            ("AND_MASK", [value, mask]) => Some(value & mask),
            ("OR_MASK", [value, mask]) => Some(value | mask),
            ("SHR", [value, bits]) => value.checked_shr(u32::try_from(*bits).ok()?),
            ("SHL", [value @ 0..=0xFFFF_FFFF, bits @ 0..=32]) => Some(value << bits),
            ("MOD", [value, by]) => value.checked_rem(*by),
            (name, [value]) => {
                let bits = match name.split_once("_TO_")?.1 {
                    "SINT" | "USINT" | "BYTE" => 8,
                    "INT" | "UINT" | "WORD" => 16,
                    "DINT" | "UDINT" | "DWORD" => 32,
                    "LINT" | "ULINT" | "LWORD" => 64,
                    _ => return None,
                };
                let signed = name.ends_with("_SINT")
                    || name.ends_with("_INT")
                    || name.ends_with("_DINT")
                    || name.ends_with("_LINT");
                let (low, high) = if signed {
                    (-(1_i128 << (bits - 1)), 1_i128 << (bits - 1))
                } else {
                    (0, 1_i128 << bits)
                };
                (low..high).contains(value).then_some(*value)
            }
            _ => None,
        }
    }
}

/// Multiplications before additions before bits; all from left to right.
fn chain(values: Vec<i128>, operators: &[&str]) -> Option<i128> {
    let mut values = values;
    let mut operators: Vec<&str> = operators.to_vec();
    for level in [&["**"][..], &["*", "/", "MOD"], &["+", "-"], &["AND", "&"], &["XOR"], &["OR"]] {
        let mut rest = values.into_iter();
        let mut kept = vec![rest.next()?];
        let mut waiting = Vec::new();
        for (operator, value) in operators.iter().zip(rest) {
            if level.iter().any(|known| operator.eq_ignore_ascii_case(known)) {
                let left = kept.pop()?;
                kept.push(calculate(left, operator, value)?);
            } else {
                kept.push(value);
                waiting.push(*operator);
            }
        }
        (values, operators) = (kept, waiting);
    }
    if operators.is_empty() { values.pop() } else { None }
}

fn calculate(left: i128, operator: &str, right: i128) -> Option<i128> {
    match operator.to_ascii_uppercase().as_str() {
        "**" => left.checked_pow(u32::try_from(right).ok()?),
        "*" => left.checked_mul(right),
        "/" => left.checked_div(right),
        "MOD" => left.checked_rem(right),
        "+" => left.checked_add(right),
        "-" => left.checked_sub(right),
        "AND" | "&" => Some(left & right),
        "XOR" => Some(left ^ right),
        "OR" => Some(left | right),
        _ => None,
    }
}
