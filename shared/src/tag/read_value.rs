//! Values as people type them: `12.5`, `0x1F`, `16#1F`, `TRUE`, `"text"`, `[1, 2, 3]`, `{speed: 1.5, run: TRUE}`.

use alloc::borrow::ToOwned;
use alloc::string::{String, ToString};
use alloc::vec::Vec;

use super::elementary::{Elementary, Form};
use super::kind::Type;
use super::value::{Value, ValueError};
use crate::config::read_number;

impl Type {
    /// Reads a value of this type. Nothing is rounded into its range.
    pub fn parse_value(&self, text: &str) -> Result<Value, ValueError> {
        let text = text.trim();
        match self {
            Self::Elementary(kind) => elementary(*kind, text),
            Self::String(_) => characters(text).map(Value::Text),
            Self::Array(element, dimensions) => {
                let parts =
                    within(text, '[', ']').ok_or_else(|| unreadable(text, "list", "write [1, 2, 3]"))?;
                let values: Vec<_> =
                    parts.iter().map(|part| element.parse_value(part)).collect::<Result<_, _>>()?;
                let (needed, found) = (dimensions.count(), values.len());
                if needed != found {
                    return Err(ValueError::Count { needed, found });
                }
                Ok(Value::List(values))
            }
            Self::Structure(structure) => {
                let how = "write {name: value, name: value}";
                let parts = within(text, '{', '}').ok_or_else(|| unreadable(text, "structure", how))?;
                let mut members = Vec::with_capacity(parts.len());
                for part in parts {
                    let (name, value) =
                        part.split_once(':').ok_or_else(|| unreadable(part, "member", how))?;
                    let name = name.trim();
                    let unknown = || ValueError::Member(name.to_owned(), "is not in the structure");
                    let member = structure.member(name).ok_or_else(unknown)?;
                    members.push((member.name.clone(), member.kind.parse_value(value)?));
                }
                Ok(Value::Members(members))
            }
        }
    }

    /// A value from JSON, as [`Value::to_json`] writes it.
    pub fn value_of_json(&self, json: &serde_json::Value) -> Result<Value, ValueError> {
        use serde_json::Value as Json;
        match (self, json) {
            (Self::Array(element, dimensions), Json::Array(parts)) => {
                let values: Vec<_> =
                    parts.iter().map(|part| element.value_of_json(part)).collect::<Result<_, _>>()?;
                let (needed, found) = (dimensions.count(), values.len());
                if needed == found {
                    Ok(Value::List(values))
                } else {
                    Err(ValueError::Count { needed, found })
                }
            }
            (Self::Structure(structure), Json::Object(parts)) => {
                let each = |(name, part): (&String, &Json)| {
                    let unknown = || ValueError::Member(name.clone(), "is not in the structure");
                    let member = structure.member(name).ok_or_else(unknown)?;
                    Ok((member.name.clone(), member.kind.value_of_json(part)?))
                };
                let mut members = parts.iter().map(each).collect::<Result<Vec<_>, _>>()?;
                // JSON objects have no order.
                members.sort_by_key(|(name, _)| {
                    structure.members.iter().position(|member| member.name == *name)
                });
                Ok(Value::Members(members))
            }
            (Self::String(_), Json::String(text)) => Ok(Value::Text(text.clone().into_bytes())),
            (Self::Elementary(_), Json::String(text)) => self.parse_value(text),
            (Self::Elementary(_), Json::Number(_) | Json::Bool(_)) => self.parse_value(&json.to_string()),
            _ => Err(ValueError::Kind { what: self.to_string(), found: json.to_string() }),
        }
    }
}

fn elementary(kind: Elementary, text: &str) -> Result<Value, ValueError> {
    match kind.form() {
        Form::Bool => match text.to_ascii_uppercase().as_str() {
            "TRUE" | "1" => Ok(Value::Bool(true)),
            "FALSE" | "0" => Ok(Value::Bool(false)),
            _ => Err(unreadable(text, kind.name(), "write TRUE or FALSE")),
        },
        Form::Float => float(kind, text),
        Form::Signed => {
            let number =
                read_number(text).map_err(|error| unreadable(text, kind.name(), &error.to_string()))?;
            let size = usize::from(kind.bits().unwrap_or(64)) / 8;
            let max = i64::try_from(kind.max(size)).unwrap_or(i64::MAX);
            if number > max || number < -max - 1 {
                return Err(kind.outside(size, &text));
            }
            Ok(Value::Signed(number))
        }
        Form::Unsigned | Form::Bits | Form::Bcd => {
            let number = unsigned(text).map_err(|why| unreadable(text, kind.name(), &why))?;
            let size = kind.size(super::Dialect::Logix);
            match number.filter(|number| *number <= kind.max(size)) {
                Some(number) => Ok(Value::Unsigned(number)),
                None => Err(kind.outside(size, &text)),
            }
        }
    }
}

