//! Unconnected_Send, service 0x52 of the Connection Manager: a message and the route to its target.
//!
//! `tick | ticks | UINT length | message | 00 if the length is odd | USINT route size (words) | 00 | route`. The reply
//! is the inner service's own; an error of a router on the way is a reply of 0x52. Source: pycomm3
//! `wrap_unconnected_send`, Omron NX over EtherNet/IP (cnblogs xiketang 13664904).

use super::connection_manager;
use super::cursor::{DecodeError, Reader, TooLong};
use super::epath::Epath;
use super::message_router::MessageRouterRequest;
use super::request_timeout::RequestTimeout;
use super::service::ServiceCode;

/// A message on a route.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnconnectedSend<'a> {
    /// How long the last router waits for the target.
    pub timeout: RequestTimeout,
    /// Message router request.
    pub message: &'a [u8],
    /// Port segments.
    pub route: Epath,
}

impl<'a> UnconnectedSend<'a> {
    /// The request to the Connection Manager; refuses what does not fit into a frame.
    pub fn request(&self) -> Result<MessageRouterRequest, TooLong> {
        let length = u16::try_from(self.message.len()).map_err(|_| TooLong {
            what: "message",
            length: self.message.len(),
            max: u16::MAX.into(),
        })?;
        let mut data = self.timeout.bytes().to_vec();
        data.extend_from_slice(&length.to_le_bytes());
        data.extend_from_slice(self.message);
        if !self.message.len().is_multiple_of(2) {
            data.push(0);
        }
        connection_manager::encode_padded_path(&self.route, &mut data)?;
        connection_manager::request(ServiceCode::UnconnectedSend, data)
    }

    /// Decodes the data of the request.
    pub fn decode(data: &'a [u8]) -> Result<Self, DecodeError> {
        let mut reader = Reader::new(data);
        let timeout = RequestTimeout::read(&mut reader)?;
        let length = usize::from(reader.u16()?);
        let message = reader.take(length)?;
        if !length.is_multiple_of(2) {
            reader.u8()?;
        }
        let route = connection_manager::read_padded_path(&mut reader)?;
        reader.finish()?;
        Ok(Self { timeout, message, route })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::wire::PortSegment;
    use hex_literal::hex;

    fn backplane() -> Epath {
        Epath::default().hop(PortSegment::new(1, 0).unwrap())
    }

    #[test]
    fn a_message_to_slot_0_is_the_documented_one() {
        // built from the layout of pycomm3 wrap_unconnected_send; 3000 ms are 3008
        let message = hex!("0E 03 20 0F 24 27 30 01");
        let send = UnconnectedSend {
            timeout: RequestTimeout::at_least(3_000),
            message: &message,
            route: backplane(),
        };
        let golden = hex!("52 02 20 06 24 01 04 BC 08 00 0E 03 20 0F 24 27 30 01 01 00 01 00");
        assert_eq!(send.request().unwrap().bytes(), golden);
        assert_eq!(UnconnectedSend::decode(&golden[6..]), Ok(send));
    }

    #[test]
    fn an_odd_message_is_padded_and_the_length_does_not_count_the_pad() {
        let message = hex!("10 03 20 04 24 96 30 03 55");
        let send =
            UnconnectedSend { timeout: RequestTimeout::at_least(250), message: &message, route: backplane() };
        let data = hex!("00 FA 09 00 10 03 20 04 24 96 30 03 55 00 01 00 01 00");
        assert_eq!(send.request().unwrap().data(), data);
        assert_eq!(UnconnectedSend::decode(&data), Ok(send));
        assert_eq!(UnconnectedSend::decode(&data[..13]).unwrap_err().at, 13);
    }
}
