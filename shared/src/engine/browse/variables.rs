//! The variables of an Omron NJ or NX that are published.
//!
//! Names: class 6A, service 5F, `UDINT from | UDINT count | UINT kind (1 system, 2 user)` gives `UINT count | USINT more |
//! 00`, then of each `UDINT number | UINT length | UINT class | UDINT instance | USINT length | name`. Types: class 6B,
//! that instance, Get_Attributes_All: `UDINT size (of an element) | USINT type | USINT type of the elements | USINT
//! dimensions | 00 | UDINT length of each | 12 bytes | UDINT structure | UDINT first index of each`. Source: read in
//! aphyt, n_series.py; for a name instead of an instance it takes the structure from the first of the 12 bytes, so that
//! is looked at as well.

use alloc::collections::VecDeque;
use alloc::string::{String, ToString};
use alloc::vec::Vec;

use super::symbol::Symbol;
use super::{Answer, BrowseWhat, Step};
use crate::tag::{Dialect, Dimension, Elementary, Type};
use crate::wire::{ClassCode, DecodeError, Epath, MessageRouterRequest, Reader, ServiceCode};

/// Class 6A: the names.
const NAMES: u16 = 0x6A;

/// Its service.
const LIST: ServiceCode = ServiceCode(0x5F);

/// So many names are asked for at a time, as aphyt does.
const PAGE: u32 = 100;

/// Kinds of variables, in the order in which they are listed.
const USER: u16 = 2;
const SYSTEM: u16 = 1;

pub(super) const STRUCTURES: [u8; 2] = [0xA0, 0xA2];
pub(super) const ARRAY: u8 = 0xA3;
pub(super) const STRING: u8 = 0xD0;

#[derive(Debug)]
pub(super) struct Variables {
    /// Which are listed now.
    kind: u16,
    with_system: bool,
    from: u32,
    /// The device has said that there are no more of this kind.
    is_last: bool,
    /// Names whose types are not known yet, with their instances of class 6B.
    open: VecDeque<(u32, String)>,
}

impl Variables {
    pub(super) fn new(what: BrowseWhat) -> Self {
        let with_system = what == BrowseWhat::WithSystem;
        Self { kind: USER, with_system, from: 1, is_last: false, open: VecDeque::new() }
    }

    pub(super) fn request(&self) -> Option<MessageRouterRequest> {
        if let Some((instance, _)) = self.open.front() {
            let path = Epath::object(ClassCode::Symbol.0, *instance);
            return MessageRouterRequest::new(ServiceCode::GetAttributesAll, path, Vec::new()).ok();
        }
        let data = [&self.from.to_le_bytes()[..], &PAGE.to_le_bytes(), &self.kind.to_le_bytes()].concat();
        MessageRouterRequest::new(LIST, Epath::object(NAMES, 0), data).ok()
    }

    pub(super) fn take(&mut self, answer: &Answer<'_>, found: &mut Vec<Symbol>) -> Result<Step, String> {
        match self.open.pop_front() {
            Some((_, name)) => found.push(symbol(name, answer)),
            None if answer.is_refused() => {
                return Err(alloc::format!("the device does not list its variables: {}", answer.in_words()));
            }
            None => self.names(answer.data).map_err(|error| error.to_string())?,
        }
        if !self.open.is_empty() || !self.is_last {
            return Ok(Step::More);
        }
        if self.kind == USER && self.with_system {
            (self.kind, self.from, self.is_last) = (SYSTEM, 1, false);
            return Ok(Step::More);
        }
        Ok(Step::Done)
    }

    fn names(&mut self, data: &[u8]) -> Result<(), DecodeError> {
        let mut reader = Reader::new(data);
        let count = reader.u16()?;
        let more = reader.u8()?;
        reader.u8()?;
        for _ in 0..count {
            reader.u32()?;
            let length = usize::from(reader.u16()?);
            let mut entry = reader.sub(length)?;
            entry.u16()?;
            let instance = entry.u32()?;
            let length = usize::from(entry.u8()?);
            self.open.push_back((instance, String::from_utf8_lossy(entry.take(length)?).into_owned()));
        }
        self.is_last = more == 0 || count == 0;
        self.from = self.from.saturating_add(count.into());
        Ok(())
    }
}

fn symbol(name: String, answer: &Answer<'_>) -> Symbol {
    if answer.is_refused() {
        return Symbol { type_text: answer.in_words(), ..Symbol::of_unknown(name, Vec::new()) };
    }
    match Described::read(answer.data) {
        Ok(described) => described.symbol(name),
        Err(error) => Symbol { type_text: error.to_string(), ..Symbol::of_unknown(name, Vec::new()) },
    }
}

/// The attributes of a variable.
struct Described {
    /// Of an element.
    size: u32,
    /// Of the elements of an array.
    code: u8,
    dims: Vec<Dimension>,
    structure: u32,
}

impl Described {
    fn read(data: &[u8]) -> Result<Self, DecodeError> {
        let mut reader = Reader::new(data);
        let size = reader.u32()?;
        let (code, element, count) = (reader.u8()?, reader.u8()?, reader.u8()?);
        reader.u8()?;
        let lengths = (0..count).map(|_| reader.u32()).collect::<Result<Vec<_>, _>>()?;
        // A reply may end here for what is no structure.
        let mut rest = reader.clone();
        let first = rest.u32().unwrap_or(0);
        let structure = rest.take(8).and_then(|_| rest.u32()).ok().filter(|it| *it != 0).unwrap_or(first);
        let dims = dimensions(&lengths, &mut rest);
        Ok(Self { size, code: if code == ARRAY { element } else { code }, dims, structure })
    }

    fn symbol(&self, name: String) -> Symbol {
        let dims = self.dims.clone();
        if STRUCTURES.contains(&self.code) {
            return Symbol::of_template(name, self.structure, dims);
        }
        match element(self.code, self.size) {
            Some(element) => Symbol::of_kind(name, element, dims),
            None => Symbol {
                type_text: alloc::format!("type {:#04x}", self.code),
                ..Symbol::of_unknown(name, dims)
            },
        }
    }
}

/// With the first index of each, where the device says it.
pub(super) fn dimensions(lengths: &[u32], rest: &mut Reader<'_>) -> Vec<Dimension> {
    lengths.iter().map(|length| Dimension { first: rest.u32().unwrap_or(0), length: *length }).collect()
}

/// A type that is no structure; `size`: bytes of an element.
pub(super) fn element(code: u8, size: u32) -> Option<Type> {
    match code {
        STRING => Some(Type::String(u16::try_from(size).ok().filter(|size| *size > 0))),
        code => Elementary::of_code(Dialect::Omron, code).map(Type::Elementary),
    }
}
