//! ANSI extended symbol segment: a part of a tag's name.
//!
//! `91 | length | characters | 00 if the length is odd`; the length does not count the pad. One for each part between
//! dots; an index is a member segment behind it. Source: Omron W506 8-4-5.

use alloc::vec::Vec;

use super::cursor::{DecodeError, DecodeErrorKind, Reader};

/// A part of a name. Logix takes ASCII, Omron UTF-8; the bytes are kept as they are.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct SymbolSegment {
    name: Vec<u8>,
}

impl SymbolSegment {
    /// The segment byte.
    pub const CODE: u8 = 0x91;

    /// A name of 1 to 255 bytes.
    pub fn new(name: &[u8]) -> Option<Self> {
        (1..=255).contains(&name.len()).then(|| Self { name: name.to_vec() })
    }

    /// The bytes of the name.
    pub fn name(&self) -> &[u8] {
        &self.name
    }

    /// Reads what follows the segment byte.
    pub(super) fn read(reader: &mut Reader<'_>) -> Result<Self, DecodeError> {
        let empty = reader.error(DecodeErrorKind::Unexpected { field: "symbol length", found: 0 });
        let length = usize::from(reader.u8()?);
        if length == 0 {
            return Err(empty);
        }
        let name = reader.take(length)?.to_vec();
        if !length.is_multiple_of(2) {
            reader.u8()?;
        }
        Ok(Self { name })
    }

    pub(super) fn encode(&self, out: &mut Vec<u8>) {
        // `new` has refused what is over 255 bytes.
        out.extend_from_slice(&[Self::CODE, u8::try_from(self.name.len()).unwrap_or(u8::MAX)]);
        out.extend_from_slice(&self.name);
        if !self.name.len().is_multiple_of(2) {
            out.push(0);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::wire::{Epath, LogicalKind, Segment};
    use hex_literal::hex;

    #[test]
    fn a_name_with_indices_is_the_manuals() {
        // Omron W506 8-4-5: VarAA.MemB[1,2]
        let part = |name: &[u8]| Segment::Symbol(SymbolSegment::new(name).unwrap());
        let path = Epath::default().with(part(b"VarAA")).with(part(b"MemB"));
        let path = path.then(LogicalKind::Member, 1).then(LogicalKind::Member, 2);
        assert_eq!(path.bytes(), hex!("91 05 56 61 72 41 41 00 91 04 4D 65 6D 42 28 01 28 02"));
        assert_eq!(Epath::decode(&path.bytes()), Ok(path));
    }

    #[test]
    fn a_name_that_cannot_be_is_named_with_its_byte() {
        for (bytes, at) in
            [(&hex!("91 00")[..], 1), (&hex!("91 04 41"), 3), (&hex!("91 01 41"), 3), (&hex!("91"), 1)]
        {
            assert_eq!(Epath::decode(bytes).unwrap_err().at, at, "{bytes:02x?}");
        }
        assert_eq!((SymbolSegment::new(b""), SymbolSegment::new(&[b'a'; 256])), (None, None));
    }
}
