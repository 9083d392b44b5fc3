//! Symbol object, class 6B of a Logix and of a Micro800: which tags there are.
//!
//! Attributes: 1 name, 2 type, 3 and 5 addresses, 6 software control, 7 size of an element, 8 dimensions, 10 external
//! access. Sources: pycomm3 logix_driver.py, libplctag (7). That a Micro800 has it follows from pycomm3, which reads no
//! tag without it.

use alloc::vec::Vec;

use crate::sim::attribute::{self, Class};
use crate::sim::request::{Head, Refusal};
use crate::tag::{Dialect, Elementary, Type};
use crate::wire::{GeneralStatus, Reader, ServiceCode};

use super::memory::{Tag, TagAccess, TagMemory};
use super::object::Object;

/// Bit 15: a structure.
const STRUCTURE: u16 = 0x8000;

/// Bits 13 and 14: how many dimensions.
const DIMENSIONS_SHIFT: u16 = 13;

/// Bit 12: the system's; the code of a program.
const PROGRAM_SYMBOL: u16 = 0x1068;

/// Bit 26: not an alias.
const BASE_TAG: u32 = 1 << 26;

/// One symbol: a tag, or a program.
enum Symbol<'a> {
    Tag(&'a Tag),
    Program(&'a str),
}

impl TagMemory {
    /// Answers of class 6B.
    pub(super) fn symbol(
        &self,
        head: &Head<'_>,
        object: &Object<'_>,
        room: usize,
    ) -> Result<Vec<u8>, Refusal> {
        let symbols = self.symbols(object.program);
        if object.program.is_some() && symbols.is_empty() {
            return Err(GeneralStatus::PathSegmentError.into());
        }
        if head.service == ServiceCode::GetInstanceAttributeList {
            return self.list(&symbols, object.instance, head.data, room);
        }
        let find = || symbols.iter().find(|symbol| symbol.0 == object.instance).map(|symbol| &symbol.1);
        let class = || {
            let last = symbols.last().map_or(0, |symbol| symbol.0);
            let short = |number: u32| u16::try_from(number).unwrap_or(u16::MAX);
            let instances = u16::try_from(symbols.len()).unwrap_or(u16::MAX);
            Class { revision: 1, max_instance: short(last), instances }
        };
        let unknown = GeneralStatus::PathDestinationUnknown;
        let read = |number: u16| match object.instance {
            0 => class().read(number),
            _ => self.attribute(find()?, number),
        };
        if object.instance != 0 && find().is_none() {
            return Err(unknown.into());
        }
        match (head.service, object.attribute) {
            (ServiceCode::GetAttributeList, None) => attribute::list(head.data, read),
            (ServiceCode::GetAttributeSingle, Some(number)) => {
                Ok(read(number).ok_or(GeneralStatus::AttributeNotSupported)?)
            }
            _ => Err(GeneralStatus::ServiceNotSupported.into()),
        }
    }

    /// Get_Instance_Attribute_List, from an instance on: `UDINT instance | attributes` of each; status 06 if there are
    /// more.
    fn list(
        &self,
        symbols: &[(u32, Symbol<'_>)],
        from: u32,
        data: &[u8],
        room: usize,
    ) -> Result<Vec<u8>, Refusal> {
        let mut reader = Reader::new(data);
        let short = |_| GeneralStatus::NotEnoughData;
        let count = reader.u16().map_err(short)?;
        let wanted = (0..count).map(|_| reader.u16()).collect::<Result<Vec<_>, _>>().map_err(short)?;
        reader.finish().map_err(|_| GeneralStatus::TooMuchData)?;
        let mut out = Vec::new();
        for (instance, symbol) in symbols.iter().filter(|symbol| symbol.0 >= from) {
            let mut entry = instance.to_le_bytes().to_vec();
            for number in &wanted {
                entry.extend(self.attribute(symbol, *number).ok_or(GeneralStatus::AttributeNotSupported)?);
            }
            if out.len() + entry.len() > room {
                if out.is_empty() {
                    return Err(GeneralStatus::ReplyDataTooLarge.into());
                }
                return Err(Refusal { data: out, ..Refusal::from(GeneralStatus::PartialTransfer) });
            }
            out.extend(entry);
        }
        Ok(out)
    }

    /// Those of a program, or those of the controller and its programs, by their numbers.
    fn symbols(&self, program: Option<&[u8]>) -> Vec<(u32, Symbol<'_>)> {
        let numbered = (1_u32..).zip(&self.tags).filter(|(_, tag)| tag.access != TagAccess::None);
        let same = |tag: &Tag| match (tag.program(), program) {
            (Some((own, _)), Some(program)) => own.as_bytes().eq_ignore_ascii_case(program),
            (own, program) => own.is_none() && program.is_none(),
        };
        let mut all: Vec<_> =
            numbered.filter(|(_, tag)| same(tag)).map(|(number, tag)| (number, Symbol::Tag(tag))).collect();
        if program.is_none() {
            let mut names: Vec<&str> = Vec::new();
            for (name, _) in self.tags.iter().filter_map(Tag::program) {
                if !names.contains(&name) {
                    names.push(name);
                }
            }
            let first = u32::try_from(self.tags.len()).unwrap_or(u32::MAX).saturating_add(1);
            all.extend((first..).zip(names).map(|(number, name)| (number, Symbol::Program(name))));
        }
        all
    }

    fn attribute(&self, symbol: &Symbol<'_>, number: u16) -> Option<Vec<u8>> {
        let (name, kind, size, dimensions, access) = match symbol {
            Symbol::Program(name) => (*name, PROGRAM_SYMBOL, 0, [0; 3], TagAccess::Write),
            Symbol::Tag(tag) => {
                let size = tag.kind.element().size(self.dialect);
                (
                    tag.short_name(),
                    self.symbol_type(&tag.kind)?,
                    size,
                    dimensions(&tag.kind, self.dialect),
                    tag.access,
                )
            }
        };
        Some(match number {
            1 => {
                let length = u16::try_from(name.len()).ok()?;
                [&length.to_le_bytes()[..], name.as_bytes()].concat()
            }
            2 => kind.to_le_bytes().to_vec(),
            3 | 5 => 0_u32.to_le_bytes().to_vec(),
            6 => BASE_TAG.to_le_bytes().to_vec(),
            7 => u16::try_from(size).ok()?.to_le_bytes().to_vec(),
            8 => dimensions.iter().flat_map(|length| length.to_le_bytes()).collect(),
            10 => alloc::vec![match access {
                TagAccess::Write => 0,
                TagAccess::Read => 2,
                TagAccess::None => 3,
            }],
            _ => return None,
        })
    }

    /// Type code or number of the template, and how many dimensions.
    pub(super) fn symbol_type(&self, kind: &Type) -> Option<u16> {
        let dimensions = match kind {
            Type::Array(_, dimensions) => u16::try_from(dimensions.each().len()).ok()?,
            _ => 0,
        };
        let code = match (kind, kind.element()) {
            (Type::Array(..), Type::Elementary(Elementary::Bool)) if self.dialect == Dialect::Logix => {
                Elementary::Dword.code().into()
            }
            (_, Type::Elementary(kind)) => kind.code().into(),
            (_, Type::String(_)) if self.dialect == Dialect::Micro800 => 0xDA,
            (_, element) => STRUCTURE | self.template_number(element)?,
        };
        Some(code | dimensions << DIMENSIONS_SHIFT)
    }
}

/// Lengths of up to three dimensions; of BOOLs of a Logix: in DWORDs.
fn dimensions(kind: &Type, dialect: Dialect) -> [u32; 3] {
    let mut lengths = [0; 3];
    let Type::Array(element, dimensions) = kind else { return lengths };
    let packed = **element == Type::Elementary(Elementary::Bool) && dialect == Dialect::Logix;
    for (to, from) in lengths.iter_mut().zip(dimensions.each()) {
        *to = if packed { from.length.div_ceil(32) } else { from.length };
    }
    lengths
}
