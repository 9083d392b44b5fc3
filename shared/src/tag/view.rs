//! How a person sees a value: scaled, in a radix, in words; and back.

use alloc::borrow::ToOwned;
use alloc::collections::BTreeMap;
use alloc::string::{String, ToString};
use alloc::vec::Vec;

use serde::{Deserialize, Serialize};

use super::elementary::{Elementary, Form};
use super::kind::Type;
use super::value::{Value, ValueError};

/// How a number is written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
#[serde(rename_all = "lowercase")]
pub enum Display {
    /// As its type is usually written: WORD as hexadecimal, others as decimal.
    #[default]
    Auto,
    /// `255`
    Dec,
    /// `0x00FF`
    Hex,
    /// `0b0000_0000_1111_1111`
    Bin,
    /// The 32 or 64 bits as a floating point number.
    Float,
    /// Its bytes as characters, the lowest first.
    Ascii,
}

impl Display {
    /// All of them.
    pub const ALL: [Self; 6] = [Self::Auto, Self::Dec, Self::Hex, Self::Bin, Self::Float, Self::Ascii];

    /// The word in JSON.
    pub const fn word(self) -> &'static str {
        match self {
            Self::Auto => "auto",
            Self::Dec => "dec",
            Self::Hex => "hex",
            Self::Bin => "bin",
            Self::Float => "float",
            Self::Ascii => "ascii",
        }
    }
}

/// From what the device holds to what people say: `held × factor + offset`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct Scale {
    /// Never 0.
    #[serde(default = "one")]
    pub factor: f64,
    /// In units.
    #[serde(default)]
    pub offset: f64,
}

const fn one() -> f64 {
    1.0
}

/// How a variable is shown.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct View {
    /// How numbers are written.
    pub display: Display,
    /// From raw to units.
    pub scale: Option<Scale>,
    /// Digits behind the point; `None` = as many as there are.
    pub digits: Option<u8>,
    /// Words for whole numbers.
    pub choices: BTreeMap<i64, String>,
}

/// Digits behind the point that make sense.
const MAX_DIGITS: u8 = 12;

impl View {
    /// The value as text, without its unit. Without a known type: as it is.
    pub fn text(&self, kind: Option<&Type>, value: &Value) -> String {
        match (kind, value) {
            (Some(Type::Array(element, _)), Value::List(values)) => {
                let all: Vec<_> =
                    values.iter().map(|value| self.text(Some(element.as_ref()), value)).collect();
                alloc::format!("[{}]", all.join(", "))
            }
            (Some(Type::Elementary(kind)), value) => self.elementary(*kind, value),
            (_, value) => value.to_string(),
        }
    }

    /// The number in units, for a chart and for limits.
    pub fn number(&self, value: &Value) -> Option<f64> {
        let raw = value.number().filter(|number| number.is_finite())?;
        let number = self.scale.map_or(raw, |scale| raw * scale.factor + scale.offset);
        number.is_finite().then_some(number)
    }

    /// What somebody types, in units or as one of the words.
    pub fn parse(&self, kind: &Type, text: &str) -> Result<Value, ValueError> {
        let text = text.trim();
        if let Some((number, _)) = self.choices.iter().find(|(_, word)| word.eq_ignore_ascii_case(text)) {
            return kind.parse_value(&number.to_string());
        }
        match (kind, self.scale) {
            (Type::Elementary(elementary), Some(scale)) if elementary.form() != Form::Bool => {
                unscaled(*elementary, scale, text)
            }
            _ => kind.parse_value(text),
        }
    }

    fn elementary(&self, kind: Elementary, value: &Value) -> String {
        let whole = match value {
            Value::Signed(number) => Some(*number),
            Value::Unsigned(number) => i64::try_from(*number).ok(),
            Value::Bool(value) => Some((*value).into()),
            _ => None,
        };
        if let Some((number, word)) = whole.and_then(|number| self.choices.get_key_value(&number)) {
            return alloc::format!("{word} ({number})");
        }
        if let Some(scale) = self.scale
            && let Some(number) = value.number()
        {
            return self.decimal(number * scale.factor + scale.offset);
        }
        let display = match (self.display, kind.form()) {
            (Display::Auto, Form::Bits) => Display::Hex,
            (Display::Auto, _) => Display::Dec,
            (display, _) => display,
        };
        let bits = match (display, value) {
            (Display::Hex | Display::Bin | Display::Float | Display::Ascii, Value::Signed(number)) => {
                number.cast_unsigned()
            }
            (Display::Hex | Display::Bin | Display::Float | Display::Ascii, Value::Unsigned(number)) => {
                *number
            }
            (Display::Hex | Display::Bin, Value::Real(number)) => number.to_bits().into(),
            (Display::Hex | Display::Bin, Value::Lreal(number)) => number.to_bits(),
            (_, Value::Real(_) | Value::Lreal(_)) if self.digits.is_some() => {
                return self.decimal(value.number().unwrap_or(f64::NAN));
            }
            _ => return value.to_string(),
        };
        let size = kind.size(super::Dialect::Logix);
        written(display, bits, size)
    }

