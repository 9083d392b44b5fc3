//! Read Tag (0x4C) and Read Tag Fragmented (0x52).

use alloc::vec::Vec;

use crate::sim::request::Refusal;
use crate::tag::{Dialect, Elementary, Type};
use crate::wire::{GeneralStatus, Reader, SimpleDataSegment};

use super::address::Part;
use super::memory::Tag;
use super::refusal::Wrong;

/// Whole steps of a part of a structure that does not fit: our guess.
const STRUCTURE_STEP: usize = 4;

impl Tag {
    /// `UINT elements` gives type and values. `room` is what the data of the reply may take. A Logix gives what fits,
    /// with status 06; an Omron gives all or nothing.
    pub(super) fn read(
        &self,
        dialect: Dialect,
        part: Part<'_>,
        bytes: Option<SimpleDataSegment>,
        data: &[u8],
        room: usize,
    ) -> Result<Vec<u8>, Refusal> {
        let refuse = |wrong: Wrong| wrong.refusal(dialect);
        let count = count(data).map_err(refuse)?;
        let mut out = head(&part, dialect).ok_or_else(|| refuse(Wrong::Kind))?;
        if let Some(bytes) = bytes {
            out.extend(self.region(dialect, part, bytes).map_err(refuse)?);
            return if out.len() > room { Err(refuse(Wrong::TooLarge)) } else { Ok(out) };
        }
        let values = self.values(dialect, part, count).map_err(refuse)?;
        fragment(out, &values.bytes, values.step, 0, dialect, room)
    }

    /// `UINT elements | UDINT offset` gives type and values from that byte on; status 06 says that there is more.
    pub(super) fn read_fragment(
        &self,
        dialect: Dialect,
        part: Part<'_>,
        data: &[u8],
        room: usize,
    ) -> Result<Vec<u8>, Refusal> {
        let refuse = |wrong: Wrong| wrong.refusal(dialect);
        let (elements, offset) = data.split_at_checked(2).ok_or_else(|| refuse(Wrong::Short))?;
        let count = count(elements).map_err(refuse)?;
        let mut reader = Reader::new(offset);
        let offset = reader.u32().map_err(|_| refuse(Wrong::Short))?;
        reader.finish().map_err(|_| refuse(Wrong::Long))?;
        let out = head(&part, dialect).ok_or_else(|| refuse(Wrong::Kind))?;
        let values = self.values(dialect, part, count).map_err(refuse)?;
        let offset = usize::try_from(offset).unwrap_or(usize::MAX);
        fragment(out, &values.bytes, values.step, offset, dialect, room)
    }

    /// The elements as they travel.
    fn values(&self, dialect: Dialect, part: Part<'_>, count: u16) -> Result<Values, Wrong> {
        let named = part.array && !part.whole;
        let part = part.elements(dialect);
        let mut count = usize::from(count);
        // An Omron gives an array as a whole when no element is named (W506 8-7).
        let all = part.whole && dialect == Dialect::Omron && count == 1;
        if all {
            count = part.run;
        }
        in_range(&part, count)?;
        let single = count == 1 && !(part.array && !named && dialect == Dialect::Omron);
        let memory = self.bytes.get(part.offset..part.offset + part.span(count)).ok_or(Wrong::Outside)?;
        let step = part.stride.clamp(1, 8);
        let bytes = match (part.kind, part.bit) {
            (_, Some(bit)) => {
                let on = if dialect == Dialect::Logix { 0xFF } else { 1 };
                let each = (usize::from(bit)..).take(count);
                let each = each.map(|bit| if is_set(memory, bit) { on } else { 0 });
                // By itself it has the second byte of a BOOL: not forced.
                let alone = (single && dialect == Dialect::Omron).then_some(0);
                each.chain(alone).collect()
            }
            (Type::Elementary(Elementary::Bool), None) if dialect == Dialect::Logix => {
                memory.iter().map(|byte| if *byte == 0 { 0 } else { 0xFF }).collect()
            }
            (Type::String(_), None) if single => match dialect {
                Dialect::Logix => memory.to_vec(),
                Dialect::Micro800 => {
                    let length = memory.first().map_or(0, |length| usize::from(*length));
                    memory.iter().copied().take(1 + length).collect()
                }
                Dialect::Omron => {
                    let length = memory.iter().position(|byte| *byte == 0).unwrap_or(memory.len());
                    text(memory.get(..length).unwrap_or_default())
                }
            },
            _ => memory.to_vec(),
        };
        let step = if matches!(part.kind, Type::Elementary(_)) { step } else { STRUCTURE_STEP };
        Ok(Values { bytes, step })
    }

