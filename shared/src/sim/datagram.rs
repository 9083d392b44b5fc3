//! What the device answers without a session: on UDP, and on TCP as well.

use alloc::vec::Vec;

use crate::wire::{Command, Encapsulation, EncapsulationStatus, Header, ListServicesItem};

use super::device::Device;

/// Answers one UDP datagram: ListIdentity, ListServices, ListInterfaces. Everything else gets no answer.
pub fn handle_datagram(device: &Device, datagram: &[u8]) -> Option<Vec<u8>> {
    let frame = Encapsulation::decode(datagram).ok()?;
    if frame.header.options != 0 {
        return None;
    }
    list_reply(device, frame.header)
}

/// The reply to one of the three List commands.
pub(super) fn list_reply(device: &Device, header: Header) -> Option<Vec<u8>> {
    let mut data = Vec::new();
    match header.command {
        Command::ListIdentity => {
            device.config.identity.list_identity(device.config.address).encode_reply(&mut data);
        }
        Command::ListServices => ListServicesItem::EXPLICIT.encode_reply(&mut data),
        // Item count 0.
        Command::ListInterfaces => data.extend_from_slice(&0_u16.to_le_bytes()),
        _ => return None,
    }
    let mut out = Vec::new();
    Encapsulation::new(device.reply_header(header, EncapsulationStatus::Success), &data)
        .ok()?
        .encode(&mut out);
    Some(out)
}
