//! The tags of a controller, as bytes of its memory.

use alloc::collections::BTreeMap;
use alloc::string::{String, ToString};
use alloc::sync::Arc;
use alloc::vec::Vec;

use crate::engine::time::Instant;
use crate::tag::{Dialect, Member, Structure, Type, Value};

use super::address::{Base, Part, Step, is_program};
use super::motion::Motion;
use super::structures::Structures;

/// What a tag may be used for from outside.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TagAccess {
    /// `write`: read and written.
    #[default]
    Write,
    /// `read`: a constant, or external access "read only".
    Read,
    /// `none`: not published; from outside it is not there.
    None,
}

/// A tag as it is defined.
#[derive(Clone, Debug, PartialEq)]
pub struct TagDefinition {
    /// Its name; `Program:Main.Speed` for a tag of a Logix program.
    pub name: String,
    /// Its type.
    pub kind: Type,
    /// What it is at first; `None` = zeros.
    pub value: Option<Value>,
    /// How it changes: the part's name behind the tag's (empty = the tag itself, or all elements of an array), and how.
    pub moves: Vec<(String, Motion)>,
    /// Who may what.
    pub access: TagAccess,
    /// Omron: the smallest and the largest number that may be written.
    pub range: Option<(i64, i64)>,
}

/// Why a definition cannot be.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum DefinitionError {
    /// The name is empty, too long, or there already.
    #[error("the name {0:?} {1}")]
    Name(String, &'static str),
    /// The type has no size, or is too big.
    #[error("{0}: its type takes {1} bytes: at most 65536 do")]
    TooBig(String, usize),
    /// A value that is not of the type.
    #[error("{0}: {1}")]
    Value(String, String),
    /// A part moves that is not there, or not in this way.
    #[error("{0}: {1:?} cannot move as {2}")]
    Motion(String, String, Motion),
}

/// The tags of a controller of one family.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TagMemory {
    pub(super) dialect: Dialect,
    pub(super) tags: Vec<Tag>,
    pub(super) structures: Structures,
    /// Names in lower case: no family tells capitals from others.
    by_name: BTreeMap<String, usize>,
}

/// A tag and its memory.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Tag {
    pub(super) name: String,
    pub(super) kind: Type,
    pub(super) access: TagAccess,
    pub(super) range: Option<(i64, i64)>,
    pub(super) bytes: Vec<u8>,
    moving: Vec<Moving>,
}

/// A part that changes.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Moving {
    motion: Motion,
    kind: Type,
    offset: usize,
    bit: Option<u8>,
    index: usize,
    first: Vec<u8>,
}

/// Our own limit: nothing that travels in messages is larger.
const MAX_TAG: usize = 65_536;

impl TagMemory {
    /// Tags in the order of their numbers: the first is 1.
    pub fn new(dialect: Dialect, definitions: Vec<TagDefinition>) -> Result<Self, DefinitionError> {
        let mut structures = Structures::default();
        let (mut tags, mut by_name) = (Vec::with_capacity(definitions.len()), BTreeMap::new());
        for definition in definitions {
            let name = definition.name.clone();
            let parts = name.strip_prefix("Program:").map_or(1, |_| 2);
            if name.is_empty() || name.len() > 250 || name.splitn(3, '.').count() != parts {
                return Err(DefinitionError::Name(name, "is empty, too long, or has a dot"));
            }
            let tag = Tag::new(dialect, definition, &mut structures)?;
            if by_name.insert(name.to_lowercase(), tags.len()).is_some() {
                return Err(DefinitionError::Name(name, "is there twice"));
            }
            tags.push(tag);
        }
        Ok(Self { dialect, tags, structures, by_name })
    }

    /// No tag.
    pub(super) fn empty(dialect: Dialect) -> Self {
        Self { dialect, tags: Vec::new(), structures: Structures::default(), by_name: BTreeMap::new() }
    }

    /// The family whose memory this is.
    pub const fn dialect(&self) -> Dialect {
        self.dialect
    }

    /// How many tags there are.
    pub const fn len(&self) -> usize {
        self.tags.len()
    }

    /// Whether there is no tag.
    pub const fn is_empty(&self) -> bool {
        self.tags.is_empty()
    }

