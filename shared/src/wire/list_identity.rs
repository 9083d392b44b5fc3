//! Item of a `ListIdentity` reply. Source: OpENer `encap.c`.

use alloc::vec::Vec;

use super::common_packet::{CommonPacketFormat, Item, ItemType};
use super::cursor::{DecodeError, DecodeErrorKind, Reader};
use super::encapsulation::HEADER_SIZE;
use super::value::ShortString;

/// Who a device is, as it says on the wire.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ListIdentityItem {
    /// Encapsulation protocol version: 1.
    pub protocol_version: u16,
    /// Where the device thinks it is.
    pub address: SocketAddress,
    /// Vendor id; `table` has names.
    pub vendor: u16,
    /// Device type; `table` has names.
    pub device_type: u16,
    /// The vendor's own number of the product.
    pub product_code: u16,
    /// Major revision.
    pub major: u8,
    /// Minor revision.
    pub minor: u8,
    /// Identity attribute 5.
    pub status: u16,
    /// Serial number.
    pub serial: u32,
    /// Product name.
    pub name: ShortString,
    /// 0 nonexistent, 1 self test, 2 standby, 3 operational, 4 and 5 faults, 255 default.
    pub state: u8,
}

/// An IPv4 socket address; big endian on the wire.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SocketAddress {
    /// 2 = IPv4.
    pub family: u16,
    /// TCP port.
    pub port: u16,
    /// The address, first number first.
    pub ip: [u8; 4],
}

impl SocketAddress {
    /// An IPv4 address and port.
    pub const fn v4(ip: [u8; 4], port: u16) -> Self {
        Self { family: 2, port, ip }
    }

    fn read(reader: &mut Reader<'_>) -> Result<Self, DecodeError> {
        let family = u16::from_be_bytes(reader.array()?);
        let port = u16::from_be_bytes(reader.array()?);
        let ip = reader.array()?;
        reader.take(8)?;
        Ok(Self { family, port, ip })
    }

    fn encode(self, out: &mut Vec<u8>) {
        out.extend_from_slice(&self.family.to_be_bytes());
        out.extend_from_slice(&self.port.to_be_bytes());
        out.extend_from_slice(&self.ip);
        out.extend_from_slice(&[0; 8]);
    }
}

impl ListIdentityItem {
    /// Decodes the data of one item. Some devices leave out the state: it is then 255.
    pub fn decode(data: &[u8]) -> Result<Self, DecodeError> {
        let mut reader = Reader::new(data);
        let item = Self {
            protocol_version: reader.u16()?,
            address: SocketAddress::read(&mut reader)?,
            vendor: reader.u16()?,
            device_type: reader.u16()?,
            product_code: reader.u16()?,
            major: reader.u8()?,
            minor: reader.u8()?,
            status: reader.u16()?,
            serial: reader.u32()?,
            name: ShortString::read(&mut reader)?,
            state: if reader.is_empty() { 255 } else { reader.u8()? },
        };
        reader.finish()?;
        Ok(item)
    }

    /// Decodes the data of a `ListIdentity` reply frame: the first identity item. Positions are counted from the start of
    /// the frame.
    pub fn decode_reply(data: &[u8]) -> Result<Self, DecodeError> {
        let mut reader = Reader::starting_at(data, HEADER_SIZE);
        let packet = CommonPacketFormat::read(&mut reader)?;
        let missing = reader.error(DecodeErrorKind::Unexpected {
            field: "items without an identity: count",
            found: packet.count().into(),
        });
        let item = packet.find(ItemType::ListIdentity).ok_or(missing)?;
        Self::decode(item.data).map_err(|error| error.shifted(item.at))
    }

    /// Appends item count 1 and the item: the whole data of a reply.
    pub fn encode_reply(&self, out: &mut Vec<u8>) {
        let mut data = Vec::new();
        data.extend_from_slice(&self.protocol_version.to_le_bytes());
        self.address.encode(&mut data);
        data.extend_from_slice(&self.vendor.to_le_bytes());
        data.extend_from_slice(&self.device_type.to_le_bytes());
        data.extend_from_slice(&self.product_code.to_le_bytes());
        data.extend_from_slice(&[self.major, self.minor]);
        data.extend_from_slice(&self.status.to_le_bytes());
        data.extend_from_slice(&self.serial.to_le_bytes());
        self.name.encode(&mut data);
        data.push(self.state);
        out.extend_from_slice(&1_u16.to_le_bytes());
        // 34 fixed bytes and a SHORT_STRING: always below 65,536.
        let length = u16::try_from(data.len()).unwrap_or(u16::MAX);
        Item::encode(ItemType::ListIdentity, length, &data, out);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::wire::CommonPacketFormat;

    #[test]
    fn an_identity_round_trips_and_its_address_is_big_endian() {
        let item = ListIdentityItem {
            protocol_version: 1,
            address: SocketAddress::v4([192, 168, 1, 100], 44818),
            vendor: 1,
            device_type: 2,
            product_code: 9,
            major: 1,
            minor: 2,
            status: 0x0030,
            serial: 0xC0FF_EE00,
            name: ShortString::new(b"drive").unwrap(),
            state: 3,
        };
        let mut out = Vec::new();
        item.encode_reply(&mut out);
        assert_eq!(out[8..16], [0, 2, 0xAF, 0x12, 192, 168, 1, 100]);
        let packet = CommonPacketFormat::read(&mut Reader::new(&out)).unwrap();
        let data = packet.find(ItemType::ListIdentity).unwrap().data;
        assert_eq!(ListIdentityItem::decode(data), Ok(item));
    }
}
