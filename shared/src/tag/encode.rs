//! A value → bytes.

use alloc::string::ToString;
use alloc::vec::Vec;

use super::dialect::Dialect;
use super::elementary::{Elementary, Form};
use super::kind::{BOOL, Type};
use super::layout::{Layout, packed_bools};
use super::value::{Value, ValueError};

impl Type {
    /// The bytes that Write Tag carries behind head and count. What does not fit is refused, never cut.
    pub fn encode(&self, dialect: Dialect, value: &Value) -> Result<Vec<u8>, ValueError> {
        let mut out = Vec::new();
        match (self, value) {
            // The manual's picture has a pad byte behind one byte; controllers refuse it (libplctag issues 274, 434).
            (Self::String(_), Value::Text(text)) => self.put_text(dialect, text, &mut out)?,
            (Self::Array(element, dimensions), Value::List(values))
                if **element == BOOL && dialect != Dialect::Logix =>
            {
                count(dimensions.count(), values.len())?;
                for value in values {
                    out.push(bool_of(self, value)?.into());
                }
            }
            (Self::Array(element, dimensions), Value::List(values)) if **element != BOOL => {
                count(dimensions.count(), values.len())?;
                for value in values {
                    element.put(dialect, value, &mut out)?;
                }
            }
            _ => self.put(dialect, value, &mut out)?,
        }
        Ok(out)
    }

    /// A text by itself: its length, then its bytes; a Logix fills up to what its structure holds.
    fn put_text(&self, dialect: Dialect, text: &[u8], out: &mut Vec<u8>) -> Result<(), ValueError> {
        let Self::String(capacity) = self else { return Err(self.kind_error(&"a text")) };
        let max = usize::from(capacity.unwrap_or(dialect.string_capacity()));
        let too_long = ValueError::TextTooLong { length: text.len(), max };
        if text.len() > max {
            return Err(too_long);
        }
        match dialect {
            Dialect::Logix => self.put(dialect, &Value::Text(text.to_vec()), out)?,
            Dialect::Omron => {
                out.extend_from_slice(&u16::try_from(text.len()).map_err(|_| too_long)?.to_le_bytes());
                out.extend_from_slice(text);
            }
            Dialect::Micro800 => {
                out.push(u8::try_from(text.len()).map_err(|_| too_long)?);
                out.extend_from_slice(text);
            }
        }
        Ok(())
    }

    /// Appends as many bytes as the type has inside of something.
    fn put(&self, dialect: Dialect, value: &Value, out: &mut Vec<u8>) -> Result<(), ValueError> {
        match (self, value) {
            (Self::Elementary(kind), value) => put_number(*kind, dialect, value, out),
            (Self::String(capacity), Value::Text(text)) => {
                let max = usize::from(capacity.unwrap_or(dialect.string_capacity()));
                if text.len() > max {
                    return Err(ValueError::TextTooLong { length: text.len(), max });
                }
                let end = out.len() + self.size(dialect);
                // The length is at most the capacity.
                let length = u32::try_from(text.len()).unwrap_or(u32::MAX).to_le_bytes();
                match dialect {
                    Dialect::Logix => out.extend_from_slice(&length),
                    Dialect::Micro800 => out.extend(length.first()),
                    Dialect::Omron => {}
                }
                out.extend_from_slice(text);
                out.resize(end, 0);
                Ok(())
            }
            (Self::Array(element, dimensions), Value::List(values)) => {
                count(dimensions.count(), values.len())?;
                if **element == BOOL && dialect != Dialect::Micro800 {
                    let from = out.len();
                    out.resize(from + packed_bools(values.len(), dialect), 0);
                    for (index, value) in values.iter().enumerate() {
                        let bit = u8::from(bool_of(self, value)?) << (index % 8);
                        if let Some(byte) = out.get_mut(from + index / 8) {
                            *byte |= bit;
                        }
                    }
                    return Ok(());
                }
                values.iter().try_for_each(|value| element.put(dialect, value, out))
            }
            (Self::Structure(structure), Value::Members(members)) => {
                let layout = Layout::of(structure, dialect);
                let mut bytes = alloc::vec![0; layout.size];
                let unknown = members.iter().find(|(name, _)| structure.member(name).is_none());
                if let Some((name, _)) = unknown {
                    return Err(ValueError::Member(name.clone(), "is not in the structure"));
                }
                for (member, place) in structure.members.iter().zip(&layout.places) {
                    let mut given =
                        members.iter().filter(|(name, _)| name.eq_ignore_ascii_case(&member.name));
                    let missing =
                        || ValueError::Member(member.name.clone(), "is missing: all are written together");
                    let (_, value) = given.next().ok_or_else(missing)?;
                    if given.next().is_some() {
                        return Err(ValueError::Member(member.name.clone(), "is there twice"));
                    }
                    let offset = usize::try_from(place.offset).unwrap_or(usize::MAX);
                    if let Some(bit) = place.bit {
                        let on = bool_of(&member.kind, value)?;
                        if let Some(byte) = bytes.get_mut(offset) {
                            *byte |= u8::from(on).checked_shl(bit.into()).unwrap_or(0);
                        }
                        continue;
                    }
                    let mut part = Vec::new();
                    member.kind.put(dialect, value, &mut part)?;
                    let room = bytes.get_mut(offset..offset.saturating_add(part.len()));
                    room.ok_or_else(|| self.length(layout.size, offset.saturating_add(part.len())))?
                        .copy_from_slice(&part);
                }
                out.extend_from_slice(&bytes);
                Ok(())
            }
            _ => Err(self.kind_error(value)),
        }
    }

