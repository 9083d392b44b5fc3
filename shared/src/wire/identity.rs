//! Reply of the Identity object (class 1) to Get_Attributes_All: attributes 1 to 7. Source: OpENer cipidentity.c.

use alloc::vec::Vec;

use super::cursor::{DecodeError, Reader};
use super::value::ShortString;

/// Who a device says it is, and how it is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct IdentityAttributes {
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
    /// Attribute 5: `table::identity_status` says it in words.
    pub status: u16,
    /// Serial number.
    pub serial: u32,
    /// Product name.
    pub name: ShortString,
}

impl IdentityAttributes {
    /// Decodes the data of the reply. Devices may say more than these; that is left alone.
    pub fn decode(data: &[u8]) -> Result<Self, DecodeError> {
        let mut reader = Reader::new(data);
        Ok(Self {
            vendor: reader.u16()?,
            device_type: reader.u16()?,
            product_code: reader.u16()?,
            major: reader.u8()?,
            minor: reader.u8()?,
            status: reader.u16()?,
            serial: reader.u32()?,
            name: ShortString::read(&mut reader)?,
        })
    }

    /// Appends the data of the reply.
    pub fn encode(&self, out: &mut Vec<u8>) {
        for number in [self.vendor, self.device_type, self.product_code] {
            out.extend_from_slice(&number.to_le_bytes());
        }
        out.extend_from_slice(&[self.major, self.minor]);
        out.extend_from_slice(&self.status.to_le_bytes());
        out.extend_from_slice(&self.serial.to_le_bytes());
        self.name.encode(out);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hex_literal::hex;

    #[test]
    fn an_identity_reads_and_writes_the_same_bytes() {
        // layout: OpENer cipidentity.c
        let bytes = hex!("01 00 0E 00 36 00 14 0B 60 31 1E 19 06 C0 04 4C 36 31 42");
        let identity = IdentityAttributes::decode(&bytes).unwrap();
        assert_eq!((identity.vendor, identity.device_type, identity.status), (1, 14, 0x3160));
        assert_eq!(identity.name.text(), "L61B");
        let mut out = Vec::new();
        identity.encode(&mut out);
        assert_eq!(out, bytes);
        assert_eq!(IdentityAttributes::decode(&bytes[..10]).unwrap_err().at, 10);
    }
}
