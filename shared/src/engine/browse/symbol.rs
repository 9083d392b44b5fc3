//! A tag, as a controller lists it.

use alloc::boxed::Box;
use alloc::string::{String, ToString};
use alloc::vec::Vec;

use crate::tag::{Dimension, Dimensions, Type};

/// A tag, as a controller lists it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Symbol {
    /// The whole name, with that of its program.
    pub name: String,
    /// The type as far as it is known: `DINT[10]`, `structure 257[4]`.
    pub type_text: String,
    /// The type; `None` for structures, and for what nobody knows.
    pub kind: Option<Type>,
    /// The sizes of an array; empty for everything else.
    pub dims: Vec<Dimension>,
    /// The number of its structure: for [`Browse::template`](super::Browse::template).
    pub template: Option<u32>,
    /// What the device lets others do with it, where it says so.
    pub access: Option<Access>,
    /// What has to be said about it.
    pub note: Option<&'static str>,
}

/// What others may do with a tag.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Access {
    /// Read and write.
    Write,
    /// Read only.
    Read,
    /// Nothing.
    None,
}

impl Access {
    /// Attribute 10 of class 6B. Source: pycomm3 EXTERNAL_ACCESS.
    pub(super) const fn of_code(code: u8) -> Option<Self> {
        match code {
            0 => Some(Self::Write),
            2 => Some(Self::Read),
            3 => Some(Self::None),
            _ => None,
        }
    }
}

impl Symbol {
    /// A tag of a known type.
    pub(super) fn of_kind(name: String, element: Type, dims: Vec<Dimension>) -> Self {
        let kind = wrapped(element, &dims);
        let type_text = kind.as_ref().map_or_else(|| "?".to_string(), ToString::to_string);
        Self { name, type_text, kind, dims, template: None, access: None, note: None }
    }

    /// A structure that nobody has looked into.
    pub(super) fn of_template(name: String, template: u32, dims: Vec<Dimension>) -> Self {
        let lengths: Vec<_> = dims.iter().map(|each| each.length.to_string()).collect();
        let many = if lengths.is_empty() { String::new() } else { alloc::format!("[{}]", lengths.join(",")) };
        let type_text = alloc::format!("structure {template}{many}");
        Self { name, type_text, kind: None, dims, template: Some(template), access: None, note: None }
    }

    /// The type of the whole, when that of its structure has been read.
    pub fn with_structure(&self, structure: &Type) -> Option<Type> {
        wrapped(structure.clone(), &self.dims)
    }
}

fn wrapped(element: Type, dims: &[Dimension]) -> Option<Type> {
    if dims.is_empty() {
        return Some(element);
    }
    Some(Type::Array(Box::new(element), Dimensions::new(dims.to_vec())?))
}