    fn kind_error(&self, value: &impl ToString) -> ValueError {
        ValueError::Kind { what: self.to_string(), found: value.to_string() }
    }
}

fn count(needed: usize, found: usize) -> Result<(), ValueError> {
    if needed == found { Ok(()) } else { Err(ValueError::Count { needed, found }) }
}

fn bool_of(kind: &Type, value: &Value) -> Result<bool, ValueError> {
    match value {
        Value::Bool(value) => Ok(*value),
        other => Err(kind.kind_error(other)),
    }
}

fn put_number(
    kind: Elementary,
    dialect: Dialect,
    value: &Value,
    out: &mut Vec<u8>,
) -> Result<(), ValueError> {
    let size = kind.size(dialect);
    let little = |out: &mut Vec<u8>, bytes: [u8; 8]| out.extend(bytes.iter().take(size));
    match (kind.form(), value) {
        (Form::Bool, Value::Bool(value)) => match dialect {
            // The second byte asks for no forcing.
            Dialect::Omron => out.extend_from_slice(&[(*value).into(), 0]),
            Dialect::Logix => out.push(if *value { 0xFF } else { 0 }),
            Dialect::Micro800 => out.push((*value).into()),
        },
        (Form::Float, Value::Real(value)) if size == 4 => out.extend_from_slice(&value.to_le_bytes()),
        (Form::Float, Value::Lreal(value)) if size == 8 => out.extend_from_slice(&value.to_le_bytes()),
        (Form::Signed, Value::Signed(number)) => {
            let shift = 64 - 8 * size.clamp(1, 8);
            if (number << shift) >> shift != *number {
                return Err(kind.outside(size, value));
            }
            little(out, number.to_le_bytes());
        }
        (Form::Unsigned | Form::Bits, Value::Unsigned(number)) => {
            if *number > kind.max(size) {
                return Err(kind.outside(size, value));
            }
            little(out, number.to_le_bytes());
        }
        (Form::Bcd, Value::Unsigned(number)) => {
            if *number > kind.max(size) {
                return Err(kind.outside(size, value));
            }
            let digits = (0..16).map(|place| ((number / 10_u64.pow(place)) % 10) << (4 * place));
            little(out, digits.sum::<u64>().to_le_bytes());
        }
        _ => return Err(Type::Elementary(kind).kind_error(value)),
    }
    Ok(())
}

impl Elementary {
    /// The biggest number that so many bytes of this type hold; for whole numbers without a sign.
    pub(super) fn max(self, size: usize) -> u64 {
        let bits = 8 * u32::try_from(size.clamp(1, 8)).unwrap_or(8);
        match self.form() {
            Form::Bcd => 10_u64.pow(bits / 4) - 1,
            Form::Signed => (1 << (bits - 1)) - 1,
            _ => u64::MAX >> (64 - bits),
        }
    }

    pub(super) fn outside(self, size: usize, value: &impl ToString) -> ValueError {
        let max = self.max(size);
        let min = if self.form() == Form::Signed {
            alloc::format!("-{}", u128::from(max) + 1)
        } else {
            "0".to_string()
        };
        ValueError::Range { text: value.to_string(), what: self.name(), min, max: max.to_string() }
    }
}
