//! Identity object, class 1.

use alloc::vec::Vec;

use crate::wire::{ListIdentityItem, PROTOCOL_VERSION, ShortString, SocketAddress};

/// Who the simulated device says it is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SimIdentity {
    /// Attribute 1.
    pub vendor: u16,
    /// Attribute 2.
    pub device_type: u16,
    /// Attribute 3.
    pub product_code: u16,
    /// Attribute 4: major and minor.
    pub revision: (u8, u8),
    /// Attribute 6; also in the MAC address.
    pub serial: u32,
    /// Attribute 7.
    pub name: ShortString,
}

impl Default for SimIdentity {
    /// A drive of nobody: vendor 65535, so that it is not taken for a product.
    fn default() -> Self {
        Self {
            vendor: u16::MAX,
            device_type: 0x02,
            product_code: 1,
            revision: (1, 1),
            serial: 0x00C1_DEC0,
            name: ShortString::new(b"cipdeck demo drive").unwrap_or_default(),
        }
    }
}

/// Attribute 5: not owned, not configured, extended status 3 = no I/O connection.
const STATUS: u16 = 0x0030;

/// ListIdentity only: operational.
const OPERATIONAL: u8 = 3;

/// The attributes of Get_Attributes_All.
pub(super) const ATTRIBUTES: core::ops::RangeInclusive<u16> = 1..=7;

impl SimIdentity {
    pub(super) fn read(&self, attribute: u16) -> Option<Vec<u8>> {
        Some(match attribute {
            1 => self.vendor.to_le_bytes().to_vec(),
            2 => self.device_type.to_le_bytes().to_vec(),
            3 => self.product_code.to_le_bytes().to_vec(),
            4 => alloc::vec![self.revision.0, self.revision.1],
            5 => STATUS.to_le_bytes().to_vec(),
            6 => self.serial.to_le_bytes().to_vec(),
            7 => {
                let mut out = Vec::new();
                self.name.encode(&mut out);
                out
            }
            _ => return None,
        })
    }

    pub(super) fn all(&self) -> Vec<u8> {
        ATTRIBUTES.filter_map(|attribute| self.read(attribute)).flatten().collect()
    }

    pub(super) fn list_identity(&self, address: SocketAddress) -> ListIdentityItem {
        ListIdentityItem {
            protocol_version: PROTOCOL_VERSION,
            address,
            vendor: self.vendor,
            device_type: self.device_type,
            product_code: self.product_code,
            major: self.revision.0,
            minor: self.revision.1,
            status: STATUS,
            serial: self.serial,
            name: self.name.clone(),
            state: OPERATIONAL,
        }
    }
}