    fn decimal(&self, number: f64) -> String {
        match self.digits {
            Some(digits) if number.is_finite() => {
                alloc::format!("{number:.*}", usize::from(digits.min(MAX_DIGITS)))
            }
            // What scaling adds behind the twelfth digit nobody has measured.
            _ => shortest(number),
        }
    }
}

/// Twelve significant digits, without zeros at the end.
fn shortest(number: f64) -> String {
    let rounded: f64 = alloc::format!("{number:.11e}").parse().unwrap_or(number);
    Value::Lreal(rounded).to_string()
}

fn written(display: Display, bits: u64, size: usize) -> String {
    let bits = if size < 8 { bits & ((1 << (8 * size)) - 1) } else { bits };
    match display {
        Display::Hex => alloc::format!("0x{bits:0width$X}", width = 2 * size),
        Display::Bin => {
            let digits = alloc::format!("{bits:0width$b}", width = 8 * size);
            let nibbles: Vec<_> = digits.as_bytes().chunks(4).map(String::from_utf8_lossy).collect();
            alloc::format!("0b{}", nibbles.join("_"))
        }
        Display::Float if size == 4 => {
            Value::Real(f32::from_bits(u32::try_from(bits).unwrap_or_default())).to_string()
        }
        Display::Float if size == 8 => Value::Lreal(f64::from_bits(bits)).to_string(),
        Display::Ascii => {
            let bytes = bits.to_le_bytes();
            let bytes = bytes.get(..size.min(8)).unwrap_or_default();
            Value::Text(bytes.to_vec()).to_string()
        }
        Display::Auto | Display::Dec | Display::Float => bits.to_string(),
    }
}

/// From units to what the device holds. A whole number is met exactly, or refused with its neighbours.
fn unscaled(kind: Elementary, scale: Scale, text: &str) -> Result<Value, ValueError> {
    let Value::Lreal(wanted) = Type::Elementary(Elementary::Lreal).parse_value(text)? else {
        return Err(ValueError::Kind { what: kind.name().to_owned(), found: text.to_owned() });
    };
    let raw = (wanted - scale.offset) / scale.factor;
    if kind.form() == Form::Float {
        return Type::Elementary(kind).parse_value(&Value::Lreal(raw).to_string());
    }
    let Some(nearest) = whole(raw) else { return Type::Elementary(kind).parse_value(&shortest(raw)) };
    let units = |raw: i64| shortest(number(raw) * scale.factor + scale.offset);
    // What a person types has fewer digits than this.
    let tolerance = 1e-9 * if wanted.abs() > 1.0 { wanted.abs() } else { 1.0 };
    if (number(nearest) * scale.factor + scale.offset - wanted).abs() > tolerance {
        let (a, b) = if number(nearest) < raw { (nearest, nearest + 1) } else { (nearest - 1, nearest) };
        return Err(ValueError::Between { text: text.to_owned(), below: units(a), above: units(b) });
    }
    Type::Elementary(kind).parse_value(&nearest.to_string())
}

#[expect(clippy::cast_precision_loss, reason = "numbers over 2^53 are refused before")]
const fn number(raw: i64) -> f64 {
    raw as f64
}

/// The nearest whole number; `None` where a double has no exact ones.
#[expect(clippy::cast_possible_truncation, reason = "the range is checked")]
fn whole(raw: f64) -> Option<i64> {
    const EXACT: f64 = 9_007_199_254_740_992.0;
    (raw.abs() < EXACT).then_some(if raw < 0.0 { (raw - 0.5) as i64 } else { (raw + 0.5) as i64 })
}
