//! What an argument is worth, as far as it is constant.

use alloc::collections::BTreeMap;
use alloc::string::{String, ToString};
use alloc::vec::Vec;

use super::lexer::{Kind, Token};
use crate::config::read_hex;

/// A constant.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::code) enum Value {
    /// A whole number.
    Number(i64),
    /// A number with a fraction.
    Real(f64),
    /// A string.
    Text(String),
    /// Bytes, or a list of numbers that are bytes.
    Bytes(Vec<u8>),
    /// `True`, `true` …
    Bool(bool),
}

/// Constants by their names, also `Services.get_attribute_single`.
pub(in crate::code) type Names = BTreeMap<String, Value>;

/// Parentheses inside of parentheses.
const MAX_DEPTH: usize = 16;

/// Bytes of a value: several times what a message has. A longer one is made by the program.
const MAX_BYTES: usize = 2048;

/// Constants that one program may have; of more it is not known what they are.
const MAX_NAMES: usize = 4096;

/// What a name is worth from here on; `None`: the program makes it.
pub(in crate::code) fn remember(names: &mut Names, name: &str, value: Option<Value>) {
    match value {
        Some(value) if names.len() < MAX_NAMES || names.contains_key(name) => {
            names.insert(name.to_string(), value);
        }
        _ => {
            names.remove(name);
        }
    }
}

/// What stands between an opening bracket and its closing one, divided at commas; and how many tokens that is, with both
/// brackets. A bracket that nobody closes has nothing in it.
pub(in crate::code) fn groups<'t, 'a>(tokens: &'t [Token<'a>]) -> (Vec<&'t [Token<'a>]>, usize) {
    let Some(close) = tokens.first().map(|open| open.close).filter(|close| *close > 0) else {
        return (Vec::new(), 1);
    };
    let inside = tokens.get(1..close).unwrap_or_default();
    let mut groups = divided(inside, ",");
    // Nothing at all, or nothing after the last comma.
    if groups.last().is_some_and(|last| last.is_empty()) {
        groups.pop();
    }
    (groups, (close + 1).min(tokens.len()))
}

/// Divided at a sign outside of brackets.
fn divided<'t, 'a>(tokens: &'t [Token<'a>], sign: &str) -> Vec<&'t [Token<'a>]> {
    let (mut parts, mut at, mut from) = (Vec::new(), 0, 0);
    while let Some(token) = tokens.get(at) {
        if token.is(sign) {
            parts.push(tokens.get(from..at).unwrap_or_default());
            from = at + 1;
        }
        at += token.close + 1;
    }
    parts.push(tokens.get(from..).unwrap_or_default());
    parts
}

