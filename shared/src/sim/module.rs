//! Modules of the chassis and devices on its Ethernet: where they are, and who they are.

use alloc::vec::Vec;

use crate::wire::ShortString;

use super::identity::SimIdentity;

/// Port number of the backplane.
pub const BACKPLANE: u16 = 1;

/// Port number of the Ethernet.
pub const ETHERNET: u16 = 2;

/// A simulated device beside the one at the end of the TCP connection. One with a slot *and* an address is a bridge
/// between the two.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SimModule {
    /// Where it is in the chassis: behind [port 1](BACKPLANE).
    pub slot: Option<u8>,
    /// Where it is on the Ethernet: behind [port 2](ETHERNET).
    pub ip: Option<[u8; 4]>,
    /// Who it is.
    pub identity: SimIdentity,
}

impl SimModule {
    /// Slot of the device at the end of the TCP connection.
    pub const OWN_SLOT: u8 = 0;

    /// Slot 1: I/O. Slot 3: a bridge, 192.168.1.10 on the Ethernet. 192.168.1.20: another drive.
    pub fn usual() -> Vec<Self> {
        let module = |slot, ip, device_type, serial, name: &[u8]| {
            let name = ShortString::new(name).unwrap_or_default();
            let identity = SimIdentity { device_type, serial, name, ..SimIdentity::default() };
            Self { slot, ip, identity }
        };
        // Device types: 0x07 general purpose discrete I/O, 0x0C communications adapter, 0x02 AC drive.
        alloc::vec![
            module(Some(1), None, 0x07, 0x00C1_DEC1, b"cipdeck demo I/O"),
            module(Some(3), Some([192, 168, 1, 10]), 0x0C, 0x00C1_DEC3, b"cipdeck demo bridge"),
            module(None, Some([192, 168, 1, 20]), 0x02, 0x00C1_DEC4, b"cipdeck demo remote"),
        ]
    }
}
