//! Template object, class 6C of a Logix: what structures are made of.
//!
//! Attributes: 1 handle, 2 number of members, 4 size of the definition in words, 5 size of the structure in bytes. Read
//! Tag with `UDINT offset | UINT bytes` gives the definition: `UINT bit or elements | UINT type | UDINT offset` of each
//! member, then the names, each ended by a zero: the structure's own with `;n` behind it, those of the members. BOOLs
//! have a hidden SINT before them. Sources: pycomm3 logix_driver.py, pylogix eip.py.

use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;

use crate::sim::attribute;
use crate::sim::request::{Head, Refusal};
use crate::tag::{Dialect, Elementary, LOGIX_STRING, Layout, Structure, Type};
use crate::wire::{GeneralStatus, Reader, ServiceCode};

use super::memory::TagMemory;
use super::object::Object;

/// Numbers from 0x100 to 0xEFF are the user's (pycomm3).
const FIRST: u16 = 0x101;

/// The number of the structure that STRING is, and its internal name.
const STRING: u16 = LOGIX_STRING;
const STRING_NAME: &str = "ASCIISTRING82";

/// A one-dimensional array in a member's type.
const ARRAY: u16 = 0x2000;
const STRUCTURE: u16 = 0x8000;

/// What clients take off the size of the definition: 1756-PM020 says 23 bytes, pycomm3 takes 21.
const OVERHEAD: usize = 23;

struct Template {
    handle: u16,
    members: u16,
    size: u32,
    /// Of the definition, with what clients take off.
    words: u32,
    definition: Vec<u8>,
}

struct Described {
    name: String,
    info: u16,
    kind: u16,
    offset: u32,
    hidden: bool,
}

impl TagMemory {
    /// Answers of class 6C.
    pub(super) fn template(
        &self,
        head: &Head<'_>,
        object: &Object<'_>,
        room: usize,
    ) -> Result<Vec<u8>, Refusal> {
        let template = self.find_template(object.instance).ok_or(GeneralStatus::PathDestinationUnknown)?;
        match head.service {
            ServiceCode::GetAttributeList => attribute::list(head.data, |number| template.attribute(number)),
            ServiceCode::GetAttributeSingle => {
                let number = object.attribute.unwrap_or_default();
                Ok(template.attribute(number).ok_or(GeneralStatus::AttributeNotSupported)?)
            }
            ServiceCode::ReadTag => template.read(head.data, room),
            _ => Err(GeneralStatus::ServiceNotSupported.into()),
        }
    }

    /// The number of a structure's template; a STRING is a structure, too.
    pub(super) fn template_number(&self, kind: &Type) -> Option<u16> {
        match kind {
            Type::String(_) => Some(STRING),
            Type::Structure(structure) => {
                u16::try_from(self.structures.position(structure)?).ok()?.checked_add(FIRST)
            }
            _ => None,
        }
    }

    fn find_template(&self, number: u32) -> Option<Template> {
        let number = u16::try_from(number).ok()?;
        if number == STRING && self.dialect == Dialect::Logix {
            return Some(string());
        }
        let structure = self.structures.all().get(usize::from(number.checked_sub(FIRST)?))?;
        let members = self.members(structure)?;
        let scopes: String = members.iter().map(|member| if member.hidden { "E@" } else { "EB" }).collect();
        let name = format!("{};n{scopes}", structure.name);
        let size = u32::try_from(Layout::of(structure, self.dialect).size).ok()?;
        Some(Template::new(structure.handle?, size, &name, &members))
    }

