//! Message router request and reply.
//!
//! Request: `service | path size (words) | path | data`.
//! Reply: `service + 0x80 | 00 | general status | additional status size (words) | additional status | data`.
//! Source: Omron W506 8-3; the documents for Schneider SEND_REQ and Omron NX agree.

use alloc::vec::Vec;

use super::cursor::{DecodeError, DecodeErrorKind, Reader, TooLong};
use super::epath::Epath;
use super::send_rr_data::MAX_MESSAGE;
use super::service::ServiceCode;
use super::status::GeneralStatus;

/// A request that fits on the wire.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MessageRouterRequest {
    service: ServiceCode,
    path: Epath,
    data: Vec<u8>,
}

impl MessageRouterRequest {
    /// Refuses a service over 127, a path over 255 words, and a message that is too long for one frame.
    pub fn new(service: ServiceCode, path: Epath, data: Vec<u8>) -> Result<Self, TooLong> {
        let request = Self { service, path, data };
        let path_bytes = request.path.bytes().len();
        if service.0 >= ServiceCode::REPLY {
            return Err(TooLong { what: "service code", length: service.0.into(), max: 127 });
        }
        if path_bytes > 2 * usize::from(u8::MAX) {
            return Err(TooLong { what: "path", length: path_bytes, max: 2 * usize::from(u8::MAX) });
        }
        let length = 2 + path_bytes + request.data.len();
        if length > MAX_MESSAGE {
            return Err(TooLong { what: "message", length, max: MAX_MESSAGE });
        }
        Ok(request)
    }

    /// 1..=127.
    pub const fn service(&self) -> ServiceCode {
        self.service
    }

    /// Which object, attribute and member.
    pub const fn path(&self) -> &Epath {
        &self.path
    }

    /// What follows the path.
    pub fn data(&self) -> &[u8] {
        &self.data
    }

    /// Decodes a whole request.
    pub fn decode(bytes: &[u8]) -> Result<Self, DecodeError> {
        let mut reader = Reader::new(bytes);
        let service = ServiceCode(reader.u8()?);
        if service.0 >= ServiceCode::REPLY {
            let kind = DecodeErrorKind::Unexpected { field: "service of a request", found: service.0.into() };
            return Err(DecodeError { at: 0, kind });
        }
        let words = usize::from(reader.u8()?);
        let path_at = reader.at();
        let path = Epath::decode(reader.take(2 * words)?).map_err(|error| error.shifted(path_at))?;
        Ok(Self { service, path, data: reader.rest().to_vec() })
    }

    /// Appends the request.
    pub fn encode(&self, out: &mut Vec<u8>) {
        out.push(self.service.0);
        let size_at = out.len();
        out.push(0);
        self.path.encode(out);
        let words = (out.len() - size_at - 1) / 2;
        if let (Some(size), Ok(words)) = (out.get_mut(size_at), u8::try_from(words)) {
            *size = words;
        }
        out.extend_from_slice(&self.data);
    }

    /// The encoded request.
    pub fn bytes(&self) -> Vec<u8> {
        let mut out = Vec::new();
        self.encode(&mut out);
        out
    }
}

/// Additional status words of a reply: any number from 0 to 255.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct AdditionalStatus<'a> {
    words: u8,
    bytes: &'a [u8],
}

impl<'a> AdditionalStatus<'a> {
    /// From little endian words; refuses an odd number of bytes and more than 255 words.
    pub fn new(bytes: &'a [u8]) -> Option<Self> {
        let words = u8::try_from(bytes.len() / 2).ok()?;
        bytes.len().is_multiple_of(2).then_some(Self { words, bytes })
    }

    /// The words in order; the first is the block's `ExtErrorID`.
    pub fn words(&self) -> impl ExactSizeIterator<Item = u16> + 'a {
        self.bytes.as_chunks::<2>().0.iter().map(|word| u16::from_le_bytes(*word))
    }
}