/// `None` is below 0, or over 64 bits.
fn unsigned(text: &str) -> Result<Option<u64>, String> {
    match read_number(text) {
        Ok(number) => Ok(u64::try_from(number).ok()),
        Err(crate::config::NumberError::TooBig) => {
            let lower = text.trim().to_ascii_lowercase().replace('_', "");
            let digits = lower.strip_prefix("0x").or_else(|| lower.strip_prefix("16#"));
            let digits = digits.or_else(|| lower.strip_suffix('h'));
            Ok(digits.map_or_else(|| lower.parse().ok(), |digits| u64::from_str_radix(digits, 16).ok()))
        }
        Err(error) => Err(error.to_string()),
    }
}

fn float(kind: Elementary, text: &str) -> Result<Value, ValueError> {
    let refuse = |why| unreadable(text, kind.name(), why);
    let plain = text.bytes().all(|byte| byte.is_ascii_digit() || b"+-.eE_".contains(&byte));
    if !plain || text.is_empty() {
        let why = if text.contains(',') { "write a point, not a comma" } else { "write 12.5 or 1.25e1" };
        return Err(refuse(why));
    }
    let digits = text.replace('_', "");
    let number: f64 = digits.parse().map_err(|_| refuse("write 12.5 or 1.25e1"))?;
    let outside = |max: &str| ValueError::Range {
        text: text.to_owned(),
        what: kind.name(),
        min: alloc::format!("-{max}"),
        max: max.to_owned(),
    };
    if kind == Elementary::Lreal {
        return if number.is_finite() {
            Ok(Value::Lreal(number))
        } else {
            Err(outside("1.7976931348623157e308"))
        };
    }
    // From the digits, not from the rounded double.
    let single: f32 = digits.parse().map_err(|_| refuse("write 12.5 or 1.25e1"))?;
    if single.is_finite() { Ok(Value::Real(single)) } else { Err(outside("3.4028235e38")) }
}

/// The bytes of a text: as it is, or in quotation marks with `\"`, `\\` and `\xNN`.
fn characters(text: &str) -> Result<Vec<u8>, ValueError> {
    let Some(inside) = text.strip_prefix('"') else { return Ok(text.as_bytes().to_vec()) };
    let wrong = |why| unreadable(text, "text", why);
    let inside = inside.strip_suffix('"').ok_or_else(|| wrong("the closing quotation mark is missing"))?;
    let mut out = Vec::new();
    let mut rest = inside;
    while let Some((plain, escaped)) = rest.split_once('\\') {
        out.extend_from_slice(plain.as_bytes());
        let mut signs = escaped.chars();
        match signs.next() {
            Some(sign @ ('"' | '\\')) => out.push(u8::try_from(sign).unwrap_or(b'?')),
            Some('x') => {
                let digits = escaped.get(1..3).and_then(|digits| u8::from_str_radix(digits, 16).ok());
                out.push(digits.ok_or_else(|| wrong("\\x takes two hexadecimal digits"))?);
                rest = escaped.get(3..).unwrap_or_default();
                continue;
            }
            _ => return Err(wrong("a backslash takes \", \\ or xNN")),
        }
        rest = signs.as_str();
    }
    out.extend_from_slice(rest.as_bytes());
    Ok(out)
}

/// What lies between the brackets, split at commas that are inside of nothing.
fn within(text: &str, open: char, close: char) -> Option<Vec<&str>> {
    let inside = text.strip_prefix(open)?.strip_suffix(close)?.trim();
    let (mut parts, mut depth, mut quoted, mut escaped, mut from) = (Vec::new(), 0_usize, false, false, 0);
    for (at, sign) in inside.char_indices() {
        match sign {
            _ if escaped => escaped = false,
            '\\' if quoted => escaped = true,
            '"' => quoted = !quoted,
            '[' | '{' if !quoted => depth += 1,
            ']' | '}' if !quoted => depth = depth.checked_sub(1)?,
            ',' if !quoted && depth == 0 => {
                parts.push(inside.get(from..at)?.trim());
                from = at + 1;
            }
            _ => {}
        }
    }
    let last = inside.get(from..)?.trim();
    if !(parts.is_empty() && last.is_empty()) {
        parts.push(last);
    }
    (depth == 0 && !quoted).then_some(parts)
}

fn unreadable(text: &str, what: &'static str, why: &str) -> ValueError {
    ValueError::Unreadable { text: text.to_owned(), what, why: why.to_owned() }
}
