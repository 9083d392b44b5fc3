//! Data of `SendRRData`: `UDINT interface handle | UINT timeout (s) | null address item | unconnected data item`.

use alloc::vec::Vec;

use super::common_packet::{CommonPacketFormat, Item, ItemType};
use super::cursor::{DecodeError, DecodeErrorKind, Reader, TooLong};
use super::encapsulation::{Encapsulation, HEADER_SIZE, Header, MAX_DATA};

/// Interface handle, timeout, item count and two item headers.
const ENVELOPE: u16 = 16;

/// Longest message in one frame.
pub const MAX_MESSAGE: usize = MAX_DATA - ENVELOPE as usize;

/// A message router request or reply that is short enough for one frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct UnconnectedMessage<'a> {
    length: u16,
    bytes: &'a [u8],
}

impl<'a> UnconnectedMessage<'a> {
    /// Refuses what is over [`MAX_MESSAGE`].
    pub fn new(bytes: &'a [u8]) -> Result<Self, TooLong> {
        match u16::try_from(bytes.len()) {
            Ok(length) if bytes.len() <= MAX_MESSAGE => Ok(Self { length, bytes }),
            _ => Err(TooLong { what: "message", length: bytes.len(), max: MAX_MESSAGE }),
        }
    }

    /// Appends a whole `SendRRData` frame. `timeout` is in seconds; 0 leaves it to CIP.
    pub fn encode(&self, header: &Header, timeout: u16, out: &mut Vec<u8>) {
        let start = out.len();
        Encapsulation::empty(*header).encode(out);
        // The length is known now: the envelope and the message fit by construction.
        let length = (ENVELOPE + self.length).to_le_bytes();
        if let Some(field) = out.get_mut(start + 2..start + 4) {
            field.copy_from_slice(&length);
        }
        out.extend_from_slice(&0_u32.to_le_bytes());
        out.extend_from_slice(&timeout.to_le_bytes());
        out.extend_from_slice(&2_u16.to_le_bytes());
        Item::encode(ItemType::NullAddress, 0, &[], out);
        Item::encode(ItemType::UnconnectedData, self.length, self.bytes, out);
    }
}

/// Decoded data of a `SendRRData` frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SendRrData<'a> {
    /// 0 = CIP.
    pub interface_handle: u32,
    /// Seconds; 0 leaves it to CIP.
    pub timeout: u16,
    /// The items.
    pub packet: CommonPacketFormat<'a>,
}

impl<'a> SendRrData<'a> {
    /// Decodes the data part of a frame; positions are counted from the start of the frame.
    pub fn decode(data: &'a [u8]) -> Result<Self, DecodeError> {
        let mut reader = Reader::starting_at(data, HEADER_SIZE);
        let interface_handle = reader.u32()?;
        let timeout = reader.u16()?;
        let packet = CommonPacketFormat::read(&mut reader)?;
        reader.finish()?;
        Ok(Self { interface_handle, timeout, packet })
    }

    /// The unconnected message: its position in the frame, and its bytes.
    pub fn unconnected(&self) -> Result<Item<'a>, DecodeError> {
        let missing = DecodeError {
            at: HEADER_SIZE + 6,
            kind: DecodeErrorKind::Unexpected {
                field: "items without unconnected data: count",
                found: self.packet.count().into(),
            },
        };
        self.packet.find(ItemType::UnconnectedData).ok_or(missing)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::wire::{Command, EncapsulationStatus, SenderContext, SessionHandle};
    use hex_literal::hex;

    /// Omron NX over EtherNet/IP, cnblogs xiketang 13664904: reply to the read of TAG1.
    const GOLDEN: [u8; 48] = hex!(
        "6F 00 18 00 71 01 14 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00"
        "00 00 00 00 01 00 02 00 00 00 00 00 B2 00 08 00 CC 00 00 00 C1 00 00 00"
    );

    #[test]
    fn the_articles_reply_decodes_and_re_encodes() {
        let frame = Encapsulation::decode(&GOLDEN).unwrap();
        assert_eq!(frame.header.command, Command::SendRRData);
        let data = SendRrData::decode(frame.data()).unwrap();
        assert_eq!((data.timeout, data.packet.count()), (1, 2));
        let message = data.unconnected().unwrap();
        assert_eq!((message.at, message.data), (40, &hex!("CC 00 00 00 C1 00 00 00")[..]));

        let header = Header {
            command: Command::SendRRData,
            session: SessionHandle(0x0014_0171),
            status: EncapsulationStatus::Success,
            context: SenderContext::default(),
            options: 0,
        };
        let mut out = Vec::new();
        UnconnectedMessage::new(message.data).unwrap().encode(&header, 1, &mut out);
        assert_eq!(out, GOLDEN);
    }

    #[test]
    fn an_item_that_is_cut_names_the_byte() {
        let mut cut = GOLDEN[24..].to_vec();
        cut.truncate(20);
        assert_eq!(SendRrData::decode(&cut).unwrap_err().at, 44);
    }

    #[test]
    fn a_message_over_the_maximum_is_refused() {
        let bytes = alloc::vec![0; MAX_MESSAGE + 1];
        assert!(UnconnectedMessage::new(&bytes).is_err());
        assert!(UnconnectedMessage::new(&bytes[1..]).is_ok());
    }
}
