//! Write Tag (0x4D), Write Tag Fragmented (0x53) and Read Modify Write Tag (0x4E).

use crate::tag::{Dialect, Elementary, TagHead, Type, Value};
use crate::wire::{Reader, SimpleDataSegment};

use super::address::{Part, Step};
use super::memory::{Tag, TagAccess, set_bit};
use super::read::{in_range, region};
use super::refusal::Wrong;

/// What stands before the values that are written.
struct Head {
    kind: TagHead,
    count: u16,
}

impl Head {
    fn read(reader: &mut Reader<'_>) -> Result<Self, Wrong> {
        let [code, length] = reader.array().map_err(|_| Wrong::Short)?;
        let handle = match length {
            0 => None,
            2 => Some(reader.u16().map_err(|_| Wrong::Short)?),
            _ => return Err(Wrong::AddInfo),
        };
        let count = reader.u16().map_err(|_| Wrong::Short)?;
        Ok(Self { kind: TagHead { code, handle }, count })
    }

    /// Whether the part is of this type, and how many elements are meant.
    fn check(&self, dialect: Dialect, part: &Part<'_>) -> Result<usize, Wrong> {
        if part.kind.head(dialect) != Some(self.kind) {
            return Err(Wrong::Kind);
        }
        let mut count = usize::from(self.count);
        if part.whole && dialect == Dialect::Omron && count == 1 {
            count = part.run;
        }
        in_range(part, count)?;
        Ok(count)
    }
}

impl Tag {
    /// `type | [handle] | UINT elements | values`.
    pub(super) fn write(&mut self, dialect: Dialect, to: &Place<'_>, data: &[u8]) -> Result<(), Wrong> {
        let mut reader = Reader::new(data);
        let head = Head::read(&mut reader)?;
        let kind = self.kind.clone();
        let part = Part::find(&kind, dialect, to.steps)?;
        if let Some(bytes) = to.bytes {
            return self.write_region(dialect, part, &head, bytes, reader.rest());
        }
        let part = part.elements(dialect);
        let count = head.check(dialect, &part)?;
        self.writable()?;
        let values = reader.rest();
        match (part.kind, part.bit) {
            (_, Some(bit)) => {
                // An element by itself may have the byte that forces it.
                let values = match values {
                    [on, 0] if count == 1 => core::slice::from_ref(on),
                    values => values,
                };
                let values = enough(dialect, values, count)?;
                for (bit, on) in (usize::from(bit)..).zip(values) {
                    let within = u8::try_from(bit % 8).unwrap_or(0);
                    set_bit(&mut self.bytes, part.offset + bit / 8, within, *on != 0);
                }
                Ok(())
            }
            (Type::String(_), None) if count == 1 && dialect != Dialect::Logix => {
                self.write_text(dialect, &part, values)
            }
            _ => {
                let values = enough(dialect, values, part.span(count))?;
                self.allowed(dialect, &part, values)?;
                self.store(part.offset, values)
            }
        }
    }

    /// `type | [handle] | UINT elements | UDINT offset | values`. Logix.
    pub(super) fn write_fragment(
        &mut self,
        dialect: Dialect,
        to: &Place<'_>,
        data: &[u8],
    ) -> Result<(), Wrong> {
        let mut reader = Reader::new(data);
        let head = Head::read(&mut reader)?;
        let offset = reader.u32().map_err(|_| Wrong::Short)?;
        let kind = self.kind.clone();
        let part = Part::find(&kind, dialect, to.steps)?.elements(dialect);
        let count = head.check(dialect, &part)?;
        if part.bit.is_some() {
            return Err(Wrong::Kind);
        }
        self.writable()?;
        let (values, offset) = (reader.rest(), usize::try_from(offset).map_err(|_| Wrong::PastEnd)?);
        if values.is_empty() {
            return Err(Wrong::Short);
        }
        let end = offset.checked_add(values.len()).ok_or(Wrong::PastEnd)?;
        if end > part.span(count) {
            return Err(Wrong::PastEnd);
        }
        self.store(part.offset + offset, values)
    }

    /// `UINT size | OR mask | AND mask`. Logix.
    pub(super) fn modify(&mut self, dialect: Dialect, to: &Place<'_>, data: &[u8]) -> Result<(), Wrong> {
        let mut reader = Reader::new(data);
        let size = usize::from(reader.u16().map_err(|_| Wrong::Short)?);
        let kind = self.kind.clone();
        let part = Part::find(&kind, dialect, to.steps)?.elements(dialect);
        let whole_number = matches!(part.kind, Type::Elementary(kind) if kind.bits().is_some());
        if !whole_number || part.bit.is_some() || size != part.stride {
            return Err(Wrong::Kind);
        }
        self.writable()?;
        let set = reader.take(size).map_err(|_| Wrong::Short)?;
        // pycomm3 sends an AND mask of 8 bytes whatever the size; controllers take it.
        let keep = reader.take(size).map_err(|_| Wrong::Short)?;
        let place = self.bytes.get_mut(part.offset..part.offset + size).ok_or(Wrong::Outside)?;
        for (byte, (set, keep)) in place.iter_mut().zip(set.iter().zip(keep)) {
            *byte = (*byte | set) & keep;
        }
        Ok(())
    }

