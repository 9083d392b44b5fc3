//! Requests to the objects that describe tags.

use crate::sim::request::Head;
use crate::tag::Dialect;
use crate::wire::{ClassCode, LogicalKind, Segment, ServiceCode};

use super::address::is_program;

/// Which object a request is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Object<'a> {
    /// Logix: the program whose symbols are meant.
    pub(super) program: Option<&'a [u8]>,
    pub(super) class: ClassCode,
    pub(super) instance: u32,
    pub(super) attribute: Option<u16>,
}

/// Omron: names of variables (aphyt: class 6A).
pub(super) const TAG_NAMES: ClassCode = ClassCode(0x6A);

/// Logix: the name of the project (pycomm3: class 64).
pub(super) const PROGRAM_NAME: ClassCode = ClassCode(0x64);

impl<'a> Object<'a> {
    /// `None`: the request is about something else.
    pub(super) fn of(head: &'a Head<'_>, dialect: Dialect) -> Option<Self> {
        let mut segments = head.path.segments();
        let mut program = None;
        if let Some((Segment::Symbol(symbol), rest)) = segments.split_first() {
            program = Some(symbol.name()).filter(|name| dialect == Dialect::Logix && is_program(name));
            program?;
            segments = rest;
        }
        let number = |index: usize, kind| match segments.get(index) {
            Some(Segment::Logical(logical)) if logical.kind == kind => Some(logical.value),
            _ => None,
        };
        let class = ClassCode(u16::try_from(number(0, LogicalKind::Class)?).ok()?);
        let instance = number(1, LogicalKind::Instance)?;
        let attribute = match segments.len() {
            2 => None,
            3 => Some(u16::try_from(number(2, LogicalKind::Attribute)?).ok()?),
            _ => return None,
        };
        let known = match dialect {
            // Instances of symbols are tags, too: what reads and writes them goes there.
            Dialect::Logix | Dialect::Micro800 if class == ClassCode::Symbol => {
                is_about_attributes(head.service)
            }
            Dialect::Logix => [ClassCode::Template, PROGRAM_NAME].contains(&class),
            Dialect::Micro800 => class == ClassCode::Template,
            Dialect::Omron => [TAG_NAMES, ClassCode::Symbol, ClassCode::Template].contains(&class),
        };
        known.then_some(Self { program, class, instance, attribute })
    }
}

fn is_about_attributes(service: ServiceCode) -> bool {
    [
        ServiceCode::GetAttributesAll,
        ServiceCode::GetAttributeList,
        ServiceCode::GetAttributeSingle,
        ServiceCode::GetInstanceAttributeList,
    ]
    .contains(&service)
}
