//! Simple data segment: a part of a variable, by its bytes. Omron NJ and NX take it behind a name.
//!
//! `80 | 03 (words) | UDINT offset | UINT size`. Source: seen in what aphyt (n_series.py) sends; three words are six
//! bytes, so the size is a UINT.

use alloc::vec::Vec;

use super::cursor::{DecodeError, DecodeErrorKind, Reader};

/// Which bytes of a variable.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct SimpleDataSegment {
    /// The first byte, counted from 0.
    pub offset: u32,
    /// How many bytes.
    pub size: u16,
}

impl SimpleDataSegment {
    /// The segment byte.
    pub const CODE: u8 = 0x80;

    /// Words behind the length byte.
    const WORDS: u8 = 3;

    /// Reads what follows the segment byte.
    pub(super) fn read(reader: &mut Reader<'_>) -> Result<Self, DecodeError> {
        let start = reader.clone();
        let words = reader.u8()?;
        if words != Self::WORDS {
            let kind = DecodeErrorKind::Unexpected { field: "simple data length", found: words.into() };
            return Err(start.error(kind));
        }
        Ok(Self { offset: reader.u32()?, size: reader.u16()? })
    }

    pub(super) fn encode(self, out: &mut Vec<u8>) {
        out.extend_from_slice(&[Self::CODE, Self::WORDS]);
        out.extend_from_slice(&self.offset.to_le_bytes());
        out.extend_from_slice(&self.size.to_le_bytes());
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::wire::{Epath, Segment, SymbolSegment};
    use hex_literal::hex;

    #[test]
    fn a_part_of_a_variable_follows_its_name() {
        // layout of aphyt n_series.py: offset as UDINT, size as UINT
        let path = Epath::default().with(Segment::Symbol(SymbolSegment::new(b"arT").unwrap()));
        let path = path.with(Segment::SimpleData(SimpleDataSegment { offset: 494, size: 300 }));
        assert_eq!(path.bytes(), hex!("91 03 61 72 54 00 80 03 EE 01 00 00 2C 01"));
        assert_eq!(Epath::decode(&path.bytes()), Ok(path));
        assert_eq!(Epath::decode(&hex!("80 04 00 00 00 00 01 00")).unwrap_err().at, 1);
    }
}