    /// Omron: bytes of what has parts.
    fn write_region(
        &mut self,
        dialect: Dialect,
        part: Part<'_>,
        head: &Head,
        bytes: SimpleDataSegment,
        values: &[u8],
    ) -> Result<(), Wrong> {
        let is_text = matches!(part.kind, Type::String(_));
        let element = part.clone().elements(dialect);
        if element.kind.head(dialect) != Some(head.kind) {
            return Err(Wrong::Kind);
        }
        let place = region(dialect, part, bytes)?;
        self.writable()?;
        let values = if is_text { text(values)? } else { values };
        exactly(values, place.len())?;
        self.store(place.start, values)
    }

    /// A STRING by itself: its length, then its bytes.
    fn write_text(&mut self, dialect: Dialect, part: &Part<'_>, values: &[u8]) -> Result<(), Wrong> {
        let place = self.bytes.get_mut(part.offset..part.offset + part.stride).ok_or(Wrong::Outside)?;
        let (place, values) = match dialect {
            Dialect::Micro800 => {
                let (length, values) = values.split_first().ok_or(Wrong::Short)?;
                let values = enough(dialect, values, (*length).into())?;
                let (first, place) = place.split_first_mut().ok_or(Wrong::Outside)?;
                if values.len() > place.len() {
                    return Err(Wrong::Long);
                }
                *first = *length;
                (place, values)
            }
            _ => (place, text(values)?),
        };
        if values.len() > place.len() {
            return Err(Wrong::Long);
        }
        place.fill(0);
        place.iter_mut().zip(values).for_each(|(to, from)| *to = *from);
        Ok(())
    }

    fn store(&mut self, offset: usize, values: &[u8]) -> Result<(), Wrong> {
        self.bytes.get_mut(offset..offset + values.len()).ok_or(Wrong::Outside)?.copy_from_slice(values);
        Ok(())
    }

    fn writable(&self) -> Result<(), Wrong> {
        if self.access == TagAccess::Write { Ok(()) } else { Err(Wrong::ReadOnly) }
    }

    /// Omron: a subrange, and the values of an enumeration.
    fn allowed(&self, dialect: Dialect, part: &Part<'_>, values: &[u8]) -> Result<(), Wrong> {
        let Some((least, most)) = self.range else { return Ok(()) };
        let least_most = |value: &Value| match value {
            Value::Signed(value) => (least..=most).contains(value),
            Value::Unsigned(value) => {
                i64::try_from(*value).is_ok_and(|value| (least..=most).contains(&value))
            }
            _ => true,
        };
        let is_allowed = values
            .chunks_exact(part.stride.max(1))
            .all(|value| part.kind.decode(dialect, value).is_ok_and(|value| least_most(&value)));
        let number = matches!(part.kind, Type::Elementary(kind) if *kind != Elementary::Bool);
        if is_allowed || !number { Ok(()) } else { Err(Wrong::Value) }
    }
}

/// Which part of a tag.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place<'a> {
    pub(super) steps: &'a [Step<'a>],
    pub(super) bytes: Option<SimpleDataSegment>,
}

/// So many bytes. An Omron refuses more; a Logix takes what the count says: pycomm3 1.2.16 sends a single write twice in
/// one message, and is used with real ones.
fn enough(dialect: Dialect, values: &[u8], size: usize) -> Result<&[u8], Wrong> {
    if dialect == Dialect::Omron {
        exactly(values, size)?;
    }
    values.get(..size).ok_or(Wrong::Short)
}

/// As many bytes as that, neither fewer nor more.
fn exactly(values: &[u8], size: usize) -> Result<(), Wrong> {
    match values.len().cmp(&size) {
        core::cmp::Ordering::Less => Err(Wrong::Short),
        core::cmp::Ordering::Equal => Ok(()),
        core::cmp::Ordering::Greater => Err(Wrong::Long),
    }
}

/// Omron: UINT length and so many bytes.
fn text(values: &[u8]) -> Result<&[u8], Wrong> {
    let (length, values) = values.split_first_chunk().ok_or(Wrong::Short)?;
    exactly(values, u16::from_le_bytes(*length).into())?;
    Ok(values)
}
