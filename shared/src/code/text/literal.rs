//! What a literal is worth.

use alloc::string::{String, ToString};

use crate::code::remark::RemarkKind;

/// The whole numbers of controllers: 64 bits, with a sign or without.
pub(super) const SIZES: core::ops::Range<i128> = -(1 << 63)..1 << 64;

/// A constant as it is written.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::code) enum Literal {
    /// Any whole number, whatever its radix and type.
    Integer(i128),
    /// With a fraction.
    Real(f64),
    /// `TRUE`, `FALSE`, `BOOL#1`.
    Bool(bool),
    /// Without its quotes and escapes.
    Text(String),
    /// `T#3s`, in µs.
    Time(i128),
}

/// Reads a token that is a number or a text.
pub(in crate::code) fn read_literal(text: &str) -> Result<Literal, RemarkKind> {
    if text.starts_with(['\'', '"', '‘', '’', '“', '”']) {
        return read_text(text).map(Literal::Text);
    }
    let (kind, value) = split_type(text);
    match kind.to_ascii_uppercase().as_str() {
        "" => {}
        "T" | "TIME" | "LT" | "LTIME" => return read_time(value).map(Literal::Time),
        "BOOL" => return read_bool(value),
        kind => {
            let literal = read_plain(value)?;
            return match (&literal, range(kind)) {
                (Literal::Integer(value), Some((low, high))) if !(low..=high).contains(value) => {
                    Err(RemarkKind::told(&alloc::format!("{value} is no {kind}: it is {low} to {high}")))
                }
                (_, Some(_)) => Ok(literal),
                (_, None) if matches!(kind, "REAL" | "LREAL") => Ok(literal),
                (_, None) => Err(RemarkKind::told(&alloc::format!("{kind} is no type of a number"))),
            };
        }
    }
    read_plain(value)
}

/// `USINT#16#0E` is `USINT` and `16#0E`; a radix is no type.
fn split_type(text: &str) -> (&str, &str) {
    match text.split_once('#') {
        Some((kind, value)) if !kind.starts_with(|c: char| c.is_ascii_digit()) => (kind, value),
        _ => ("", text),
    }
}

/// Of the whole-number types. Bit strings take what their width takes.
fn range(kind: &str) -> Option<(i128, i128)> {
    let (signed, bits) = match kind {
        "SINT" => (true, 8),
        "USINT" | "BYTE" => (false, 8),
        "INT" => (true, 16),
        "UINT" | "WORD" => (false, 16),
        "DINT" => (true, 32),
        "UDINT" | "DWORD" => (false, 32),
        "LINT" => (true, 64),
        "ULINT" | "LWORD" => (false, 64),
        _ => return None,
    };
    Some(if signed { (-(1_i128 << (bits - 1)), (1 << (bits - 1)) - 1) } else { (0, (1 << bits) - 1) })
}

fn read_bool(value: &str) -> Result<Literal, RemarkKind> {
    match value.to_ascii_uppercase().as_str() {
        "1" | "TRUE" => Ok(Literal::Bool(true)),
        "0" | "FALSE" => Ok(Literal::Bool(false)),
        _ => Err(RemarkKind::Expected("TRUE or FALSE".to_string())),
    }
}

fn read_plain(text: &str) -> Result<Literal, RemarkKind> {
    let (sign, magnitude) = match text.strip_prefix('-') {
        Some(magnitude) => (-1, magnitude),
        None => (1, text.strip_prefix('+').unwrap_or(text)),
    };
    let unreadable = || RemarkKind::Expected("a number such as 14, 16#0E or 2#1110".to_string());
    let digits = magnitude.replace('_', "");
    let lower = digits.to_ascii_lowercase();
    let (radix, digits) = match (lower.split_once('#'), lower.strip_prefix("0x")) {
        (Some((radix, digits)), _) => (radix.parse().map_err(|_| unreadable())?, digits),
        (None, Some(digits)) => (16, digits),
        (None, None) => match lower.strip_suffix('h') {
            Some(digits) => (16, digits),
            None => (10, lower.as_str()),
        },
    };
    if !matches!(radix, 2 | 8 | 10 | 16) || !digits.starts_with(|c: char| c.is_ascii_hexdigit()) {
        return Err(unreadable());
    }
    if radix == 10 && digits.contains(['.', 'e']) {
        let value: f64 = digits.parse().map_err(|_| unreadable())?;
        return Ok(Literal::Real(if sign < 0 { -value } else { value }));
    }
    let value = i128::from_str_radix(digits, radix).map(|value| sign * value).ok();
    let fits = value.filter(|value| SIZES.contains(value));
    fits.map(Literal::Integer).ok_or_else(|| RemarkKind::Expected("a number of at most 64 bits".to_string()))
}

