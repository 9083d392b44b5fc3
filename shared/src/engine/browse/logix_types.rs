//! What a structure of a Logix is made of: class 6C.
//!
//! First Get_Attribute_List of 4 (length of the definition in words), 5 (bytes of the structure), 2 (members), 1 (handle).
//! Then Read Tag with `UDINT offset | UINT bytes`, until all is there (status 06: more follows): `UINT bit or elements |
//! UINT type | UDINT offset` of each member, then names that end with a zero: the structure's, cut at `;`, and those of
//! the members. 23 bytes of the definition's length are not sent (1756-PM020; pycomm3 takes 21, so that is asked for:
//! whoever has less sends less). Sources: pycomm3 logix_driver.py, pylogix eip.py.

use alloc::boxed::Box;
use alloc::collections::BTreeMap;
use alloc::string::{String, ToString};
use alloc::sync::Arc;
use alloc::vec::Vec;

use super::{Answer, Step};
use crate::tag::{Dialect, Dimensions, Elementary, LOGIX_STRING, Member, Place, Structure, Type};
use crate::wire::{ClassCode, DecodeError, Epath, GeneralStatus, MessageRouterRequest, Reader, ServiceCode};

/// Attributes, and in this order.
const WORDS: u16 = 4;
const SIZE: u16 = 5;
const MEMBERS: u16 = 2;
const HANDLE: u16 = 1;

/// Bytes of the definition's length that are not sent.
const OVERHEAD: u32 = 21;

const STRUCTURE: u16 = 0x8000;
const ARRAY: u16 = 0x6000;

/// Numbers of structures that people have made; others are the system's (pycomm3).
const OWN: core::ops::RangeInclusive<u32> = 0x100..=0xEFF;

/// Our own limits: no program has more.
const MAX_TYPES: usize = 256;
const MAX_DEPTH: usize = 16;

#[derive(Debug)]
pub(super) struct LogixTypes {
    root: u32,
    /// To be read.
    open: Vec<u32>,
    /// What is known of the one that is being read.
    head: Option<Head>,
    definition: Vec<u8>,
    types: BTreeMap<u32, Definition>,
}

#[derive(Clone, Copy, Debug)]
struct Head {
    bytes: u32,
    size: u32,
    members: u16,
    handle: u16,
}

#[derive(Debug)]
struct Definition {
    head: Head,
    name: String,
    members: Vec<Described>,
}

#[derive(Debug)]
struct Described {
    name: String,
    info: u16,
    kind: u16,
    offset: u32,
}

impl LogixTypes {
    pub(super) fn new(root: u32) -> Self {
        let open = alloc::vec![root];
        Self { root, open, head: None, definition: Vec::new(), types: BTreeMap::new() }
    }

    pub(super) fn request(&self) -> Option<MessageRouterRequest> {
        let path = Epath::object(ClassCode::Template.0, *self.open.last()?);
        let Some(head) = self.head else {
            let numbers = [4, WORDS, SIZE, MEMBERS, HANDLE];
            let data = numbers.iter().flat_map(|number| number.to_le_bytes()).collect();
            return MessageRouterRequest::new(ServiceCode::GetAttributeList, path, data).ok();
        };
        let offset = u32::try_from(self.definition.len()).ok()?;
        let left = u16::try_from(head.bytes.saturating_sub(offset)).unwrap_or(u16::MAX);
        let data = [&offset.to_le_bytes()[..], &left.to_le_bytes()].concat();
        MessageRouterRequest::new(ServiceCode::ReadTag, path, data).ok()
    }

    pub(super) fn take(&mut self, answer: &Answer<'_>, kind: &mut Option<Type>) -> Result<Step, String> {
        let Some(id) = self.open.last().copied() else { return Ok(Step::Done) };
        if answer.is_refused() {
            return Err(alloc::format!("structure {id} cannot be read: {}", answer.in_words()));
        }
        let Some(head) = self.head else {
            self.head = Some(Head::read(answer.data).map_err(|error| error.to_string())?);
            return Ok(Step::More);
        };
        self.definition.extend_from_slice(answer.data);
        let more = answer.status == GeneralStatus::PartialTransfer && !answer.data.is_empty();
        if more && u32::try_from(self.definition.len()).is_ok_and(|length| length < head.bytes) {
            return Ok(Step::More);
        }
        let definition = Definition::read(id, head, &self.definition).map_err(|error| error.to_string())?;
        (self.head, self.definition) = (None, Vec::new());
        self.open.pop();
        for inner in definition.members.iter().filter_map(Described::template) {
            if inner != id && !self.types.contains_key(&inner) && !self.open.contains(&inner) {
                self.open.push(inner);
            }
        }
        self.types.insert(id, definition);
        if self.types.len() > MAX_TYPES {
            return Err(alloc::format!("structure {id} has too many others in it"));
        }
        if self.open.is_empty() {
            *kind = Some(self.build(self.root, 0)?);
            return Ok(Step::Done);
        }
        Ok(Step::More)
    }

