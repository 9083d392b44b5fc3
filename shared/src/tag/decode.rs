//! Bytes → a value.

use alloc::string::ToString;
use alloc::vec::Vec;

use super::dialect::Dialect;
use super::elementary::{Elementary, Form};
use super::kind::{BOOL, Dimensions, Place, Structure, Type};
use super::layout::{Layout, packed_bools};
use super::value::{Value, ValueError};

impl Type {
    /// The value that a whole reply carries, behind its [`TagHead`](super::TagHead). Bytes that the type does not
    /// explain are an error: a layout that does not fit would show wrong values.
    pub fn decode(&self, dialect: Dialect, data: &[u8]) -> Result<Value, ValueError> {
        match self {
            Self::Elementary(kind) => self.number(*kind, dialect, data),
            Self::String(_) => self.text(dialect, data),
            Self::Array(element, dimensions) if **element == BOOL => self.bools(dimensions, dialect, data),
            Self::Array(element, dimensions) => self.list(element, dimensions, dialect, data),
            Self::Structure(structure) => {
                let layout = Layout::of(structure, dialect);
                if data.len() != layout.size {
                    return Err(self.length(layout.size, data.len()));
                }
                members(structure, &layout, dialect, data)
            }
        }
    }

    fn number(&self, kind: Elementary, dialect: Dialect, data: &[u8]) -> Result<Value, ValueError> {
        let size = kind.size(dialect);
        // Omron pads what is one byte long (W506 8-7-3); some send the state of a BOOL without the forced flag.
        let padded = size == 1 && data.len() == 2;
        let short = kind == Elementary::Bool && data.len() == 1;
        if data.len() != size && !padded && !short {
            return Err(self.length(size, data.len()));
        }
        inside(self, dialect, data.get(..size.min(data.len())).unwrap_or_default())
    }

    /// A STRING by itself: its length stands before it.
    fn text(&self, dialect: Dialect, data: &[u8]) -> Result<Value, ValueError> {
        let (head, length) = match (dialect, data) {
            (Dialect::Logix, [a, b, c, d, ..]) => (4, u32::from_le_bytes([*a, *b, *c, *d])),
            (Dialect::Omron, [a, b, ..]) => (2, u16::from_le_bytes([*a, *b]).into()),
            (Dialect::Micro800, [length, ..]) => (1, (*length).into()),
            _ => return Err(self.length(4, data.len())),
        };
        let needed = usize::try_from(length).unwrap_or(usize::MAX).saturating_add(head);
        let text = data.get(head..needed).ok_or_else(|| self.length(needed, data.len()))?;
        Ok(Value::Text(text.to_vec()))
    }

    /// BOOLs asked for by their number: a byte each; as a part of memory: packed.
    fn bools(&self, dimensions: &Dimensions, dialect: Dialect, data: &[u8]) -> Result<Value, ValueError> {
        let (count, packed) = (dimensions.count(), packed_bools(dimensions.count(), dialect));
        let bytes = dialect != Dialect::Logix && data.len() == count;
        if bytes {
            return Ok(Value::List(data.iter().map(|byte| Value::Bool(*byte != 0)).collect()));
        }
        if data.len() != packed {
            return Err(self.length(packed, data.len()));
        }
        Ok(Value::List(bits(data, count)))
    }

    fn list(
        &self,
        element: &Self,
        dimensions: &Dimensions,
        dialect: Dialect,
        data: &[u8],
    ) -> Result<Value, ValueError> {
        let (count, stride) = (dimensions.count(), element.size(dialect));
        let needed = count.saturating_mul(stride);
        let padded = !needed.is_multiple_of(2) && data.len() == needed + 1;
        if data.len() != needed && !padded {
            return Err(self.length(needed, data.len()));
        }
        let elements = data.chunks_exact(stride.max(1)).take(count);
        elements.map(|bytes| inside(element, dialect, bytes)).collect::<Result<_, _>>().map(Value::List)
    }

