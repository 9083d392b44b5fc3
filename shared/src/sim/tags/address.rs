//! What a path names: a tag, and the part of its memory.

use alloc::vec::Vec;

use crate::tag::{Dialect, Elementary, Layout, Type};
use crate::wire::{ClassCode, Epath, LogicalKind, Segment, SimpleDataSegment};

use super::refusal::Wrong;

/// A path to a tag, taken apart.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Address<'a> {
    pub(super) base: Base<'a>,
    /// From the tag to the part.
    pub(super) steps: Vec<Step<'a>>,
    /// Omron: which bytes of it.
    pub(super) bytes: Option<SimpleDataSegment>,
}

/// How a tag is called.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Base<'a> {
    /// By its name.
    Name(&'a [u8]),
    /// By its program and its name.
    Program(&'a [u8], &'a [u8]),
    /// By its number in the Symbol object.
    Instance(u32),
}

/// A member or an index.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Step<'a> {
    Member(&'a [u8]),
    Index(u32),
}

/// What the names of Logix programs begin with.
pub(super) const PROGRAM: &[u8] = b"Program:";

/// Whether a name begins like that of a program.
pub(super) fn is_program(name: &[u8]) -> bool {
    name.get(..PROGRAM.len()).is_some_and(|start| start.eq_ignore_ascii_case(PROGRAM))
}

impl<'a> Address<'a> {
    /// `None`: the path is not that of a tag.
    pub(super) fn of(path: &'a Epath) -> Option<Self> {
        let symbol = |segment: &'a Segment| match segment {
            Segment::Symbol(symbol) => Some(symbol.name()),
            _ => None,
        };
        let logical = |segment: &Segment, kind| match segment {
            Segment::Logical(logical) if logical.kind == kind => Some(logical.value),
            _ => None,
        };
        let segments = path.segments();
        let (first, second) = (segments.first()?, segments.get(1));
        let (base, used) = match (symbol(first), second.and_then(symbol)) {
            (Some(program), Some(name)) if is_program(program) => (Base::Program(program, name), 2),
            (Some(name), _) => (Base::Name(name), 1),
            _ => {
                logical(first, LogicalKind::Class)
                    .filter(|class| *class == u32::from(ClassCode::Symbol.0))?;
                (Base::Instance(logical(second?, LogicalKind::Instance)?), 2)
            }
        };
        let mut address = Self { base, steps: Vec::new(), bytes: None };
        for segment in segments.iter().skip(used) {
            if address.bytes.is_some() {
                return None; // nothing follows a simple data segment
            }
            match segment {
                Segment::Symbol(symbol) => address.steps.push(Step::Member(symbol.name())),
                Segment::SimpleData(bytes) => address.bytes = Some(*bytes),
                other => address.steps.push(Step::Index(logical(other, LogicalKind::Member)?)),
            }
        }
        Some(address)
    }
}

/// A part of a tag's memory: one thing, or the elements of an array from one on.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Part<'a> {
    /// Of one element.
    pub(super) kind: &'a Type,
    /// Where the first element begins.
    pub(super) offset: usize,
    /// Which bit of the byte there, of a BOOL that shares it with others.
    pub(super) bit: Option<u8>,
    /// From one element to the next, in bytes; elements with a bit follow each other bit by bit.
    pub(super) stride: usize,
    /// Elements from the first one to the end.
    pub(super) run: usize,
    /// Whether the elements are those of an array.
    pub(super) array: bool,
    /// Whether the array was named without an index.
    pub(super) whole: bool,
}

/// 32 BOOLs of a Logix array.
const DWORD: Type = Type::Elementary(Elementary::Dword);

impl<'a> Part<'a> {
    /// Follows the steps.
    pub(super) fn find(kind: &'a Type, dialect: Dialect, steps: &[Step<'_>]) -> Result<Self, Wrong> {
        let mut here = Self::single(kind, dialect, 0, None);
        let mut steps = steps;
        while let Some(step) = steps.first() {
            match (step, here.kind) {
                (Step::Member(name), Type::Structure(structure)) => {
                    let name = core::str::from_utf8(name).map_err(|_| Wrong::Missing)?;
                    let mut members = structure.members.iter().zip(Layout::of(structure, dialect).places);
                    let found = members.find(|(member, _)| member.name.eq_ignore_ascii_case(name));
                    let (member, place) = found.ok_or(Wrong::Missing)?;
                    let offset = here.offset + usize::try_from(place.offset).map_err(|_| Wrong::Missing)?;
                    here = Self::single(&member.kind, dialect, offset, place.bit);
                    steps = steps.get(1..).unwrap_or_default();
                }
                (Step::Index(_), Type::Array(..)) => {
                    let elements = here.clone().elements(dialect);
                    let (position, used) = position(here.kind, dialect, steps)?;
                    here = elements.from(position)?;
                    steps = steps.get(used..).unwrap_or_default();
                }
                _ => return Err(Wrong::Missing),
            }
        }
        Ok(here)
    }

    fn single(kind: &'a Type, dialect: Dialect, offset: usize, bit: Option<u8>) -> Self {
        let stride = kind.size(dialect);
        Self { kind, offset, bit, stride, run: 1, array: false, whole: false }
    }

    /// The elements, if it is an array.
    pub(super) fn elements(self, dialect: Dialect) -> Self {
        let Type::Array(element, dimensions) = self.kind else { return self };
        let (element, count): (&Type, usize) = (element, dimensions.count());
        let (kind, run, bit) = match (element, dialect) {
            (Type::Elementary(Elementary::Bool), Dialect::Logix) => (&DWORD, count.div_ceil(32), None),
            (Type::Elementary(Elementary::Bool), Dialect::Omron) => (element, count, Some(0)),
            _ => (element, count, None),
        };
        let stride = kind.size(dialect);
        Self { kind, bit, stride, run, array: true, whole: true, ..self }
    }

    /// The elements from this one on.
    fn from(self, position: usize) -> Result<Self, Wrong> {
        let run = self.run.checked_sub(position).filter(|run| *run > 0).ok_or(Wrong::Outside)?;
        let (offset, bit) = match self.bit {
            Some(_) => (self.offset + position / 8, u8::try_from(position % 8).ok()),
            None => (self.offset + position * self.stride, None),
        };
        Ok(Self { offset, bit, run, whole: false, ..self })
    }

    /// Bytes that so many elements take in memory; those with a bit are counted to the end of their last byte.
    pub(super) fn span(&self, count: usize) -> usize {
        match self.bit {
            Some(bit) => (usize::from(bit) + count).div_ceil(8),
            None => self.stride * count,
        }
    }
}

/// Which element the first steps name, and how many steps those are.
fn position(kind: &Type, dialect: Dialect, steps: &[Step<'_>]) -> Result<(usize, usize), Wrong> {
    let Type::Array(element, dimensions) = kind else { return Err(Wrong::Missing) };
    let indices = steps.iter().map_while(|step| match step {
        Step::Index(index) => Some(*index),
        Step::Member(_) => None,
    });
    // The BOOLs of a Logix are addressed by their DWORD (pycomm3, pylogix).
    if **element == Type::Elementary(Elementary::Bool) && dialect == Dialect::Logix {
        let index = indices.take(1).next().ok_or(Wrong::Missing)?;
        return Ok((usize::try_from(index).map_err(|_| Wrong::Outside)?, 1));
    }
    let wanted = dimensions.each().len();
    let indices: Vec<u32> = indices.take(wanted).collect();
    if indices.len() < wanted {
        return Err(Wrong::Missing);
    }
    Ok((dimensions.position(&indices).ok_or(Wrong::Outside)?, wanted))
}