    /// Omron: bytes of what has parts.
    fn region(&self, dialect: Dialect, part: Part<'_>, bytes: SimpleDataSegment) -> Result<Vec<u8>, Wrong> {
        let is_text = matches!(part.kind, Type::String(_));
        let region = self.bytes.get(region(dialect, part, bytes)?).ok_or(Wrong::PastEnd)?;
        Ok(if is_text { text(region) } else { region.to_vec() })
    }
}

struct Values {
    bytes: Vec<u8>,
    /// What is sent in parts is cut at multiples of this.
    step: usize,
}

/// Where the bytes of a simple data segment are.
pub(super) fn region(
    dialect: Dialect,
    part: Part<'_>,
    bytes: SimpleDataSegment,
) -> Result<core::ops::Range<usize>, Wrong> {
    if matches!(part.kind, Type::Elementary(_)) {
        return Err(Wrong::NotInParts);
    }
    let part = part.elements(dialect);
    let whole = match part.bit {
        // Words.
        Some(_) => part.run.div_ceil(16) * 2,
        None => part.span(part.run),
    };
    let offset = usize::try_from(bytes.offset).map_err(|_| Wrong::PastEnd)?;
    let end = offset.checked_add(bytes.size.into()).filter(|end| *end <= whole).ok_or(Wrong::PastEnd)?;
    if offset == end {
        return Err(Wrong::Outside);
    }
    Ok(part.offset + offset..part.offset + end)
}

/// Whether so many elements are there.
pub(super) fn in_range(part: &Part<'_>, count: usize) -> Result<(), Wrong> {
    match count {
        0 => Err(Wrong::Outside),
        1 => Ok(()),
        _ if !part.array => Err(Wrong::NoArray),
        _ if count > part.run => Err(Wrong::Outside),
        _ => Ok(()),
    }
}

/// Type and handle.
fn head(part: &Part<'_>, dialect: Dialect) -> Option<Vec<u8>> {
    let mut out = Vec::new();
    part.kind.head(dialect)?.encode(&mut out);
    Some(out)
}

fn count(data: &[u8]) -> Result<u16, Wrong> {
    match data {
        [low, high] => Ok(u16::from_le_bytes([*low, *high])),
        [] | [_] => Err(Wrong::Short),
        _ => Err(Wrong::Long),
    }
}

/// UINT length and bytes.
fn text(bytes: &[u8]) -> Vec<u8> {
    let length = u16::try_from(bytes.len()).unwrap_or(u16::MAX);
    [&length.to_le_bytes()[..], bytes].concat()
}

fn is_set(bytes: &[u8], bit: usize) -> bool {
    bytes.get(bit / 8).is_some_and(|byte| byte >> (bit % 8) & 1 == 1)
}

/// As much from the offset on as fits.
fn fragment(
    mut out: Vec<u8>,
    values: &[u8],
    step: usize,
    offset: usize,
    dialect: Dialect,
    room: usize,
) -> Result<Vec<u8>, Refusal> {
    let rest = values.get(offset..).filter(|rest| !rest.is_empty());
    let rest = rest.ok_or_else(|| Wrong::PastEnd.refusal(dialect))?;
    let room = room.saturating_sub(out.len());
    if rest.len() <= room {
        out.extend_from_slice(rest);
        return Ok(out);
    }
    let fits = room / step * step;
    if dialect == Dialect::Omron || fits == 0 {
        return Err(Wrong::TooLarge.refusal(dialect));
    }
    out.extend_from_slice(rest.get(..fits).unwrap_or_default());
    Err(Refusal { data: out, ..Refusal::from(GeneralStatus::PartialTransfer) })
}