    fn build(&self, id: u32, depth: usize) -> Result<Type, String> {
        let unknown = || alloc::format!("structure {id} cannot be put together");
        let definition = self.types.get(&id).filter(|_| depth < MAX_DEPTH).ok_or_else(unknown)?;
        let mut members = Vec::new();
        for member in definition.members.iter().filter(|member| !member.is_hidden(id)) {
            let element = match member.template() {
                Some(template) => self.build(template, depth + 1)?,
                None => member.element().ok_or_else(|| {
                    alloc::format!(
                        "{}.{}: type {:#06x} is not known",
                        definition.name,
                        member.name,
                        member.kind
                    )
                })?,
            };
            members.push(member.place(element)?);
        }
        let Head { size, handle, .. } = definition.head;
        if let Some(text) = text(&members, handle) {
            return Ok(text);
        }
        let name = definition.name.clone();
        Ok(Type::Structure(Arc::new(Structure { name, members, handle: Some(handle), size: Some(size) })))
    }
}

/// A STRING is a structure of its length and its characters.
fn text(members: &[Member], handle: u16) -> Option<Type> {
    let [length, data] = members else { return None };
    let Type::Array(element, dimensions) = &data.kind else { return None };
    let is_text =
        length.name == "LEN" && data.name == "DATA" && **element == Type::Elementary(Elementary::Sint);
    let capacity = u16::try_from(dimensions.count()).ok().filter(|_| is_text)?;
    Some(Type::String((handle != LOGIX_STRING).then_some(capacity)))
}

impl Head {
    fn read(data: &[u8]) -> Result<Self, DecodeError> {
        let mut reader = Reader::new(data);
        reader.u16()?;
        let mut next = |wide: bool| -> Result<u32, DecodeError> {
            reader.u16()?;
            reader.u16()?;
            if wide { reader.u32() } else { reader.u16().map(u32::from) }
        };
        let (words, size, members, handle) = (next(true)?, next(true)?, next(false)?, next(false)?);
        let short = |number: u32| u16::try_from(number).unwrap_or(u16::MAX);
        let bytes = words.saturating_mul(4).saturating_sub(OVERHEAD);
        Ok(Self { bytes, size, members: short(members), handle: short(handle) })
    }
}

impl Definition {
    fn read(id: u32, head: Head, data: &[u8]) -> Result<Self, DecodeError> {
        let mut reader = Reader::new(data);
        let mut members = Vec::new();
        for _ in 0..head.members {
            let (info, kind, offset) = (reader.u16()?, reader.u16()?, reader.u32()?);
            members.push(Described { name: String::new(), info, kind, offset });
        }
        let names: Vec<&[u8]> = reader.rest().split(|byte| *byte == 0).collect();
        let own = names.iter().position(|name| name.contains(&b';')).unwrap_or(0);
        let mut name = alloc::format!("structure {id}");
        let mut others = members.iter_mut();
        for (place, bytes) in names.iter().enumerate() {
            let text = String::from_utf8_lossy(bytes);
            if place == own {
                name = text.split(';').next().unwrap_or_default().to_string();
            } else if let Some(member) = others.next() {
                member.name = text.into_owned();
            }
        }
        Ok(Self { head, name, members })
    }
}

impl Described {
    /// The number of its structure.
    fn template(&self) -> Option<u32> {
        (self.kind & STRUCTURE != 0).then_some(u32::from(self.kind & 0x0FFF))
    }

    /// What BOOLs share, and what only the controller uses (pycomm3).
    fn is_hidden(&self, id: u32) -> bool {
        let is_own = OWN.contains(&id);
        self.name.is_empty()
            || self.name.starts_with("ZZZZZZZZZZ")
            || self.name.starts_with("__")
            || (!is_own && ["CTL", "Control"].contains(&self.name.as_str()))
    }

    fn is_packed(&self) -> bool {
        let [code, _] = self.kind.to_le_bytes();
        self.kind & ARRAY != 0 && code == Elementary::Dword.code()
    }

    fn element(&self) -> Option<Type> {
        let [code, _] = self.kind.to_le_bytes();
        let code = if self.is_packed() { Elementary::Bool.code() } else { code };
        Elementary::of_code(Dialect::Logix, code).map(Type::Elementary)
    }

    fn place(&self, element: Type) -> Result<Member, String> {
        let is_array = self.kind & ARRAY != 0;
        let is_bit = !is_array && element == Type::Elementary(Elementary::Bool);
        let bit = u8::try_from(self.info).ok().filter(|_| is_bit);
        // A bit may be counted beyond its byte.
        let beyond = u32::from(bit.unwrap_or(0) / 8);
        let place = Place { offset: self.offset.saturating_add(beyond), bit: bit.map(|bit| bit % 8) };
        let kind = if is_array {
            let length = u32::from(self.info) * if self.is_packed() { 32 } else { 1 };
            let dimensions =
                Dimensions::of_length(length).ok_or_else(|| alloc::format!("{}: no elements", self.name))?;
            Type::Array(Box::new(element), dimensions)
        } else {
            element
        };
        Ok(Member { name: self.name.clone(), kind, place: Some(place) })
    }
}
