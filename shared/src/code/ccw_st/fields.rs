//! Typed variables into bytes, and bytes into typed variables.
//!
//! Whole numbers by arithmetic, low byte first; what arithmetic cannot take apart (REAL, LREAL, 64 bits) by `COP`, a
//! function block (2080-RM001D p. 304) that counts elements of its destination.

use alloc::collections::BTreeSet;
use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;

use crate::code::header::line;
use crate::code::name::identifier;
use crate::code::text::quoted;
use crate::tag::{DataField, DataFields, Elementary, FieldKind, Form, Value};

/// How a field gets into the bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Way {
    /// Statements that anybody can follow.
    Arithmetic,
    /// The copy block.
    Copy,
}

struct Field {
    variable: String,
    kind: &'static str,
    from: usize,
    size: usize,
    way: Way,
    /// The value at the start.
    initial: Option<String>,
}

/// The fields of a layout, each with its variable.
pub(super) struct Fields(Vec<Field>);

impl Fields {
    /// Of a layout. Fields that the data does not hold, and those that have no type or no constant on a Micro800, stay
    /// bytes.
    pub(super) fn of(layout: &str, data: Option<&[u8]>, name: &str) -> Self {
        let fields = DataFields::read(layout);
        let fields = fields.as_ref().map_or(&[][..], |fields| fields.each());
        let mut names = BTreeSet::new();
        let fields = fields.iter().filter_map(|field| {
            let (kind, way) = micro800(field.kind)?;
            let size = field.to(&[]) - field.from;
            if data.is_some_and(|data| data.len() < field.from + size) {
                return None;
            }
            // A variable without its value would be packed over the bytes: no infinity becomes 0 in silence.
            let initial = match data {
                Some(data) => Some(initial(field, data)?),
                None => None,
            };
            let direction = if data.is_some() { "req" } else { "res" };
            let inner = if field.name.is_empty() { "value".into() } else { identifier(&field.name) };
            let mut variable = format!("{name}_{direction}_{inner}");
            for number in 2.. {
                if names.insert(variable.to_ascii_lowercase()) {
                    break;
                }
                variable = format!("{name}_{direction}_{inner}_{number}");
            }
            Some(Field { variable, kind, from: field.from, size, way, initial })
        });
        Self(fields.collect())
    }

    pub(super) const fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Whether a copy block is needed.
    pub(super) fn copies(&self) -> bool {
        self.0.iter().any(|field| field.way == Way::Copy)
    }

    /// How the byte gets its value; `None`: no field has it.
    pub(super) fn way(&self, byte: usize) -> Option<Way> {
        let of = |field: &&Field| (field.from..field.from + field.size).contains(&byte);
        self.0.iter().find(of).map(|field| field.way)
    }

    pub(super) fn declare(&self, out: &mut String) {
        for field in &self.0 {
            let initial = field.initial.as_ref().map_or_else(String::new, |value| format!(" := {value}"));
            line(out, &format!("    {} : {}{initial};", field.variable, field.kind));
            if field.needs_sign() && field.initial.is_none() {
                line(out, &format!("    {}_high : DINT;", field.variable));
            }
        }
    }

    /// Variables of a message into its array, whose first element has number 1.
    pub(super) fn pack(&self, message: &str, array: &str, out: &mut String) {
        for field in &self.0 {
            let (variable, from) = (&field.variable, field.from + 1);
            match field.way {
                Way::Copy => {
                    let bytes = format!("{}, {}", field.from, field.size);
                    line(out, &format!("{message}_Copy(TRUE, {variable}, 0, {array}, {bytes}, FALSE);"));
                }
                Way::Arithmetic if field.kind == "BOOL" => {
                    line(out, &format!("{array}[{from}] := ANY_TO_USINT({variable});"));
                }
                Way::Arithmetic => {
                    for at in 0..field.size {
                        line(out, &format!("{array}[{}] := {};", from + at, field.byte(at)));
                    }
                }
            }
        }
    }

