//! The structures that the tags are made of: their numbers, and the handles that stand before their values.

use alloc::boxed::Box;
use alloc::format;
use alloc::string::ToString;
use alloc::sync::Arc;
use alloc::vec::Vec;

use crate::tag::{Member, Structure, Type};

/// All structures, each once, inner ones before outer ones.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Structures {
    all: Vec<Arc<Structure>>,
}

impl Structures {
    /// The same type with handles; its structures are known from now on.
    pub(super) fn add(&mut self, kind: &Type) -> Type {
        match kind {
            Type::Elementary(_) | Type::String(_) => kind.clone(),
            Type::Array(element, dimensions) => Type::Array(Box::new(self.add(element)), dimensions.clone()),
            Type::Structure(structure) => {
                let member = |member: &Member| Member { kind: self.add(&member.kind), ..member.clone() };
                let members = structure.members.iter().map(member).collect();
                let name = match structure.name.as_str() {
                    "" => format!("Structure{}", self.all.len() + 1),
                    name => name.into(),
                };
                let handle = structure.handle.unwrap_or_else(|| crc(kind.to_string().as_bytes()));
                let named = Structure { name, members, handle: Some(handle), ..(**structure).clone() };
                let same = |known: &&Arc<Structure>| {
                    known.members == named.members && (structure.name.is_empty() || known.name == named.name)
                };
                if let Some(known) = self.all.iter().find(same) {
                    return Type::Structure(Arc::clone(known));
                }
                let named = Arc::new(named);
                self.all.push(Arc::clone(&named));
                Type::Structure(named)
            }
        }
    }

    pub(super) fn all(&self) -> &[Arc<Structure>] {
        &self.all
    }

    /// Which one it is, counted from 0.
    pub(super) fn position(&self, structure: &Structure) -> Option<usize> {
        self.all.iter().position(|known| **known == *structure)
    }
}

/// CRC-16 with the polynomial 0xA001 reflected. What real controllers count into it is not known; clients only send
/// back what they were told.
fn crc(bytes: &[u8]) -> u16 {
    bytes.iter().fold(0, |crc, byte| {
        (0..8).fold(crc ^ u16::from(*byte), |crc, _| crc >> 1 ^ if crc & 1 == 1 { 0xA001 } else { 0 })
    })
}