    pub(super) fn length(&self, needed: usize, found: usize) -> ValueError {
        ValueError::Length { what: self.to_string(), needed, found }
    }
}

/// A value in the middle of others: exactly as many bytes as its size.
fn inside(kind: &Type, dialect: Dialect, bytes: &[u8]) -> Result<Value, ValueError> {
    match kind {
        Type::Elementary(Elementary::Bool) => Ok(Value::Bool(bytes.first().is_some_and(|byte| *byte != 0))),
        Type::Elementary(elementary) => Ok(number(*elementary, bytes)),
        Type::String(_) => Ok(Value::Text(match dialect {
            Dialect::Omron => until_zero(bytes).to_vec(),
            Dialect::Logix | Dialect::Micro800 => return kind.text(dialect, bytes),
        })),
        Type::Array(element, dimensions) if **element == BOOL && dialect != Dialect::Micro800 => {
            Ok(Value::List(bits(bytes, dimensions.count())))
        }
        Type::Array(element, dimensions) => kind.list(element, dimensions, dialect, bytes),
        Type::Structure(structure) => members(structure, &Layout::of(structure, dialect), dialect, bytes),
    }
}

fn members(
    structure: &Structure,
    layout: &Layout,
    dialect: Dialect,
    bytes: &[u8],
) -> Result<Value, ValueError> {
    let mut values = Vec::with_capacity(structure.members.len());
    for (member, place) in structure.members.iter().zip(&layout.places) {
        let Place { offset, bit } = *place;
        let offset = usize::try_from(offset).unwrap_or(usize::MAX);
        let size = if bit.is_some() { 1 } else { member.kind.size(dialect) };
        let part = bytes.get(offset..offset.saturating_add(size));
        let part = part.ok_or_else(|| member.kind.length(size, bytes.len().saturating_sub(offset)))?;
        let value = match (bit, part.first()) {
            (Some(bit), Some(byte)) => Value::Bool(byte.checked_shr(bit.into()).unwrap_or(0) & 1 != 0),
            _ => inside(&member.kind, dialect, part)?,
        };
        values.push((member.name.clone(), value));
    }
    Ok(Value::Members(values))
}

fn number(kind: Elementary, bytes: &[u8]) -> Value {
    let mut wide = [0; 8];
    for (to, from) in wide.iter_mut().zip(bytes) {
        *to = *from;
    }
    let unsigned = u64::from_le_bytes(wide);
    // Bits that are missing from 64.
    let missing = 64 - 8 * u32::try_from(bytes.len().clamp(1, 8)).unwrap_or(8);
    match kind.form() {
        Form::Bool => Value::Bool(unsigned != 0),
        Form::Signed => Value::Signed((unsigned << missing).cast_signed() >> missing),
        Form::Unsigned | Form::Bits => Value::Unsigned(unsigned),
        Form::Bcd => bcd(unsigned).map_or_else(|| Value::Raw(bytes.to_vec()), Value::Unsigned),
        Form::Float if bytes.len() == 4 => match *bytes {
            [a, b, c, d] => Value::Real(f32::from_le_bytes([a, b, c, d])),
            _ => Value::Raw(bytes.to_vec()),
        },
        Form::Float => Value::Lreal(f64::from_le_bytes(wide)),
    }
}

/// Decimal digits of four bits each; `None` if one of them is over 9.
fn bcd(number: u64) -> Option<u64> {
    (0..16).rev().try_fold(0_u64, |sum, place| {
        let digit = (number >> (4 * place)) & 0xF;
        (digit < 10).then_some(sum * 10 + digit)
    })
}

fn bits(bytes: &[u8], count: usize) -> Vec<Value> {
    let bit = |index: usize| bytes.get(index / 8).is_some_and(|byte| (byte >> (index % 8)) & 1 != 0);
    (0..count).map(|index| Value::Bool(bit(index))).collect()
}

fn until_zero(bytes: &[u8]) -> &[u8] {
    let end = bytes.iter().position(|byte| *byte == 0).unwrap_or(bytes.len());
    bytes.get(..end).unwrap_or_default()
}