    /// The tag that a path begins with, if it is to be seen.
    pub(super) fn find(&mut self, base: &Base<'_>) -> Option<&mut Tag> {
        let index = match base {
            Base::Instance(number) if self.dialect == Dialect::Logix => {
                usize::try_from(*number).ok()?.checked_sub(1)?
            }
            Base::Instance(_) => return None,
            Base::Name(name) => self.index(core::str::from_utf8(name).ok()?)?,
            Base::Program(program, name) => {
                let [program, name] = [program, name].map(|part| core::str::from_utf8(part));
                self.index(&[program.ok()?, name.ok()?].join("."))?
            }
        };
        self.tags.get_mut(index).filter(|tag| tag.access != TagAccess::None)
    }

    fn index(&self, name: &str) -> Option<usize> {
        self.by_name.get(&name.to_lowercase()).copied()
    }
}

impl Tag {
    fn new(
        dialect: Dialect,
        definition: TagDefinition,
        structures: &mut Structures,
    ) -> Result<Self, DefinitionError> {
        let TagDefinition { name, kind, value, moves, access, range } = definition;
        let kind = structures.add(&kind);
        let size = kind.size(dialect);
        if !(1..=MAX_TAG).contains(&size) {
            return Err(DefinitionError::TooBig(name, size));
        }
        let bytes = match value {
            Some(value) => memory(&kind, dialect, value)
                .map_err(|error| DefinitionError::Value(name.clone(), error.to_string()))?,
            None => alloc::vec![0; size],
        };
        let mut tag = Self { name, kind, access, range, bytes, moving: Vec::new() };
        for (part, motion) in moves {
            let moving = tag.moving(dialect, &part, motion);
            tag.moving.extend(moving.ok_or_else(|| DefinitionError::Motion(tag.name.clone(), part, motion))?);
        }
        Ok(tag)
    }

    /// The part as it moves; the elements, if it is an array.
    fn moving(&self, dialect: Dialect, part: &str, motion: Motion) -> Option<Vec<Moving>> {
        let steps: Vec<Step<'_>> = part
            .split('.')
            .filter(|name| !name.is_empty())
            .map(|name| Step::Member(name.as_bytes()))
            .collect();
        let part = Part::find(&self.kind, dialect, &steps).ok()?;
        let packed = matches!(part.kind, Type::Array(..)) && part.clone().elements(dialect).bit.is_some();
        let part = part.elements(dialect);
        if packed || !motion.suits(part.kind) {
            return None;
        }
        let moving = (0..part.run).map(|index| {
            let offset = part.offset + index * part.stride;
            let first = match part.bit {
                Some(bit) => alloc::vec![self.bytes.get(offset)? >> bit & 1],
                None => self.bytes.get(offset..offset + part.stride)?.to_vec(),
            };
            Some(Moving { motion, kind: part.kind.clone(), offset, bit: part.bit, index, first })
        });
        moving.collect()
    }

    /// Makes the memory that of this moment.
    pub(super) fn refresh(&mut self, dialect: Dialect, now: Instant) {
        for moving in &self.moving {
            let Moving { motion, kind, offset, bit, index, first } = moving;
            let Some(bytes) = motion.bytes(kind, dialect, first, *index, now) else { continue };
            match (bit, bytes.first()) {
                (Some(bit), Some(on)) => set_bit(&mut self.bytes, *offset, *bit, *on != 0),
                _ => {
                    if let Some(place) = self.bytes.get_mut(*offset..offset + bytes.len()) {
                        place.copy_from_slice(&bytes);
                    }
                }
            }
        }
    }

    /// The program and the name in it, of a tag of a program.
    pub(super) fn program(&self) -> Option<(&str, &str)> {
        if is_program(self.name.as_bytes()) { self.name.split_once('.') } else { None }
    }

    /// The name without the program.
    pub(super) fn short_name(&self) -> &str {
        self.program().map_or(&self.name, |(_, name)| name)
    }
}

/// Sets or clears a bit of memory.
pub(super) fn set_bit(bytes: &mut [u8], offset: usize, bit: u8, on: bool) {
    if let Some(byte) = bytes.get_mut(offset) {
        *byte = if on { *byte | 1 << bit } else { *byte & !(1 << bit) };
    }
}

/// A value as it lies in memory: as it would as the only member of a structure.
fn memory(kind: &Type, dialect: Dialect, value: Value) -> Result<Vec<u8>, crate::tag::ValueError> {
    let name = String::from("value");
    let member = Member { name: name.clone(), kind: kind.clone(), place: None };
    let whole = Structure { members: alloc::vec![member], ..Structure::default() };
    let whole = Type::Structure(Arc::new(whole));
    let mut bytes = whole.encode(dialect, &Value::Members(alloc::vec![(name, value)]))?;
    bytes.resize(kind.size(dialect), 0);
    Ok(bytes)
}
