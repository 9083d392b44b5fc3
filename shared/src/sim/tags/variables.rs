//! The objects by which an Omron NJ or NX tells its variables and their types.
//!
//! * Class 6A, service 5F: names. `UDINT from | UDINT count | UINT kind (1 system, 2 user)` gives `UINT count | USINT more |
//!   00`, then of each `UDINT number | UINT length | UINT class 6B | UDINT instance | USINT length | name`.
//! * Class 6B, or the name itself, Get_Attributes_All: `UDINT size (of an element) | USINT type | USINT type of elements |
//!   USINT dimensions | 00 | UDINT length of each | UDINT type's instance | 4 bytes | USINT bit | 3 bytes | UDINT type's
//!   instance | UDINT first index of each`.
//! * Class 6C, Get_Attributes_All: `UDINT size | 00 | USINT type | USINT type of elements | USINT dimensions | UDINT length of
//!   each | UINT members | 4 bytes | UINT CRC | USINT length | name | [00] | UDINT next member | UDINT what is inside | UDINT
//!   first index of each`. A structure's instance leads to its first member, and that to the next.
//!
//! Source: seen in what aphyt reads (n_series.py). What it steps over is zero here.

use alloc::vec::Vec;

use crate::sim::attribute::Class;
use crate::sim::request::{Head, Refusal};
use crate::tag::{Dialect, Dimension, Elementary, Structure, Type};
use crate::wire::{ClassCode, GeneralStatus, Reader, ServiceCode};

use super::memory::{Tag, TagAccess, TagMemory};
use super::object::{Object, TAG_NAMES};

/// Get_Instance_List of class 6A.
const LIST_NAMES: ServiceCode = ServiceCode(0x5F);

const STRUCTURE: u8 = 0xA2;
const ARRAY: u8 = 0xA3;
const STRING: u8 = 0xD0;

/// What the names of the system's variables begin with.
const SYSTEM: char = '_';

impl TagMemory {
    /// Answers of classes 6A, 6B and 6C.
    pub(super) fn variable_object(
        &self,
        head: &Head<'_>,
        object: &Object<'_>,
        room: usize,
    ) -> Result<Vec<u8>, Refusal> {
        let unknown = GeneralStatus::PathDestinationUnknown;
        match (object.class, object.instance, head.service) {
            (TAG_NAMES, 0, LIST_NAMES) => self.names(head.data, room),
            (class, 0, ServiceCode::GetAttributesAll) => {
                let count = if class == ClassCode::Template { self.types() } else { self.tags.len() };
                let count = u16::try_from(count).unwrap_or(u16::MAX);
                let class = Class { revision: 1, max_instance: count, instances: count };
                Ok((1..=3).filter_map(|number| class.read(number)).flatten().collect())
            }
            (ClassCode::Symbol, instance, ServiceCode::GetAttributesAll) => {
                let index = usize::try_from(instance).ok().and_then(|instance| instance.checked_sub(1));
                let tag = index.and_then(|index| self.tags.get(index));
                let tag = tag.filter(|tag| tag.access != TagAccess::None).ok_or(unknown)?;
                Ok(self.variable(&tag.kind).ok_or(unknown)?)
            }
            (ClassCode::Template, instance, ServiceCode::GetAttributesAll) => {
                Ok(self.type_object(instance).ok_or(unknown)?)
            }
            _ => Err(GeneralStatus::ServiceNotSupported.into()),
        }
    }

    fn names(&self, data: &[u8], room: usize) -> Result<Vec<u8>, Refusal> {
        let mut reader = Reader::new(data);
        let short = |_| GeneralStatus::NotEnoughData;
        let (from, most) = (reader.u32().map_err(short)?, reader.u32().map_err(short)?);
        let system = match reader.u16().map_err(short)? {
            1 => true,
            2 => false,
            _ => return Err(GeneralStatus::InvalidParameter.into()),
        };
        let seen = |tag: &&Tag| tag.access != TagAccess::None && tag.name.starts_with(SYSTEM) == system;
        let numbered = (1_u32..).zip(&self.tags).filter(|(_, tag)| seen(tag));
        let mut all = (1_u32..).zip(numbered).skip_while(|(place, _)| *place < from).peekable();
        let (mut out, mut count) = (Vec::new(), 0_u16);
        while let Some((place, (instance, tag))) = all.peek() {
            let length = u8::try_from(tag.name.len()).unwrap_or(u8::MAX);
            let entry = [
                &place.to_le_bytes()[..],
                &(7 + u16::from(length)).to_le_bytes(),
                &ClassCode::Symbol.0.to_le_bytes(),
                &instance.to_le_bytes(),
                &[length],
                tag.name.as_bytes(),
            ]
            .concat();
            if 4 + out.len() + entry.len() > room || u32::from(count) >= most {
                break;
            }
            out.extend(entry);
            count += 1;
            all.next();
        }
        let [low, high] = count.to_le_bytes();
        let more = all.peek().is_some().into();
        Ok([&[low, high, more, 0][..], &out].concat())
    }

