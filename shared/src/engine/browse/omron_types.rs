//! What a structure of an Omron is made of: class 6C, one instance for each type and each member.
//!
//! Get_Attributes_All: `UDINT size | 1 byte | USINT type | USINT type of the elements | USINT dimensions | UDINT length of
//! each | UINT members | 4 bytes | UINT CRC | USINT length | name | [00 if the length is even] | UDINT next member | UDINT
//! what is inside | UDINT first index of each`. What is inside of a structure is its first member; a structure without
//! members of its own is the one that is inside. Source: read in aphyt, n_series.py.

use alloc::boxed::Box;
use alloc::collections::BTreeMap;
use alloc::string::{String, ToString};
use alloc::sync::Arc;
use alloc::vec::Vec;

use super::variables::{ARRAY, STRUCTURES, dimensions, element};
use super::{Answer, Step};
use crate::tag::{Dimension, Dimensions, Member, Structure, Type};
use crate::wire::{ClassCode, DecodeError, Epath, MessageRouterRequest, Reader, ServiceCode};

/// Our own limits: no program has more.
const MAX_OBJECTS: usize = 4_096;
const MAX_DEPTH: usize = 16;

#[derive(Debug)]
pub(super) struct OmronTypes {
    root: u32,
    open: Vec<u32>,
    objects: BTreeMap<u32, Object>,
}

/// A type, or a member.
#[derive(Debug)]
struct Object {
    size: u32,
    code: u8,
    element: u8,
    dims: Vec<Dimension>,
    members: u16,
    crc: u16,
    name: String,
    next: u32,
    inside: u32,
}

impl OmronTypes {
    pub(super) fn new(root: u32) -> Self {
        Self { root, open: alloc::vec![root], objects: BTreeMap::new() }
    }

    pub(super) fn request(&self) -> Option<MessageRouterRequest> {
        let path = Epath::object(ClassCode::Template.0, *self.open.last()?);
        MessageRouterRequest::new(ServiceCode::GetAttributesAll, path, Vec::new()).ok()
    }

    pub(super) fn take(&mut self, answer: &Answer<'_>, kind: &mut Option<Type>) -> Result<Step, String> {
        let Some(id) = self.open.pop() else { return Ok(Step::Done) };
        if answer.is_refused() {
            return Err(alloc::format!("type {id} cannot be read: {}", answer.in_words()));
        }
        let object = Object::read(answer.data).map_err(|error| error.to_string())?;
        let inside = if object.leads_on() { object.inside } else { 0 };
        for next in [object.next, inside] {
            if next != 0 && next != id && !self.objects.contains_key(&next) && !self.open.contains(&next) {
                self.open.push(next);
            }
        }
        self.objects.insert(id, object);
        if self.objects.len() > MAX_OBJECTS {
            return Err(alloc::format!("type {} has too many members", self.root));
        }
        if self.open.is_empty() {
            *kind = Some(self.structure(self.root, 0)?);
            return Ok(Step::Done);
        }
        Ok(Step::More)
    }

    fn object(&self, id: u32, depth: usize) -> Result<&Object, String> {
        let object = self.objects.get(&id).filter(|_| depth < MAX_DEPTH);
        object.ok_or_else(|| alloc::format!("type {id} cannot be put together"))
    }

    fn structure(&self, id: u32, depth: usize) -> Result<Type, String> {
        let object = self.object(id, depth)?;
        if object.members == 0 && object.inside != 0 && object.inside != id {
            return self.structure(object.inside, depth + 1);
        }
        let mut members = Vec::new();
        let mut next = object.inside;
        while next != 0 && members.len() < usize::from(object.members) {
            let member = self.object(next, depth)?;
            members.push(Member { name: member.name.clone(), kind: self.member(next, depth)?, place: None });
            next = member.next;
        }
        let (name, handle, size) = (object.name.clone(), Some(object.crc), Some(object.size));
        Ok(Type::Structure(Arc::new(Structure { name, members, handle, size })))
    }

    fn member(&self, id: u32, depth: usize) -> Result<Type, String> {
        let object = self.object(id, depth)?;
        let unknown = || alloc::format!("{}: type {:#04x} is not known", object.name, object.of_elements());
        let element = if STRUCTURES.contains(&object.of_elements()) {
            let of = if object.code == ARRAY || object.members == 0 { object.inside } else { id };
            self.structure(of, depth + 1)?
        } else {
            element(object.of_elements(), object.size).ok_or_else(unknown)?
        };
        if object.dims.is_empty() {
            return Ok(element);
        }
        let dimensions = Dimensions::new(object.dims.clone()).ok_or_else(unknown)?;
        Ok(Type::Array(Box::new(element), dimensions))
    }
}

impl Object {
    fn read(data: &[u8]) -> Result<Self, DecodeError> {
        let mut reader = Reader::new(data);
        let size = reader.u32()?;
        reader.u8()?;
        let (code, element, count) = (reader.u8()?, reader.u8()?, reader.u8()?);
        let lengths = (0..count).map(|_| reader.u32()).collect::<Result<Vec<_>, _>>()?;
        let members = reader.u16()?;
        reader.u32()?;
        let crc = reader.u16()?;
        let length = usize::from(reader.u8()?);
        let name = String::from_utf8_lossy(reader.take(length)?).into_owned();
        if length.is_multiple_of(2) {
            reader.u8()?;
        }
        let (next, inside) = (reader.u32()?, reader.u32()?);
        let dims = dimensions(&lengths, &mut reader);
        Ok(Self { size, code, element, dims, members, crc, name, next, inside })
    }

    /// The type code, of the elements of an array.
    const fn of_elements(&self) -> u8 {
        if self.code == ARRAY { self.element } else { self.code }
    }

    /// Whether there is something inside to look at.
    fn leads_on(&self) -> bool {
        STRUCTURES.contains(&self.of_elements())
    }
}
