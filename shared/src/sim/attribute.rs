//! Services that are the same for every object: Get_Attribute_List and the attributes of a class.

use alloc::vec::Vec;

use crate::wire::{GeneralStatus, MAX_MESSAGE, Reader};

use super::request::Refusal;

/// Get_Attribute_List: `UINT count | UINT id …` gives `UINT count | (UINT id | UINT status | value) …`; a value only where
/// the status is 0.
pub(super) fn list(data: &[u8], read: impl Fn(u16) -> Option<Vec<u8>>) -> Result<Vec<u8>, Refusal> {
    let mut reader = Reader::new(data);
    let short = |_| GeneralStatus::NotEnoughData;
    let count = reader.u16().map_err(short)?;
    let mut out = count.to_le_bytes().to_vec();
    let mut status = GeneralStatus::Success;
    for _ in 0..count {
        let id = reader.u16().map_err(short)?;
        out.extend_from_slice(&id.to_le_bytes());
        if let Some(value) = read(id) {
            out.extend_from_slice(&[0, 0]);
            out.extend_from_slice(&value);
        } else {
            status = GeneralStatus::AttributeListError;
            out.extend_from_slice(&u16::from(GeneralStatus::AttributeNotSupported.0).to_le_bytes());
        }
        if out.len() > MAX_MESSAGE {
            return Err(GeneralStatus::ReplyDataTooLarge.into());
        }
    }
    reader.finish().map_err(|_| GeneralStatus::TooMuchData)?;
    match status {
        GeneralStatus::Success => Ok(out),
        _ => Err(Refusal { data: out, ..Refusal::from(status) }),
    }
}

/// What a class says of itself: instance 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Class {
    pub(super) revision: u16,
    pub(super) max_instance: u16,
    pub(super) instances: u16,
}

impl Class {
    /// 1 revision, 2 highest instance, 3 number of instances.
    pub(super) fn read(self, attribute: u16) -> Option<Vec<u8>> {
        let value = match attribute {
            1 => self.revision,
            2 => self.max_instance,
            3 => self.instances,
            _ => return None,
        };
        Some(value.to_le_bytes().to_vec())
    }
}