/// `3s`, `1m_30s`, `2.5s`: µs.
fn read_time(text: &str) -> Result<i128, RemarkKind> {
    let unreadable = || RemarkKind::Expected("a time such as T#3s or T#500ms".to_string());
    let (sign, magnitude) = match text.strip_prefix('-') {
        Some(magnitude) => (-1, magnitude),
        None => (1, text.strip_prefix('+').unwrap_or(text)),
    };
    let lower = magnitude.replace('_', "").to_ascii_lowercase();
    let mut rest = lower.as_str();
    let mut sum = 0_i128;
    while !rest.is_empty() {
        let end = rest.find(|c: char| c.is_ascii_alphabetic()).ok_or_else(unreadable)?;
        let (number, after) = rest.split_at_checked(end).ok_or_else(unreadable)?;
        let end = after.find(|c: char| !c.is_ascii_alphabetic()).unwrap_or(after.len());
        let (unit, after) = after.split_at_checked(end).ok_or_else(unreadable)?;
        let unit: i128 = match unit {
            "d" => 86_400_000_000,
            "h" => 3_600_000_000,
            "m" => 60_000_000,
            "s" => 1_000_000,
            "ms" => 1_000,
            "us" => 1,
            _ => return Err(unreadable()),
        };
        sum = sum.checked_add(parts(number, unit).ok_or_else(unreadable)?).ok_or_else(unreadable)?;
        rest = after;
    }
    if lower.is_empty() { Err(unreadable()) } else { Ok(sign * sum) }
}

/// `2.5` of a unit, exact to the µs.
fn parts(number: &str, unit: i128) -> Option<i128> {
    let (whole, fraction) = number.split_once('.').unwrap_or((number, "0"));
    if fraction.len() > 12 {
        return None;
    }
    let whole: i128 = whole.parse::<u64>().ok()?.into();
    let scale = 10_i128.checked_pow(u32::try_from(fraction.len()).ok()?)?;
    let fraction: i128 = fraction.parse::<u64>().ok()?.into();
    let small = fraction.checked_mul(unit)?;
    (small % scale == 0).then_some(())?;
    whole.checked_mul(unit)?.checked_add(small / scale)
}

/// `$'`, `$$`, `$L` and their relatives, `$C3`.
fn read_text(text: &str) -> Result<String, RemarkKind> {
    let mut inside = text.chars();
    let open = inside.next();
    inside.next_back();
    let mut read = String::new();
    let wide = open == Some('"');
    while let Some(c) = inside.next() {
        if c != '$' {
            read.push(c);
            continue;
        }
        let escaped = inside.next().unwrap_or('$');
        read.push(match escaped.to_ascii_uppercase() {
            '$' | '\'' | '"' => escaped,
            'L' | 'N' => '\n',
            'P' => '\u{c}',
            'R' => '\r',
            'T' => '\t',
            first if first.is_ascii_hexdigit() => {
                let digits = if wide && inside.as_str().len() >= 3 { 3 } else { 1 };
                let mut code = first.to_digit(16).unwrap_or_default();
                for _ in 0..digits {
                    let digit = inside.next().and_then(|c| c.to_digit(16));
                    code = code * 16
                        + digit.ok_or_else(|| RemarkKind::Expected("a character such as $0D".into()))?;
                }
                char::from_u32(code).unwrap_or('\u{fffd}')
            }
            _ => return Err(RemarkKind::Expected("a character such as $' or $0D".into())),
        });
    }
    Ok(read)
}

/// A text in single quotes: nothing of it ends them.
pub(in crate::code) fn quoted(text: &str) -> String {
    let mut quoted = String::from("'");
    for c in text.chars() {
        match c {
            '$' | '\'' => quoted.extend(['$', c]),
            '\n' => quoted.push_str("$L"),
            '\r' => quoted.push_str("$R"),
            '\t' => quoted.push_str("$T"),
            c if c.is_control() => quoted.push('?'),
            c => quoted.push(c),
        }
    }
    quoted.push('\'');
    quoted
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_spelling_of_14_is_14() {
        for text in [
            "14",
            "16#0E",
            "16#e",
            "2#1110",
            "8#16",
            "USINT#14",
            "usint#16#0E",
            "INT#+14",
            "1_4",
            "0x0E",
            "0Eh",
        ] {
            assert_eq!(read_literal(text), Ok(Literal::Integer(14)), "{text}");
        }
    }

    #[test]
    fn times_texts_and_truths_are_read() {
        assert_eq!(read_literal("T#1m_30s"), Ok(Literal::Time(90_000_000)));
        assert_eq!(read_literal("TIME#2.5s"), Ok(Literal::Time(2_500_000)));
        assert_eq!(read_literal("t#250ms"), Ok(Literal::Time(250_000)));
        assert_eq!(read_literal("BOOL#1"), Ok(Literal::Bool(true)));
        assert_eq!(read_literal("'a$'b$$c$0D'"), Ok(Literal::Text("a'b$c\r".into())));
        assert_eq!(read_literal("‘0.2.0’"), Ok(Literal::Text("0.2.0".into())));
        assert_eq!(read_literal("-1.5"), Ok(Literal::Real(-1.5)));
    }

    #[test]
    fn a_quoted_text_reads_back() {
        for text in ["4,192.168.1.100", "it's $5", "two\nlines\r\t", "Größe"] {
            assert_eq!(read_literal(&quoted(text)), Ok(Literal::Text(text.into())), "{text}");
        }
    }

    #[test]
    fn what_does_not_fit_its_type_is_refused() {
        for text in [
            "USINT#300",
            "USINT#-1",
            "INT#32768",
            "BYTE#16#100",
            "FOO#1",
            "12x",
            "3#11",
            "16#G",
            "T#3",
            "T#3x",
            "T#1.2345678s",
            "BOOL#2",
            "99999999999999999999999999999999999999999",
            "'a$G'",
            "16#-5",
        ] {
            assert!(read_literal(text).is_err(), "{text}");
        }
    }
}
