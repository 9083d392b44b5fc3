//! What the services of the Connection Manager (class 6, instance 1) have in common.

use alloc::vec::Vec;

use super::class::ClassCode;
use super::cursor::{DecodeError, Reader, TooLong};
use super::epath::Epath;
use super::message_router::MessageRouterRequest;
use super::service::ServiceCode;

/// What names a connection for good: no two connections in the world have the same three numbers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ConnectionTriad {
    /// Connection serial number, given by the originator.
    pub serial: u16,
    /// The originator's vendor id.
    pub vendor: u16,
    /// The originator's serial number.
    pub originator: u32,
}

impl ConnectionTriad {
    /// Reads the three numbers.
    pub fn read(reader: &mut Reader<'_>) -> Result<Self, DecodeError> {
        Ok(Self { serial: reader.u16()?, vendor: reader.u16()?, originator: reader.u32()? })
    }

    /// Appends the three numbers.
    pub fn encode(self, out: &mut Vec<u8>) {
        out.extend_from_slice(&self.serial.to_le_bytes());
        out.extend_from_slice(&self.vendor.to_le_bytes());
        out.extend_from_slice(&self.originator.to_le_bytes());
    }
}

/// What follows the status of a refused Forward_Open or Forward_Close: `triad | USINT remaining path (words) | 00`.
/// A refused Unconnected_Send has no triad. Seen from a ControlLogix: `d2 00 01 01 15 03 | 01 00`
/// (st-one-io/node-red-contrib-pccc issue 9); Wireshark calls the reply malformed without the last byte.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RouterRefusal {
    /// Which connection; absent for Unconnected_Send.
    pub triad: Option<ConnectionTriad>,
    /// How many words of the path were left where it failed, if the router says so.
    pub remaining_path: Option<u8>,
}

impl RouterRefusal {
    /// Decodes leniently: devices are known to leave out everything.
    pub fn decode(service: ServiceCode, data: &[u8]) -> Self {
        let mut reader = Reader::new(data);
        let triad = match service {
            ServiceCode::UnconnectedSend => None,
            _ => ConnectionTriad::read(&mut reader).ok(),
        };
        Self { triad, remaining_path: reader.u8().ok() }
    }

    /// Appends what a router says.
    pub fn encode(&self, out: &mut Vec<u8>) {
        if let Some(triad) = self.triad {
            triad.encode(out);
        }
        if self.triad.is_some() || self.remaining_path.is_some() {
            out.extend_from_slice(&[self.remaining_path.unwrap_or(0), 0]);
        }
    }
}

/// A request to the Connection Manager.
pub(super) fn request(service: ServiceCode, data: Vec<u8>) -> Result<MessageRouterRequest, TooLong> {
    MessageRouterRequest::new(service, Epath::object(ClassCode::ConnectionManager.0, 1), data)
}

/// Appends `USINT size (words) | 00 | path`: the form of Unconnected_Send and Forward_Close.
pub(super) fn encode_padded_path(path: &Epath, out: &mut Vec<u8>) -> Result<(), TooLong> {
    let bytes = path.bytes();
    out.extend_from_slice(&[words(&bytes)?, 0]);
    out.extend_from_slice(&bytes);
    Ok(())
}

/// Reads `USINT size (words) | reserved | path`.
pub(super) fn read_padded_path(reader: &mut Reader<'_>) -> Result<Epath, DecodeError> {
    let words = usize::from(reader.u8()?);
    reader.u8()?;
    read_path(words, reader)
}

/// Reads a path of so many words; positions in errors are those of the whole.
pub(super) fn read_path(words: usize, reader: &mut Reader<'_>) -> Result<Epath, DecodeError> {
    let at = reader.at();
    Epath::decode(reader.take(2 * words)?).map_err(|error| error.shifted(at))
}

/// The size of an encoded path.
pub(super) fn words(path: &[u8]) -> Result<u8, TooLong> {
    u8::try_from(path.len() / 2).map_err(|_| TooLong { what: "path", length: path.len(), max: 510 })
}