    /// The array of a message into its variables.
    pub(super) fn unpack(&self, message: &str, array: &str, out: &mut String) {
        for field in &self.0 {
            let (variable, kind, from) = (&field.variable, field.kind, field.from + 1);
            let bytes = |count: usize, kind: &str| {
                let byte = |at: usize| {
                    let factor =
                        if at == 0 { String::new() } else { format!(" * {kind}#{}", 1_u64 << (8 * at)) };
                    format!("ANY_TO_{kind}({array}[{}]){factor}", from + at)
                };
                (0..count).map(byte).collect::<Vec<_>>().join(" + ")
            };
            match field.way {
                Way::Copy => {
                    let from = field.from;
                    line(
                        out,
                        &format!("    {message}_Copy(TRUE, {array}, {from}, {variable}, 0, 1, FALSE);"),
                    );
                }
                Way::Arithmetic if kind == "BOOL" => {
                    line(out, &format!("    {variable} := {array}[{from}] <> USINT#0;"));
                }
                Way::Arithmetic if field.needs_sign() => {
                    // The highest byte has the sign.
                    let last = field.size - 1;
                    line(out, &format!("    {variable}_high := ANY_TO_DINT({array}[{}]);", from + last));
                    line(out, &format!("    IF {variable}_high > 127 THEN"));
                    line(out, &format!("        {variable}_high := {variable}_high - 256;"));
                    line(out, "    END_IF;");
                    let low = if last == 0 { String::new() } else { format!("{} + ", bytes(last, "DINT")) };
                    let factor = 1_u64 << (8 * last);
                    line(out, &format!("    {variable} := ANY_TO_{kind}({low}{variable}_high * {factor});"));
                }
                Way::Arithmetic => line(out, &format!("    {variable} := {};", bytes(field.size, kind))),
            }
        }
    }
}

impl Field {
    fn needs_sign(&self) -> bool {
        matches!(self.kind, "SINT" | "INT" | "DINT")
    }

    /// One byte of the variable. Unsigned numbers by division, so that no number is too large for a function; signed
    /// ones by masks, in two's complement.
    fn byte(&self, at: usize) -> String {
        let (variable, kind) = (&self.variable, self.kind);
        if self.needs_sign() {
            let shifted = match at {
                0 => format!("ANY_TO_DINT({variable})"),
                _ => format!("SHR(ANY_TO_DINT({variable}), {})", 8 * at),
            };
            return format!("ANY_TO_USINT(AND_MASK({shifted}, 255))");
        }
        if self.size == 1 {
            return variable.clone();
        }
        let quotient = |shift: usize| match shift {
            0 => variable.clone(),
            _ => format!("{variable} / {kind}#{}", 1_u64 << (8 * shift)),
        };
        if at + 1 == self.size {
            return format!("ANY_TO_USINT({})", quotient(at));
        }
        format!("ANY_TO_USINT({} - {} * {kind}#256)", quotient(at), format_args!("({})", quotient(at + 1)))
    }
}

/// The type of the variable. Bits are kept in numbers, with which arithmetic is possible.
fn micro800(kind: FieldKind) -> Option<(&'static str, Way)> {
    let FieldKind::Number(kind) = kind else { return None };
    Some(match kind {
        Elementary::Bool => ("BOOL", Way::Arithmetic),
        Elementary::Sint => ("SINT", Way::Arithmetic),
        Elementary::Int | Elementary::Itime => ("INT", Way::Arithmetic),
        Elementary::Dint | Elementary::Stime | Elementary::Ftime | Elementary::Time => {
            ("DINT", Way::Arithmetic)
        }
        Elementary::Usint | Elementary::Byte => ("USINT", Way::Arithmetic),
        Elementary::Uint | Elementary::Word | Elementary::Date => ("UINT", Way::Arithmetic),
        Elementary::Udint | Elementary::Dword | Elementary::TimeOfDay => ("UDINT", Way::Arithmetic),
        Elementary::Lint | Elementary::Ltime => ("LINT", Way::Copy),
        Elementary::Ulint | Elementary::Lword => ("ULINT", Way::Copy),
        Elementary::Real => ("REAL", Way::Copy),
        Elementary::Lreal => ("LREAL", Way::Copy),
        _ => return None,
    })
}

fn initial(field: &DataField, data: &[u8]) -> Option<String> {
    let FieldKind::Number(kind) = field.kind else { return None };
    Some(match (field.value(data)?, kind.form()) {
        (Value::Bool(value), _) => {
            // A BOOL is any byte that is not 0: one that is neither 0 nor 1 stays a byte.
            data.get(field.from).filter(|byte| **byte <= 1)?;
            if value { "TRUE".into() } else { "FALSE".into() }
        }
        (Value::Text(text), _) => quoted(&String::from_utf8_lossy(&text)),
        (value, Form::Float) => {
            let text = value.to_string();
            let finite = text.chars().all(|c| c.is_ascii_digit() || "+-.eE".contains(c));
            if !finite {
                return None;
            }
            if text.contains(['.', 'e', 'E']) { text } else { format!("{text}.0") }
        }
        (value, _) => value.to_string(),
    })
}
