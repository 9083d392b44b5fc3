//! Item of a `ListServices` reply: `UINT version | UINT flags | 16-byte name`. Source: OpENer `encap.c`.

use alloc::vec::Vec;

use super::common_packet::{Item, ItemType};
use super::cursor::{DecodeError, Reader};

/// One service of the encapsulation layer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ListServicesItem {
    /// 1.
    pub version: u16,
    /// [`Self::TCP`], [`Self::UDP_IO`].
    pub flags: u16,
    /// Padded with zeros.
    pub name: [u8; 16],
}

impl ListServicesItem {
    /// Explicit messages over TCP.
    pub const TCP: u16 = 0x0020;
    /// Class 0 and 1 connections over UDP.
    pub const UDP_IO: u16 = 0x0100;
    /// A device that takes explicit messages only.
    pub const EXPLICIT: Self = Self { version: 1, flags: Self::TCP, name: *b"Communications\0\0" };

    /// Decodes the data of one item.
    pub fn decode(data: &[u8]) -> Result<Self, DecodeError> {
        let mut reader = Reader::new(data);
        let item = Self { version: reader.u16()?, flags: reader.u16()?, name: reader.array()? };
        reader.finish()?;
        Ok(item)
    }

    /// Appends item count 1 and the item: the whole data of a reply.
    pub fn encode_reply(&self, out: &mut Vec<u8>) {
        let mut data = Vec::new();
        data.extend_from_slice(&self.version.to_le_bytes());
        data.extend_from_slice(&self.flags.to_le_bytes());
        data.extend_from_slice(&self.name);
        out.extend_from_slice(&1_u16.to_le_bytes());
        Item::encode(ItemType::ListServices, 20, &data, out);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hex_literal::hex;

    #[test]
    fn the_reply_is_openers() {
        let mut out = Vec::new();
        ListServicesItem::EXPLICIT.encode_reply(&mut out);
        assert_eq!(
            out,
            hex!("01 00 00 01 14 00 01 00 20 00 43 6F 6D 6D 75 6E 69 63 61 74 69 6F 6E 73 00 00")
        );
        assert_eq!(ListServicesItem::decode(&out[6..]), Ok(ListServicesItem::EXPLICIT));
    }
}
