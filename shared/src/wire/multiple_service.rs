//! Multiple_Service_Packet, service 0x0A of the Message Router: several requests in one.
//!
//! `UINT count | UINT offset[count] | requests`; offsets count from the count field. The requests lie one behind the
//! other, each up to the next one's offset, as pycomm3 (packets/logix.py) and libplctag write them: an offset that goes
//! back, or leaves bytes that belong to nobody, is refused, because two readers could see different requests there.

use alloc::vec::Vec;

use super::class::ClassCode;
use super::cursor::{DecodeError, DecodeErrorKind, Reader, TooLong};
use super::epath::Epath;
use super::message_router::MessageRouterRequest;
use super::service::ServiceCode;

/// The requests of one packet, in order. Never empty.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MultipleServicePacket<'a> {
    parts: Vec<&'a [u8]>,
}

impl<'a> MultipleServicePacket<'a> {
    /// Refuses no request at all, an empty request, and what 16-bit offsets cannot reach.
    pub fn new(parts: Vec<&'a [u8]>) -> Option<Self> {
        let length = Self::head(parts.len()) + parts.iter().map(|part| part.len()).sum::<usize>();
        let whole = !parts.is_empty() && parts.iter().all(|part| !part.is_empty());
        (whole && u16::try_from(length).is_ok()).then_some(Self { parts })
    }

    /// Message router requests, undecoded.
    pub fn parts(&self) -> &[&'a [u8]] {
        &self.parts
    }

    /// The request to the Message Router; refuses what does not fit into a frame.
    pub fn request(&self) -> Result<MessageRouterRequest, TooLong> {
        let mut data = Vec::new();
        // `new` has refused what 16 bits cannot count.
        let short = |number: usize| u16::try_from(number).unwrap_or(u16::MAX).to_le_bytes();
        data.extend_from_slice(&short(self.parts.len()));
        let mut offset = Self::head(self.parts.len());
        for part in &self.parts {
            data.extend_from_slice(&short(offset));
            offset += part.len();
        }
        data.extend(self.parts.iter().copied().flatten());
        MessageRouterRequest::new(
            ServiceCode::MultipleServicePacket,
            Epath::object(ClassCode::MessageRouter.0, 1),
            data,
        )
    }

    /// Decodes the data of the request.
    pub fn decode(data: &'a [u8]) -> Result<Self, DecodeError> {
        parts(data).map(|parts| Self { parts })
    }

    /// Bytes of the count and the offsets.
    const fn head(count: usize) -> usize {
        2 + 2 * count
    }
}

/// The data of the reply: one message router reply for each request, in their order. The general status around it is
/// 0, or 0x1E when a part has failed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MultipleServiceReply<'a> {
    parts: Vec<&'a [u8]>,
}

impl<'a> MultipleServiceReply<'a> {
    /// Decodes the data of the reply.
    pub fn decode(data: &'a [u8]) -> Result<Self, DecodeError> {
        parts(data).map(|parts| Self { parts })
    }

    /// Message router replies, undecoded.
    pub fn parts(&self) -> &[&'a [u8]] {
        &self.parts
    }

    /// The data of a reply with these parts; refuses what 16-bit offsets cannot reach.
    pub fn data(parts: &[Vec<u8>]) -> Option<Vec<u8>> {
        let mut data = u16::try_from(parts.len()).ok()?.to_le_bytes().to_vec();
        let mut offset = MultipleServicePacket::head(parts.len());
        for part in parts {
            data.extend_from_slice(&u16::try_from(offset).ok()?.to_le_bytes());
            offset += part.len();
        }
        data.extend(parts.iter().flatten());
        Some(data)
    }
}

/// The parts between the offsets: requests and replies have the same form.
fn parts(data: &[u8]) -> Result<Vec<&[u8]>, DecodeError> {
    let mut reader = Reader::new(data);
    let count = usize::from(reader.u16()?);
    let unexpected = |at: usize, field: &'static str, found: u16| DecodeError {
        at,
        kind: DecodeErrorKind::Unexpected { field, found: found.into() },
    };
    if count == 0 {
        return Err(unexpected(0, "request count", 0));
    }
    let head = MultipleServicePacket::head(count);
    let mut offsets = reader.sub(2 * count)?;
    let mut ends = offsets.clone();
    let first = ends.u16()?;
    if usize::from(first) != head {
        return Err(unexpected(offsets.at(), "offset of the first request", first));
    }
    let mut parts = Vec::with_capacity(count);
    while let Ok(from) = offsets.u16() {
        let at = ends.at();
        // The last request ends with the data.
        let to = ends.u16().map_or(data.len(), usize::from);
        let part = data.get(from.into()..to).filter(|part| !part.is_empty());
        let wrong = || {
            if at == head {
                return DecodeError { at: data.len(), kind: DecodeErrorKind::Truncated { needed: 1 } };
            }
            unexpected(at, "request offset", u16::try_from(to).unwrap_or(u16::MAX))
        };
        parts.push(part.ok_or_else(wrong)?);
    }
    Ok(parts)
}

#[cfg(test)]
mod tests {
    use super::*;
    use hex_literal::hex;

    const NAME: [u8; 8] = hex!("0E 03 20 01 24 01 30 07");
    const TAG: [u8; 10] = hex!("4C 03 91 04 54 41 47 31 01 00");

    #[test]
    fn two_requests_lie_one_behind_the_other() {
        // layout of pycomm3 packets/logix.py: offsets count from the count field
        let packet = MultipleServicePacket::new(alloc::vec![&NAME, &TAG]).unwrap();
        let golden =
            hex!("0A 02 20 02 24 01 02 00 06 00 0E 00 0E 03 20 01 24 01 30 07 4C 03 91 04 54 41 47 31 01 00");
        assert_eq!(packet.request().unwrap().bytes(), golden);
        assert_eq!(MultipleServicePacket::decode(&golden[6..]), Ok(packet));
    }

    #[test]
    fn what_could_be_read_in_two_ways_is_refused_at_its_byte() {
        for (data, at) in [
            (&hex!("")[..], 0),
            (&hex!("01"), 1),
            (&hex!("00 00"), 0),
            (&hex!("02 00 06 00"), 4),
            (&hex!("01 00 04 00"), 4),
            (&hex!("01 00 06 00 AA BB CC DD"), 2),
            (&hex!("01 00 02 00 AA BB"), 2),
            (&hex!("02 00 06 00 06 00 AA BB"), 4),
            (&hex!("02 00 06 00 05 00 AA BB"), 4),
            (&hex!("02 00 06 00 09 00 AA BB"), 4),
            (&hex!("02 00 06 00 08 00 AA BB"), 8),
            (&hex!("FF FF 06 00 08 00 AA BB"), 8),
        ] {
            assert_eq!(MultipleServicePacket::decode(data).unwrap_err().at, at, "{data:02x?}");
        }
    }

    #[test]
    fn what_no_offset_can_say_is_refused_when_it_is_made() {
        let long = alloc::vec![0; 40_000];
        for parts in [Vec::new(), alloc::vec![&NAME[..], &[]], alloc::vec![&long[..], &long[..]]] {
            assert_eq!(MultipleServicePacket::new(parts), None);
        }
    }
}
