//! Where the members of a structure lie.
//!
//! A device that has told its layout is believed. Otherwise the family's rules: Omron aligns each member to its size,
//! up to 8 bytes, keeps a BOOL in a word, begins at an even byte where the type changes, and pads the whole to its
//! largest member (libplctag issue 457; seen in what aphyt reads). Logix packs neighbouring BOOLs into bytes, aligns
//! numbers to their size, arrays and structures to 4 bytes at least, and pads the whole likewise (1756-PM020, from
//! memory). Of Micro800 nothing is known: natural alignment.

use alloc::vec::Vec;

use super::dialect::Dialect;
use super::elementary::Elementary;
use super::kind::{BOOL, Place, Structure, Type};

/// Where the members lie, and how long the whole is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Layout {
    /// One for each member.
    pub places: Vec<Place>,
    /// Bytes of the whole.
    pub size: usize,
}

impl Layout {
    /// The layout of a structure on a family's controllers.
    pub fn of(structure: &Structure, dialect: Dialect) -> Self {
        let mut walk = Walk { dialect, at: 0, alignment: 1, bits: 0 };
        let mut former: Option<&Type> = None;
        let mut places = Vec::with_capacity(structure.members.len());
        for member in &structure.members {
            let place = match member.place {
                Some(place) => walk.told(place, &member.kind),
                None => walk.next(&member.kind, former),
            };
            former = Some(&member.kind);
            places.push(place);
        }
        let size = walk.at.next_multiple_of(walk.whole_alignment());
        Self { places, size: structure.size.and_then(|size| usize::try_from(size).ok()).unwrap_or(size) }
    }
}

struct Walk {
    dialect: Dialect,
    /// The first free byte.
    at: usize,
    /// The largest so far.
    alignment: usize,
    /// Bits used of the byte before `at`; 0 = there is no such byte.
    bits: u8,
}

impl Walk {
    fn told(&mut self, place: Place, kind: &Type) -> Place {
        let offset = usize::try_from(place.offset).unwrap_or(usize::MAX);
        let size = if place.bit.is_some() { 1 } else { kind.size(self.dialect) };
        self.at = self.at.max(offset.saturating_add(size));
        self.alignment = self.alignment.max(kind.alignment(self.dialect));
        self.bits = 0;
        place
    }

    fn next(&mut self, kind: &Type, former: Option<&Type>) -> Place {
        if *kind == BOOL && self.dialect == Dialect::Logix {
            if self.bits == 0 || self.bits == 8 {
                (self.at, self.bits) = (self.at + 1, 0);
            }
            self.bits += 1;
            return place(self.at - 1, Some(self.bits - 1));
        }
        self.bits = 0;
        let alignment = kind.alignment(self.dialect);
        self.alignment = self.alignment.max(alignment);
        self.at = self.at.next_multiple_of(alignment);
        if self.dialect == Dialect::Omron && former.is_some_and(|former| former != kind) {
            self.at = self.at.next_multiple_of(2);
        }
        let offset = self.at;
        self.at = self.at.saturating_add(kind.size(self.dialect));
        place(offset, None)
    }

    fn whole_alignment(&self) -> usize {
        match self.dialect {
            Dialect::Logix => self.alignment.max(4),
            Dialect::Omron | Dialect::Micro800 => self.alignment,
        }
    }
}

fn place(offset: usize, bit: Option<u8>) -> Place {
    Place { offset: u32::try_from(offset).unwrap_or(u32::MAX), bit }
}

impl Type {
    /// Bytes inside of a structure, or from one element of an array to the next.
    pub fn size(&self, dialect: Dialect) -> usize {
        match self {
            Self::Elementary(kind) => kind.size(dialect),
            Self::String(capacity) => {
                let capacity = usize::from(capacity.unwrap_or(dialect.string_capacity()));
                match dialect {
                    Dialect::Logix => (4 + capacity).next_multiple_of(4),
                    Dialect::Micro800 => 1 + capacity,
                    Dialect::Omron => capacity,
                }
            }
            Self::Array(element, dimensions) if **element == BOOL => {
                packed_bools(dimensions.count(), dialect)
            }
            Self::Array(element, dimensions) => element.size(dialect).saturating_mul(dimensions.count()),
            Self::Structure(structure) => Layout::of(structure, dialect).size,
        }
    }

    fn alignment(&self, dialect: Dialect) -> usize {
        match (self, dialect) {
            (Self::Elementary(kind), _) => kind.size(dialect).min(8),
            (Self::String(_), Dialect::Omron | Dialect::Micro800) => 1,
            (Self::String(_), Dialect::Logix) => 4,
            (Self::Array(element, _), Dialect::Logix) => element.alignment(dialect).max(4),
            (Self::Array(element, _), Dialect::Omron) if **element == BOOL => Elementary::Word.size(dialect),
            (Self::Array(element, _), _) => element.alignment(dialect),
            (Self::Structure(structure), _) => {
                let members = structure.members.iter().map(|member| member.kind.alignment(dialect));
                let own = members.max().unwrap_or(1);
                if dialect == Dialect::Logix { own.max(4) } else { own }
            }
        }
    }
}

/// Bytes of an array of BOOLs inside of something.
pub(super) const fn packed_bools(count: usize, dialect: Dialect) -> usize {
    match dialect {
        Dialect::Logix => 4 * count.div_ceil(32),
        Dialect::Omron => 2 * count.div_ceil(16),
        Dialect::Micro800 => count,
    }
}