    fn members(&self, structure: &Structure) -> Option<Vec<Described>> {
        let mut all: Vec<Described> = Vec::new();
        for (member, place) in structure.members.iter().zip(Layout::of(structure, self.dialect).places) {
            let (info, kind) = match (place.bit, &member.kind) {
                (Some(bit), _) => {
                    if bit == 0 {
                        let name = format!("ZZZZZZZZZZ{}{}", structure.name, all.len());
                        let kind = Elementary::Sint.code().into();
                        all.push(Described { name, info: 0, kind, offset: place.offset, hidden: true });
                    }
                    (bit.into(), Elementary::Bool.code().into())
                }
                (None, Type::Array(element, _)) => {
                    let count = u16::try_from(member.kind.elements(self.dialect)).ok()?;
                    let packed =
                        **element == Type::Elementary(Elementary::Bool) && self.dialect == Dialect::Logix;
                    let code =
                        if packed { Elementary::Dword.code().into() } else { self.member_type(element)? };
                    (count, ARRAY | code)
                }
                (None, kind) => (0, self.member_type(kind)?),
            };
            all.push(Described {
                name: member.name.clone(),
                info,
                kind,
                offset: place.offset,
                hidden: false,
            });
        }
        Some(all)
    }

    fn member_type(&self, kind: &Type) -> Option<u16> {
        match kind {
            Type::Elementary(kind) => Some(kind.code().into()),
            other => Some(STRUCTURE | self.template_number(other)?),
        }
    }
}

/// The structure of a STRING.
fn string() -> Template {
    let member =
        |name: &str, info, kind, offset| Described { name: name.into(), info, kind, offset, hidden: false };
    let length = member("LEN", 0, Elementary::Dint.code().into(), 0);
    let capacity = Dialect::Logix.string_capacity();
    let data = member("DATA", capacity, ARRAY | u16::from(Elementary::Sint.code()), 4);
    let size = u32::try_from(Type::String(None).size(Dialect::Logix)).unwrap_or_default();
    Template::new(LOGIX_STRING, size, STRING_NAME, &[length, data])
}

impl Template {
    fn new(handle: u16, size: u32, name: &str, members: &[Described]) -> Self {
        let mut definition = Vec::new();
        for member in members {
            definition.extend_from_slice(&member.info.to_le_bytes());
            definition.extend_from_slice(&member.kind.to_le_bytes());
            definition.extend_from_slice(&member.offset.to_le_bytes());
        }
        for name in core::iter::once(name).chain(members.iter().map(|member| member.name.as_str())) {
            definition.extend_from_slice(name.as_bytes());
            definition.push(0);
        }
        // Whichever number of bytes a client takes off, it finds what it asks for.
        let words = (definition.len() + OVERHEAD).div_ceil(4);
        definition.resize(4 * words - (OVERHEAD - 3), 0);
        let members = u16::try_from(members.len()).unwrap_or(u16::MAX);
        Self { handle, members, size, words: u32::try_from(words).unwrap_or(u32::MAX), definition }
    }

    fn attribute(&self, number: u16) -> Option<Vec<u8>> {
        Some(match number {
            1 => self.handle.to_le_bytes().to_vec(),
            2 => self.members.to_le_bytes().to_vec(),
            // Not described anywhere; pylogix asks for it and steps over two bytes.
            3 => 0_u16.to_le_bytes().to_vec(),
            4 => self.words.to_le_bytes().to_vec(),
            5 => self.size.to_le_bytes().to_vec(),
            _ => return None,
        })
    }

    /// What is there of the bytes that are asked for; status 06 if they do not fit.
    fn read(&self, data: &[u8], room: usize) -> Result<Vec<u8>, Refusal> {
        let mut reader = Reader::new(data);
        let short = |_| GeneralStatus::NotEnoughData;
        let offset = usize::try_from(reader.u32().map_err(short)?).unwrap_or(usize::MAX);
        let wanted = usize::from(reader.u16().map_err(short)?);
        reader.finish().map_err(|_| GeneralStatus::TooMuchData)?;
        let rest = self.definition.get(offset..).filter(|rest| !rest.is_empty());
        let rest = rest.ok_or(GeneralStatus::InvalidParameter)?;
        let wanted = rest.get(..wanted).unwrap_or(rest);
        match wanted.get(..room) {
            Some(part) if part.len() < wanted.len() => {
                Err(Refusal { data: part.to_vec(), ..Refusal::from(GeneralStatus::PartialTransfer) })
            }
            _ => Ok(wanted.to_vec()),
        }
    }
}
