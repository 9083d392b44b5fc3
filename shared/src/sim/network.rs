//! TCP/IP Interface object (class 245) and Ethernet Link object (class 246).

use alloc::vec::Vec;

/// TCP/IP Interface: attribute 5, interface configuration. The mask is 255.255.255.0; there is no gateway, name
/// server or domain name.
pub(super) fn tcp_ip(attribute: u16, ip: [u8; 4]) -> Option<Vec<u8>> {
    const MASK: [u8; 4] = [255, 255, 255, 0];
    if attribute != 5 {
        return None;
    }
    // UDINTs: the last number of an address comes first on the wire.
    let [address, mask] = [ip, MASK].map(|number| u32::from_be_bytes(number).to_le_bytes());
    let rest = [0; 3 * 4 + 2];
    Some([&address[..], &mask, &rest].concat())
}

/// Ethernet Link: 1 speed in Mbit/s, 2 flags, 3 MAC address.
pub(super) fn ethernet_link(attribute: u16, serial: u32) -> Option<Vec<u8>> {
    /// Link up, full duplex, speed and duplex negotiated.
    const FLAGS: u32 = 0x0F;
    match attribute {
        1 => Some(100_u32.to_le_bytes().to_vec()),
        2 => Some(FLAGS.to_le_bytes().to_vec()),
        // Locally administered.
        3 => Some([&[0x02, 0x00][..], &serial.to_be_bytes()].concat()),
        _ => None,
    }
}
