//! Forward_Close 0x4E: ends a connection.
//!
//! `tick | ticks | triad | USINT path size (words) | 00 | path`: with a reserved byte before the path, unlike
//! Forward_Open. Source: pycomm3 `pad_length`, OpENer cipconnectionmanager.c.

use alloc::vec::Vec;

use super::connection_manager::{self, ConnectionTriad};
use super::cursor::{DecodeError, Reader, TooLong};
use super::epath::Epath;
use super::message_router::MessageRouterRequest;
use super::request_timeout::RequestTimeout;
use super::service::ServiceCode;

/// A request to end a connection.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ForwardClose {
    /// How long routers wait for the next one.
    pub timeout: RequestTimeout,
    /// Which connection.
    pub triad: ConnectionTriad,
    /// As in the Forward_Open.
    pub path: Epath,
}

impl ForwardClose {
    /// The request to the Connection Manager.
    pub fn request(&self) -> Result<MessageRouterRequest, TooLong> {
        let mut data = self.timeout.bytes().to_vec();
        self.triad.encode(&mut data);
        connection_manager::encode_padded_path(&self.path, &mut data)?;
        connection_manager::request(ServiceCode::ForwardClose, data)
    }

    /// Decodes the data of the request.
    pub fn decode(data: &[u8]) -> Result<Self, DecodeError> {
        let mut reader = Reader::new(data);
        let timeout = RequestTimeout::read(&mut reader)?;
        let triad = ConnectionTriad::read(&mut reader)?;
        let path = connection_manager::read_padded_path(&mut reader)?;
        reader.finish()?;
        Ok(Self { timeout, triad, path })
    }
}

/// The target's answer: `triad | USINT words | 00 | words`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ForwardCloseReply {
    /// Which connection.
    pub triad: ConnectionTriad,
}

impl ForwardCloseReply {
    /// Decodes the data of the reply; the application's own words are not looked at.
    pub fn decode(data: &[u8]) -> Result<Self, DecodeError> {
        Ok(Self { triad: ConnectionTriad::read(&mut Reader::new(data))? })
    }

    /// Appends the data of the reply.
    pub fn encode(&self, out: &mut Vec<u8>) {
        self.triad.encode(out);
        out.extend_from_slice(&[0, 0]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hex_literal::hex;

    #[test]
    fn the_request_is_the_test_vector() {
        // built from the layout of pycomm3
        let golden = hex!("4E 02 20 06 24 01 0A 0E 0100 3713 EFBEADDE 02 00 20 02 24 01");
        let close = ForwardClose {
            timeout: RequestTimeout::read(&mut Reader::new(&[0x0A, 0x0E])).unwrap(),
            triad: ConnectionTriad { serial: 1, vendor: 0x1337, originator: 0xDEAD_BEEF },
            path: Epath::object(2, 1),
        };
        assert_eq!(close.request().unwrap().bytes(), golden);
        assert_eq!(ForwardClose::decode(&golden[6..]), Ok(close));
    }
}