/// The worth of an argument; `None` if the program makes it.
pub(in crate::code) fn value(tokens: &[Token<'_>], names: &Names) -> Option<Value> {
    worth(tokens, names, 0)
}

fn worth(tokens: &[Token<'_>], names: &Names, depth: usize) -> Option<Value> {
    if depth > MAX_DEPTH {
        return None;
    }
    let sum = divided(tokens, "+");
    if sum.len() > 1 {
        let mut all = Vec::new();
        // A sign alone has nothing before it.
        for part in sum.into_iter().skip_while(|part| part.is_empty()) {
            let Value::Bytes(bytes) = worth(part, names, depth + 1)? else { return None };
            all.extend(bytes);
            if all.len() > MAX_BYTES {
                return None;
            }
        }
        return Some(Value::Bytes(all));
    }
    match tokens {
        [sign, rest @ ..] if sign.is("&") => worth(rest, names, depth + 1),
        [sign, rest @ ..] if sign.is("-") => match worth(rest, names, depth + 1)? {
            Value::Number(number) => Some(Value::Number(number.checked_neg()?)),
            Value::Real(number) => Some(Value::Real(-number)),
            _ => None,
        },
        [open, close] if open.is("(") && close.is(")") => Some(Value::Bytes(Vec::new())),
        [open, ..] if open.is("(") => match groups(tokens) {
            (parts, end) if parts.len() == 1 && end == tokens.len() => {
                worth(parts.first()?, names, depth + 1)
            }
            _ => None,
        },
        [open, ..] if open.is("[") => list(tokens, names, depth),
        // `vec![1, 2]`
        [name, mark, rest @ ..] if name.is("vec") && mark.is("!") => list(rest, names, depth),
        // All of it, as a slice.
        [first, open, dot, dots, close] if open.is("[") && dot.is(".") && dots.is(".") && close.is("]") => {
            worth(core::slice::from_ref(first), names, depth + 1)
        }
        [only] => match &only.kind {
            Kind::Number(number) => Some(Value::Number(*number)),
            Kind::Real(number) => Some(Value::Real(*number)),
            Kind::Text(text) if text.len() <= MAX_BYTES => Some(Value::Text(text.clone())),
            Kind::Bytes(bytes) if bytes.len() <= MAX_BYTES => Some(Value::Bytes(bytes.clone())),
            Kind::Name if matches!(only.text, "True" | "true") => Some(Value::Bool(true)),
            Kind::Name if matches!(only.text, "False" | "false") => Some(Value::Bool(false)),
            Kind::Name => names.get(only.text).cloned(),
            Kind::Text(_) | Kind::Bytes(_) | Kind::Sign => None,
        },
        _ => function(tokens, names, depth),
    }
}

/// `bytes.fromhex("0A 0B")`, `bytes([1, 2])`, `UINT.encode(5)`, `Services.reset`.
fn function(tokens: &[Token<'_>], names: &Names, depth: usize) -> Option<Value> {
    let open = tokens.iter().position(|token| token.is("("));
    let path: String = tokens.get(..open.unwrap_or(tokens.len()))?.iter().map(|token| token.text).collect();
    let Some(open) = open else { return names.get(&path).cloned() };
    let (arguments, end) = groups(tokens.get(open..)?);
    if open + end != tokens.len() {
        return None;
    }
    let argument = arguments.first().map(|argument| worth(argument, names, depth + 1));
    let (kind, method) = path.rsplit_once('.').unwrap_or(("", &path));
    match (path.as_str(), argument) {
        ("bytes" | "bytearray", None) => Some(Value::Bytes(Vec::new())),
        ("bytes" | "bytearray" | "Bytes::from_static", Some(Some(Value::Bytes(bytes)))) => {
            Some(Value::Bytes(bytes))
        }
        ("bytes.fromhex" | "bytearray.fromhex", Some(Some(Value::Text(text)))) => {
            read_hex(&text).ok().map(Value::Bytes)
        }
        (_, Some(Some(value))) if method == "encode" => encoded(kind, &value),
        _ => None,
    }
}

/// The types of pycomm3.
fn encoded(kind: &str, value: &Value) -> Option<Value> {
    let bytes = match (kind, value) {
        ("REAL", Value::Real(real)) => {
            #[expect(clippy::cast_possible_truncation, reason = "as the type does")]
            let real = *real as f32;
            real.to_le_bytes().to_vec()
        }
        ("LREAL", Value::Real(real)) => real.to_le_bytes().to_vec(),
        (_, Value::Number(number)) => match kind {
            "SINT" => i8::try_from(*number).ok()?.to_le_bytes().to_vec(),
            "USINT" | "BYTE" => u8::try_from(*number).ok()?.to_le_bytes().to_vec(),
            "INT" => i16::try_from(*number).ok()?.to_le_bytes().to_vec(),
            "UINT" | "WORD" => u16::try_from(*number).ok()?.to_le_bytes().to_vec(),
            "DINT" => i32::try_from(*number).ok()?.to_le_bytes().to_vec(),
            "UDINT" | "DWORD" => u32::try_from(*number).ok()?.to_le_bytes().to_vec(),
            "LINT" => number.to_le_bytes().to_vec(),
            _ => return None,
        },
        _ => return None,
    };
    Some(Value::Bytes(bytes))
}

/// `[1, 2]`, `[0; 3]`, perhaps as a slice.
fn list(tokens: &[Token<'_>], names: &Names, depth: usize) -> Option<Value> {
    tokens.first().filter(|open| open.close > 0)?;
    let (elements, end) = groups(tokens);
    let slice: String = tokens.get(end..)?.iter().map(|token| token.text).collect();
    if !slice.is_empty() && slice != "[..]" {
        return None;
    }
    let byte = |tokens: &[Token<'_>]| match worth(tokens, names, depth + 1)? {
        Value::Number(number) => u8::try_from(number).ok(),
        _ => None,
    };
    if let [only] = elements.as_slice()
        && let Some(at) = only.iter().position(|token| token.is(";"))
    {
        let Value::Number(count) = worth(only.get(at + 1..)?, names, depth + 1)? else { return None };
        let count = usize::try_from(count).ok().filter(|count| *count <= MAX_BYTES)?;
        return Some(Value::Bytes(alloc::vec![byte(only.get(..at)?)?; count]));
    }
    if elements.len() > MAX_BYTES {
        return None;
    }
    elements.into_iter().map(byte).collect::<Option<Vec<u8>>>().map(Value::Bytes)
}

/// A string literal that Python and Rust read alike: ASCII, everything else escaped for one of them.
pub(in crate::code) fn quoted(text: &str, escape: fn(char) -> String) -> String {
    let mut quoted = String::from("\"");
    for c in text.chars() {
        match c {
            '"' | '\\' => quoted.extend(['\\', c]),
            ' '..='~' => quoted.push(c),
            c => quoted.push_str(&escape(c)),
        }
    }
    quoted.push('"');
    quoted
}

#[cfg(test)]
mod tests {
    use super::super::lexer::{Language, tokens};
    use super::*;

    #[test]
    fn bytes_are_read_however_they_are_written() {
        let names = Names::from([("DATA".to_string(), Value::Bytes(alloc::vec![10, 11]))]);
        for text in [
            "b'\\x0a\\x0b'",
            "bytes.fromhex('0A 0b')",
            "bytes([10, 0x0B])",
            "bytearray([10]) + b'\\x0b'",
            "(b'\\n' + USINT.encode(11))",
            "UINT.encode(0x0B0A)",
            "DATA",
            "&[0x0A, 0x0B][..]",
            "&b\"\\x0a\\x0b\"[..]",
            "vec![10, 11,]",
        ] {
            let (tokens, _) = tokens(text, Language::Python);
            assert_eq!(value(&tokens, &names), Some(Value::Bytes(alloc::vec![10, 11])), "{text}");
        }
        for (text, expected) in [
            ("b''", Some(Value::Bytes(Vec::new()))),
            ("()", Some(Value::Bytes(Vec::new()))),
            ("[7; 2]", Some(Value::Bytes(alloc::vec![7, 7]))),
            ("-5", Some(Value::Number(-5))),
            ("speed", None),
            ("struct.pack('<H', 5)", None),
            ("f(1", None),
            ("[256]", None),
        ] {
            let (tokens, _) = tokens(text, Language::Python);
            assert_eq!(value(&tokens, &names), expected, "{text}");
        }
        let deep = "(".repeat(100_000);
        assert_eq!(value(&tokens(&deep, Language::Python).0, &names), None);
    }
}
