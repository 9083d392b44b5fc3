//! The tags of a Logix or a Micro800: Get_Instance_Attribute_List of class 6B.
//!
//! Request: `UINT count | UINT attribute[count]`, to the first instance that is wanted, with the program's name before the
//! class. Reply: `UDINT instance | the attributes` of each; status 06 means that more follow behind the last instance.
//! Attributes: 1 name (`UINT length | characters`), 2 type, 8 three lengths as UDINT, 10 external access. Type: bit 15 a
//! structure, bits 14 and 13 how many dimensions, bit 12 the system's, bits 11 to 0 the structure's number or the type
//! code. Sources: pycomm3 logix_driver.py, pylogix eip.py (which asks a Micro800 in the same way), libplctag
//! eip_cip_special.c. Attribute 10 is there since firmware 18 (pycomm3); who refuses it is asked without.

use alloc::collections::VecDeque;
use alloc::string::{String, ToString};
use alloc::vec::Vec;

use super::symbol::{Access, Symbol};
use super::{Answer, BrowseWhat, Step};
use crate::tag::{Dialect, Dimension, Elementary, LOGIX_STRING, Type};
use crate::wire::{
    ClassCode, DecodeError, Epath, GeneralStatus, LogicalKind, MessageRouterRequest, Reader, Segment,
    ServiceCode, SymbolSegment,
};

const NAME: u16 = 1;
const TYPE: u16 = 2;
const DIMENSIONS: u16 = 8;
const EXTERNAL_ACCESS: u16 = 10;

const STRUCTURE: u16 = 0x8000;
const SYSTEM: u16 = 0x1000;
const SHORT_STRING: u8 = 0xDA;

/// What clients leave out: pycomm3, pylogix.
const PROGRAM: &str = "Program:";
const NOT_TAGS: [&str; 5] = ["Routine:", "Task:", "Map:", "Cxn:", "UDI:"];

/// The tags of a module are those behind these. Rockwell 1756-PM004.
const MODULE_TAGS: [&str; 4] = [":I", ":O", ":C", ":S"];

#[derive(Debug)]
pub(super) struct Symbols {
    dialect: Dialect,
    what: BrowseWhat,
    /// Which is being read; `None` = the controller's own.
    scope: Option<String>,
    programs: VecDeque<String>,
    from: u32,
    with_access: bool,
}

/// One entry of a reply.
struct Entry<'a> {
    instance: u32,
    name: &'a [u8],
    kind: u16,
    lengths: [u32; 3],
    access: Option<u8>,
}

impl Symbols {
    pub(super) fn new(dialect: Dialect, what: BrowseWhat) -> Self {
        let with_access = dialect == Dialect::Logix;
        Self { dialect, what, scope: None, programs: VecDeque::new(), from: 0, with_access }
    }

    pub(super) fn scope(&self) -> Option<&str> {
        self.scope.as_deref()
    }

    pub(super) fn request(&self) -> Option<MessageRouterRequest> {
        let mut path = Epath::default();
        if let Some(program) = &self.scope {
            path = path.with(Segment::Symbol(SymbolSegment::new(program.as_bytes())?));
        }
        let path =
            path.then(LogicalKind::Class, ClassCode::Symbol.0.into()).then(LogicalKind::Instance, self.from);
        let wanted = [NAME, TYPE, DIMENSIONS, EXTERNAL_ACCESS];
        let wanted = wanted.get(..if self.with_access { 4 } else { 3 })?;
        let mut data = u16::try_from(wanted.len()).ok()?.to_le_bytes().to_vec();
        data.extend(wanted.iter().flat_map(|number| number.to_le_bytes()));
        MessageRouterRequest::new(ServiceCode::GetInstanceAttributeList, path, data).ok()
    }

    pub(super) fn take(&mut self, answer: &Answer<'_>, found: &mut Vec<Symbol>) -> Result<Step, String> {
        if answer.is_refused() {
            return self.refused(answer);
        }
        let mut reader = Reader::new(answer.data);
        let mut last = None;
        while !reader.is_empty() {
            let entry = Entry::read(&mut reader, self.with_access).map_err(|error| error.to_string())?;
            last = Some(entry.instance);
            self.add(&entry, found);
        }
        if answer.status == GeneralStatus::PartialTransfer {
            let next = last.and_then(|last| last.checked_add(1)).filter(|next| *next > self.from);
            self.from =
                next.ok_or_else(|| "the device says that more follows, but does not go on".to_string())?;
            return Ok(Step::More);
        }
        Ok(self.next_scope())
    }