    /// Attributes of a variable, or of a part of one.
    pub(super) fn variable(&self, kind: &Type) -> Option<Vec<u8>> {
        let element = kind.element();
        let dimensions = dimensions(kind);
        let inside = self.root(element).unwrap_or(0);
        let mut out = size(element)?.to_le_bytes().to_vec();
        out.extend_from_slice(&[code(kind), code(element), u8::try_from(dimensions.len()).ok()?, 0]);
        out.extend(dimensions.iter().flat_map(|each| each.length.to_le_bytes()));
        out.extend_from_slice(&inside.to_le_bytes());
        out.extend_from_slice(&[0; 8]);
        out.extend_from_slice(&inside.to_le_bytes());
        out.extend(dimensions.iter().flat_map(|each| each.first.to_le_bytes()));
        Some(out)
    }

    /// How many instances class 6C has: each structure, and each of its members.
    fn types(&self) -> usize {
        self.structures.all().iter().map(|structure| 1 + structure.members.len()).sum()
    }

    /// The instance of a structure; its members follow.
    fn root(&self, kind: &Type) -> Option<u32> {
        let Type::Structure(structure) = kind else { return None };
        let position = self.structures.position(structure)?;
        let before = self.structures.all().iter().take(position);
        u32::try_from(1 + before.map(|structure| 1 + structure.members.len()).sum::<usize>()).ok()
    }

    fn type_object(&self, instance: u32) -> Option<Vec<u8>> {
        let mut place = usize::try_from(instance).ok()?.checked_sub(1)?;
        for structure in self.structures.all() {
            if place == 0 {
                return self.structure_object(structure, instance);
            }
            let index = place - 1;
            if let Some(member) = structure.members.get(index) {
                let next = if index + 1 < structure.members.len() { instance + 1 } else { 0 };
                let inside = self.root(member.kind.element()).unwrap_or(0);
                return object(&member.kind, 0, 0, &member.name, next, inside);
            }
            place -= 1 + structure.members.len();
        }
        None
    }

    fn structure_object(&self, structure: &Structure, instance: u32) -> Option<Vec<u8>> {
        let kind = self.structures.all().iter().find(|known| ***known == *structure)?;
        let kind = Type::Structure(alloc::sync::Arc::clone(kind));
        let members = u16::try_from(structure.members.len()).ok()?;
        object(&kind, members, structure.handle?, &structure.name, 0, instance + 1)
    }
}

fn object(kind: &Type, members: u16, crc: u16, name: &str, next: u32, inside: u32) -> Option<Vec<u8>> {
    let dimensions = dimensions(kind);
    let length = u8::try_from(name.len()).ok()?;
    let mut out = size(kind.element())?.to_le_bytes().to_vec();
    out.extend_from_slice(&[0, code(kind), code(kind.element()), u8::try_from(dimensions.len()).ok()?]);
    out.extend(dimensions.iter().flat_map(|each| each.length.to_le_bytes()));
    out.extend_from_slice(&members.to_le_bytes());
    out.extend_from_slice(&[0; 4]);
    out.extend_from_slice(&crc.to_le_bytes());
    out.push(length);
    out.extend_from_slice(name.as_bytes());
    if length.is_multiple_of(2) {
        out.push(0);
    }
    out.extend_from_slice(&next.to_le_bytes());
    out.extend_from_slice(&inside.to_le_bytes());
    out.extend(dimensions.iter().flat_map(|each| each.first.to_le_bytes()));
    Some(out)
}

fn dimensions(kind: &Type) -> &[Dimension] {
    match kind {
        Type::Array(_, dimensions) => dimensions.each(),
        _ => &[],
    }
}

fn code(kind: &Type) -> u8 {
    match kind {
        Type::Elementary(kind) => kind.code(),
        Type::String(_) => STRING,
        Type::Array(..) => ARRAY,
        Type::Structure(_) => STRUCTURE,
    }
}

fn size(kind: &Type) -> Option<u32> {
    u32::try_from(match kind {
        Type::Elementary(Elementary::Bool) => 2,
        other => other.size(Dialect::Omron),
    })
    .ok()
}
