//! What stands before the bytes of a value: the type code, and for structures a handle.
//!
//! `USINT code | USINT length of what follows: 0 or 2 | [UINT handle]`. Omron W506 8-7-1 calls the second byte the length
//! of the additional information; a Logix reads both bytes as one UINT, `A0 02` as 0x02A0 (pycomm3): the same bytes.

use alloc::boxed::Box;
use alloc::sync::Arc;
use alloc::vec::Vec;

use super::dialect::Dialect;
use super::elementary::Elementary;
use super::kind::{BOOL, Dimensions, Structure, Type};
use crate::wire::{DecodeError, DecodeErrorKind, Reader};

/// Code of a structure.
pub const STRUCTURE: u8 = 0xA0;

/// Handle of the structure that a Logix keeps a STRING in. Source: pycomm3 (0x0FCE).
pub const LOGIX_STRING: u16 = 0x0FCE;

/// Code of Omron's STRING.
const STRING: u8 = 0xD0;

/// Code of Micro800's STRING.
const SHORT_STRING: u8 = 0xDA;

/// What stands before the bytes of a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct TagHead {
    /// The type code: of the elements, for an array.
    pub code: u8,
    /// Logix: the structure handle; Omron: the CRC of the structure.
    pub handle: Option<u16>,
}

/// The data of a reply to Read Tag.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TagData<'a> {
    /// The type, as far as it says so itself.
    pub head: TagHead,
    /// The bytes of the value.
    pub data: &'a [u8],
}

impl TagHead {
    /// Appends it.
    pub fn encode(self, out: &mut Vec<u8>) {
        out.extend_from_slice(&[self.code, if self.handle.is_some() { 2 } else { 0 }]);
        out.extend(self.handle.into_iter().flat_map(u16::to_le_bytes));
    }
}

impl<'a> TagData<'a> {
    /// Reads the head; the rest is the value.
    pub fn decode(bytes: &'a [u8]) -> Result<Self, DecodeError> {
        let mut reader = Reader::new(bytes);
        let code = reader.u8()?;
        let wrong = reader.clone();
        let handle = match reader.u8()? {
            0 => None,
            2 => Some(reader.u16()?),
            length => {
                let field = "length of additional information";
                return Err(wrong.error(DecodeErrorKind::Unexpected { field, found: length.into() }));
            }
        };
        Ok(Self { head: TagHead { code, handle }, data: reader.rest() })
    }
}

impl Type {
    /// What stands before a value of this type; `None` for a structure whose handle nobody has told yet.
    pub fn head(&self, dialect: Dialect) -> Option<TagHead> {
        let plain = |code| Some(TagHead { code, handle: None });
        match self {
            Self::Array(element, _) if **element == BOOL && dialect == Dialect::Logix => {
                plain(Elementary::Dword.code())
            }
            Self::Array(element, _) => element.head(dialect),
            Self::Elementary(kind) => plain(kind.code()),
            Self::String(_) => match dialect {
                Dialect::Logix => Some(TagHead { code: STRUCTURE, handle: Some(LOGIX_STRING) }),
                Dialect::Micro800 => plain(SHORT_STRING),
                Dialect::Omron => plain(STRING),
            },
            Self::Structure(structure) => Some(TagHead { code: STRUCTURE, handle: Some(structure.handle?) }),
        }
    }

    /// The same type with the handle that came before its values, if it is a structure whose handle nobody knew, or an
    /// array of such.
    #[must_use]
    pub fn told(&self, handle: u16) -> Self {
        match self {
            Self::Structure(structure) if structure.handle.is_none() => {
                Self::Structure(Arc::new(Structure { handle: Some(handle), ..(**structure).clone() }))
            }
            Self::Array(element, dimensions) => {
                Self::Array(Box::new(element.told(handle)), dimensions.clone())
            }
            other => other.clone(),
        }
    }

    /// What a reply says of its type by itself, for a request of so many elements. `None` for structures that nobody
    /// knows, and for codes that nobody knows.
    pub fn of_data(dialect: Dialect, data: &TagData<'_>, elements: u16) -> Option<Self> {
        let TagHead { code, handle } = data.head;
        let element = match (code, handle) {
            (STRUCTURE, Some(LOGIX_STRING)) if dialect == Dialect::Logix => Self::String(None),
            (STRING | SHORT_STRING, None) => Self::String(None),
            (_, None) => Self::Elementary(Elementary::of_code(dialect, code)?),
            _ => return None,
        };
        if elements <= 1 && element != Self::String(None) {
            // BOOLs of an array come in a byte each.
            let size = if element == BOOL { 1 } else { element.size(dialect) };
            // A whole array comes without being asked for: an Omron gives it when no element is named.
            let many = data.data.len() / size.max(1);
            let is_padded = size == 1 && data.data.len() == 2;
            if many > 1 && !is_padded && dialect == Dialect::Omron {
                return Self::array(element, u32::try_from(many).ok()?);
            }
        }
        if elements > 1 { Self::array(element, elements.into()) } else { Some(element) }
    }

    fn array(element: Self, length: u32) -> Option<Self> {
        Some(Self::Array(Box::new(element), Dimensions::of_length(length)?))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hex_literal::hex;

    #[test]
    fn both_ways_to_read_the_second_byte_are_the_same_bytes() {
        // document on Omron NX: C1 00 | 00 00; a Logix structure: A0 02 | CE 0F
        let bit = TagData::decode(&hex!("C1 00 01 00")).unwrap();
        assert_eq!((bit.head.code, bit.head.handle, bit.data), (0xC1, None, &[1, 0][..]));
        let text = TagData::decode(&hex!("A0 02 CE 0F 01 00 00 00")).unwrap();
        assert_eq!(text.head.handle, Some(LOGIX_STRING));
        let mut out = Vec::new();
        text.head.encode(&mut out);
        assert_eq!(out, hex!("A0 02 CE 0F"));
        for (bytes, at) in
            [(&hex!("")[..], 0), (&hex!("C1"), 1), (&hex!("C1 01 00"), 1), (&hex!("A0 02 01"), 3)]
        {
            assert_eq!(TagData::decode(bytes).unwrap_err().at, at);
        }
    }
}
