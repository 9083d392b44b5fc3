//! Data of `SendUnitData`: `UDINT 0 | UINT 0 | connected address item | connected data item`. The data item of a class 3
//! connection is `UINT sequence count | message`.

use alloc::vec::Vec;

use super::common_packet::{Item, ItemType};
use super::cursor::{DecodeError, DecodeErrorKind, Reader, TooLong};
use super::encapsulation::{Encapsulation, HEADER_SIZE, Header, MAX_DATA};
use super::send_rr_data::SendRrData;

/// Interface handle, timeout, item count, the address item, and the data item's header and sequence count.
const ENVELOPE: u16 = 22;

/// Longest connected message in one frame.
pub const MAX_CONNECTED_MESSAGE: usize = MAX_DATA - ENVELOPE as usize;

/// One direction of a connection. The receiver of the packets picks it, or says it for the other side.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ConnectionId(pub u32);

/// A message router request or reply that is short enough for one connected frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ConnectedMessage<'a> {
    length: u16,
    bytes: &'a [u8],
}

impl<'a> ConnectedMessage<'a> {
    /// Refuses what is over [`MAX_CONNECTED_MESSAGE`].
    pub fn new(bytes: &'a [u8]) -> Result<Self, TooLong> {
        match u16::try_from(bytes.len()) {
            Ok(length) if bytes.len() <= MAX_CONNECTED_MESSAGE => Ok(Self { length, bytes }),
            _ => Err(TooLong { what: "message", length: bytes.len(), max: MAX_CONNECTED_MESSAGE }),
        }
    }

    /// Appends a whole `SendUnitData` frame.
    pub fn encode(&self, header: &Header, id: ConnectionId, sequence: u16, out: &mut Vec<u8>) {
        let start = out.len();
        Encapsulation::empty(*header).encode(out);
        // The length is known now: the envelope and the message fit by construction.
        if let Some(field) = out.get_mut(start + 2..start + 4) {
            field.copy_from_slice(&(ENVELOPE + self.length).to_le_bytes());
        }
        out.extend_from_slice(&[0; 6]);
        out.extend_from_slice(&2_u16.to_le_bytes());
        Item::encode(ItemType::ConnectedAddress, 4, &id.0.to_le_bytes(), out);
        Item::encode(ItemType::ConnectedData, 2 + self.length, &sequence.to_le_bytes(), out);
        out.extend_from_slice(self.bytes);
    }
}

/// A connected message that came in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ConnectedItem<'a> {
    /// Which connection.
    pub id: ConnectionId,
    /// Echoed by the target.
    pub sequence: u16,
    /// The position of the message's first byte in the frame.
    pub at: usize,
    /// Message router request or reply.
    pub message: &'a [u8],
}

impl<'a> SendRrData<'a> {
    /// The connected message; `SendUnitData` has the same layout as `SendRRData`.
    pub fn connected(&self) -> Result<ConnectedItem<'a>, DecodeError> {
        let missing = |field| {
            let kind = DecodeErrorKind::Unexpected { field, found: self.packet.count().into() };
            DecodeError { at: HEADER_SIZE + 6, kind }
        };
        let address = self.packet.find(ItemType::ConnectedAddress);
        let address = address.ok_or_else(|| missing("items without connected address: count"))?;
        let data = self.packet.find(ItemType::ConnectedData);
        let data = data.ok_or_else(|| missing("items without connected data: count"))?;
        let mut reader = Reader::starting_at(address.data, address.at);
        let id = ConnectionId(reader.u32()?);
        reader.finish()?;
        let mut reader = Reader::starting_at(data.data, data.at);
        let sequence = reader.u16()?;
        Ok(ConnectedItem { id, sequence, at: reader.at(), message: reader.rest() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::wire::{Command, SenderContext, SessionHandle};
    use hex_literal::hex;

    #[test]
    fn a_connected_request_decodes_to_what_was_encoded() {
        // built from the layout of OpENer cpf.h and pycomm3
        let golden = hex!(
            "70 00 1E 00 04 03 02 01 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00"
            "00 00 00 00 00 00 02 00 A1 00 04 00 44 33 22 11 B1 00 0A 00 05 00 0E 03 20 01 24 01 30 07"
        );
        let header =
            Header::request(Command::SendUnitData, SessionHandle(0x0102_0304), SenderContext::default());
        let message = hex!("0E 03 20 01 24 01 30 07");
        let mut out = Vec::new();
        ConnectedMessage::new(&message).unwrap().encode(&header, ConnectionId(0x1122_3344), 5, &mut out);
        assert_eq!(out, golden);
        let frame = Encapsulation::decode(&golden).unwrap();
        let item = SendRrData::decode(frame.data()).unwrap().connected().unwrap();
        assert_eq!(
            item,
            ConnectedItem { id: ConnectionId(0x1122_3344), sequence: 5, at: 46, message: &message }
        );
    }

    #[test]
    fn what_is_missing_is_named() {
        let unconnected = hex!("00 00 00 00 00 00 02 00 00 00 00 00 B2 00 00 00");
        let error = SendRrData::decode(&unconnected).unwrap().connected().unwrap_err();
        assert_eq!(error.at, 30);
        let cut = hex!("00 00 00 00 00 00 02 00 A1 00 04 00 44 33 22 11 B1 00 01 00 05");
        assert_eq!(SendRrData::decode(&cut).unwrap().connected().unwrap_err().at, 45);
    }

    #[test]
    fn a_message_over_the_maximum_is_refused() {
        let bytes = alloc::vec![0; MAX_CONNECTED_MESSAGE + 1];
        assert!(ConnectedMessage::new(&bytes).is_err());
        assert!(ConnectedMessage::new(&bytes[1..]).is_ok());
    }
}