/// A reply: the device's answer, success or refusal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MessageRouterReply<'a> {
    /// The service that is answered, without the reply bit.
    pub service: ServiceCode,
    /// 0 is success.
    pub status: GeneralStatus,
    /// More about a refusal.
    pub additional: AdditionalStatus<'a>,
    /// The service's answer.
    pub data: &'a [u8],
}

impl<'a> MessageRouterReply<'a> {
    /// A success with its data.
    pub const fn success(service: ServiceCode, data: &'a [u8]) -> Self {
        Self {
            service,
            status: GeneralStatus::Success,
            additional: AdditionalStatus { words: 0, bytes: &[] },
            data,
        }
    }

    /// A refusal without additional status.
    pub const fn refusal(service: ServiceCode, status: GeneralStatus) -> Self {
        Self { service, status, additional: AdditionalStatus { words: 0, bytes: &[] }, data: &[] }
    }

    /// Decodes a whole reply.
    pub fn decode(bytes: &'a [u8]) -> Result<Self, DecodeError> {
        let mut reader = Reader::new(bytes);
        let service = reader.u8()?;
        if service & ServiceCode::REPLY == 0 {
            let kind = DecodeErrorKind::Unexpected { field: "service of a reply", found: service.into() };
            return Err(DecodeError { at: 0, kind });
        }
        // Byte 1 is reserved; devices are known to put anything there.
        reader.u8()?;
        let status = GeneralStatus(reader.u8()?);
        let words = reader.u8()?;
        let additional = AdditionalStatus { words, bytes: reader.take(2 * usize::from(words))? };
        Ok(Self {
            service: ServiceCode(service & !ServiceCode::REPLY),
            status,
            additional,
            data: reader.rest(),
        })
    }

    /// Appends the reply.
    pub fn encode(&self, out: &mut Vec<u8>) {
        out.extend_from_slice(&[
            self.service.0 | ServiceCode::REPLY,
            0,
            self.status.0,
            self.additional.words,
        ]);
        out.extend_from_slice(self.additional.bytes);
        out.extend_from_slice(self.data);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::wire::LogicalKind;
    use hex_literal::hex;

    #[test]
    fn identity_product_name_is_eight_bytes() {
        // PowerFlex and E1 Plus manuals, 193-UM015 p. 505
        let path = Epath::object(1, 1).then(LogicalKind::Attribute, 7);
        let request = MessageRouterRequest::new(ServiceCode::GetAttributeSingle, path, Vec::new()).unwrap();
        assert_eq!(request.bytes(), hex!("0E 03 20 01 24 01 30 07"));
        assert_eq!(MessageRouterRequest::decode(&request.bytes()), Ok(request));
    }

    #[test]
    fn a_reply_keeps_every_additional_status_word() {
        let reply = MessageRouterReply::decode(&hex!("8E 00 01 02 15 03 01 00 AA")).unwrap();
        assert_eq!(
            (reply.service, reply.status),
            (ServiceCode::GetAttributeSingle, GeneralStatus::ConnectionFailure)
        );
        assert_eq!(reply.additional.words().collect::<Vec<_>>(), [0x0315, 0x0001]);
        assert_eq!(reply.data, [0xAA]);
        let mut out = Vec::new();
        reply.encode(&mut out);
        assert_eq!(out, hex!("8E 00 01 02 15 03 01 00 AA"));
    }

    #[test]
    fn a_reply_cut_in_its_additional_status_names_the_byte() {
        assert_eq!(MessageRouterReply::decode(&hex!("8E 00 01 02 15")).unwrap_err().at, 5);
    }

    #[test]
    fn what_does_not_fit_is_refused_when_it_is_made() {
        let get = ServiceCode::GetAttributeSingle;
        assert!(MessageRouterRequest::new(ServiceCode(0x8E), Epath::object(1, 1), Vec::new()).is_err());
        assert!(MessageRouterRequest::new(get, Epath::object(1, 1), alloc::vec![0; MAX_MESSAGE]).is_err());
        let long = (0..256).fold(Epath::default(), |path, _| path.then(LogicalKind::Member, 1));
        assert!(MessageRouterRequest::new(get, long, Vec::new()).is_err());
    }
}