    fn refused(&mut self, answer: &Answer<'_>) -> Result<Step, String> {
        if self.with_access {
            self.with_access = false;
            return Ok(Step::More);
        }
        if self.scope.is_some() {
            // A program may be empty, or gone since.
            return Ok(self.next_scope());
        }
        Err(alloc::format!("the device does not list its tags: {}", answer.in_words()))
    }

    fn next_scope(&mut self) -> Step {
        self.from = 0;
        self.scope = self.programs.pop_front();
        if self.scope.is_some() { Step::More } else { Step::Done }
    }

    fn add(&mut self, entry: &Entry<'_>, found: &mut Vec<Symbol>) {
        let name = String::from_utf8_lossy(entry.name).into_owned();
        if name.starts_with(PROGRAM) && self.scope.is_none() {
            self.programs.push_back(name);
            return;
        }
        let is_module = MODULE_TAGS.iter().any(|part| name.contains(part));
        let is_other = NOT_TAGS.iter().any(|part| name.contains(part));
        let is_system =
            entry.kind & SYSTEM != 0 || name.starts_with("__") || (name.contains(':') && !is_module);
        if is_other || (is_system && self.what == BrowseWhat::Tags) {
            return;
        }
        let name =
            self.scope.as_ref().map_or_else(|| name.clone(), |program| alloc::format!("{program}.{name}"));
        let access = entry.access.and_then(Access::of_code);
        let note = (access == Some(Access::None)).then_some("not accessible from outside");
        found.push(Symbol { access, note, ..entry.symbol(name, self.dialect) });
    }
}

impl<'a> Entry<'a> {
    fn read(reader: &mut Reader<'a>, with_access: bool) -> Result<Self, DecodeError> {
        let instance = reader.u32()?;
        let length = usize::from(reader.u16()?);
        let name = reader.take(length)?;
        let kind = reader.u16()?;
        let lengths = [reader.u32()?, reader.u32()?, reader.u32()?];
        let access = if with_access { Some(reader.u8()?) } else { None };
        Ok(Self { instance, name, kind, lengths, access })
    }

    fn symbol(&self, name: String, dialect: Dialect) -> Symbol {
        let [code, _] = self.kind.to_le_bytes();
        let count = usize::from(self.kind >> 13 & 0b11);
        // BOOLs of a Logix array are kept in DWORDs, and counted so.
        let is_packed = dialect == Dialect::Logix && code == Elementary::Dword.code() && count > 0;
        let length = |length: u32| if is_packed { length.saturating_mul(32) } else { length };
        let dims: Vec<_> = self
            .lengths
            .iter()
            .take(count)
            .map(|each| Dimension { first: 0, length: length(*each) })
            .collect();
        if self.kind & STRUCTURE != 0 {
            let template = self.kind & 0x0FFF;
            if template == LOGIX_STRING && dialect == Dialect::Logix {
                return Symbol::of_kind(name, Type::String(None), dims);
            }
            let symbol = Symbol::of_template(name, template.into(), dims);
            let is_closed = dialect == Dialect::Micro800;
            let note = is_closed.then_some("a Micro800 does not tell what its structures are made of");
            return Symbol { note, template: symbol.template.filter(|_| !is_closed), ..symbol };
        }
        let element = match code {
            SHORT_STRING => Some(Type::String(None)),
            _ if is_packed => Some(Type::Elementary(Elementary::Bool)),
            code => Elementary::of_code(dialect, code).map(Type::Elementary),
        };
        match element {
            Some(element) => Symbol::of_kind(name, element, dims),
            None => {
                Symbol { type_text: alloc::format!("type {code:#04x}"), ..Symbol::of_unknown(name, dims) }
            }
        }
    }
}

impl Symbol {
    /// Of a type that nobody knows.
    pub(super) fn of_unknown(name: String, dims: Vec<Dimension>) -> Self {
        let note = Some("a type that is not known here");
        Self { name, type_text: String::new(), kind: None, dims, template: None, access: None, note }
    }
}
