//! The type of a tag.

use alloc::boxed::Box;
use alloc::string::String;
use alloc::sync::Arc;
use alloc::vec::Vec;

use super::dialect::Dialect;
use super::elementary::Elementary;
use super::name::Step;

/// The type of a tag, a member or an element. As text: see [`Types`](super::Types).
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Type {
    /// A number, a bit, a time.
    Elementary(Elementary),
    /// Characters: at most this many bytes; `None` = what the family's STRING holds.
    String(Option<u16>),
    /// One to three dimensions.
    Array(Box<Self>, Dimensions),
    /// Members with names.
    Structure(Arc<Structure>),
}

/// The sizes of an array: one to three.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Dimensions(Vec<Dimension>);

/// One dimension.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Dimension {
    /// The first index: 0, except where an Omron variable was declared otherwise.
    pub first: u32,
    /// How many indices. Never 0.
    pub length: u32,
}

/// A structure: what it is called, and what is in it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Structure {
    /// Its name; may be empty.
    pub name: String,
    /// In the order of their declaration.
    pub members: Vec<Member>,
    /// Logix: the structure handle; Omron: the CRC. It stands before the data when it is written.
    pub handle: Option<u16>,
    /// Bytes, where the device has said so; otherwise it follows from the members.
    pub size: Option<u32>,
}

/// A member of a structure.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Member {
    /// Its name.
    pub name: String,
    /// Its type.
    pub kind: Type,
    /// Where it lies, where the device has said so; otherwise it follows from the family's rules.
    pub place: Option<Place>,
}

/// Where a member lies in the bytes of its structure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place {
    /// The first byte.
    pub offset: u32,
    /// Which bit of it, for a BOOL that shares its byte with others.
    pub bit: Option<u8>,
}

/// Most elements of an array. Our own limit: nothing that travels in messages is larger.
const MAX_ELEMENTS: u64 = 1 << 20;

impl Dimensions {
    /// One to three dimensions with at most 1,048,576 elements together.
    pub fn new(dimensions: Vec<Dimension>) -> Option<Self> {
        let fits = |length: u32, first: u32| length > 0 && first.checked_add(length - 1).is_some();
        let each = dimensions.iter().all(|dimension| fits(dimension.length, dimension.first));
        let count = dimensions.iter().try_fold(1_u64, |count, each| count.checked_mul(each.length.into()));
        let valid = (1..=3).contains(&dimensions.len()) && each && count.is_some_and(|it| it <= MAX_ELEMENTS);
        valid.then_some(Self(dimensions))
    }

    /// One dimension from 0.
    pub fn of_length(length: u32) -> Option<Self> {
        Self::new(alloc::vec![Dimension { first: 0, length }])
    }

    /// In the order of the indices.
    pub fn each(&self) -> &[Dimension] {
        &self.0
    }

    /// Elements of all dimensions together.
    pub fn count(&self) -> usize {
        // `new` has refused what is too many.
        self.0.iter().map(|each| usize::try_from(each.length).unwrap_or(usize::MAX)).product()
    }

    /// Which element the indices name, counted from 0; `None` outside of the array.
    pub fn position(&self, indices: &[u32]) -> Option<usize> {
        let mut position = 0_usize;
        let mut indices = indices.iter();
        for each in &self.0 {
            let index = indices.next()?.checked_sub(each.first).filter(|index| *index < each.length)?;
            position = position * usize::try_from(each.length).ok()? + usize::try_from(index).ok()?;
        }
        indices.next().is_none().then_some(position)
    }
}

impl Type {
    /// What the steps lead to from here.
    pub fn step(&self, steps: &[Step]) -> Option<&Self> {
        let Some((step, rest)) = steps.split_first() else { return Some(self) };
        match (self, step) {
            (Self::Structure(structure), Step::Member(name)) => structure.member(name)?.kind.step(rest),
            (Self::Array(element, dimensions), Step::Index(indices)) => {
                dimensions.position(indices)?;
                element.step(rest)
            }
            _ => None,
        }
    }

    /// Elements that a request for the whole names: 1 for everything but an array. A Logix keeps the BOOLs of an
    /// array in DWORDs.
    pub fn elements(&self, dialect: Dialect) -> usize {
        match self {
            Self::Array(element, dimensions) if **element == BOOL && dialect == Dialect::Logix => {
                dimensions.count().div_ceil(32)
            }
            Self::Array(_, dimensions) => dimensions.count(),
            _ => 1,
        }
    }

    /// The type of the elements; the type itself for everything but an array.
    pub fn element(&self) -> &Self {
        match self {
            Self::Array(element, _) => element,
            _ => self,
        }
    }
}

/// What arrays pack.
pub(super) const BOOL: Type = Type::Elementary(Elementary::Bool);

impl Structure {
    /// A member by its name: controllers do not tell capitals from others.
    pub fn member(&self, name: &str) -> Option<&Member> {
        self.members.iter().find(|member| member.name.eq_ignore_ascii_case(name))
    }
}
