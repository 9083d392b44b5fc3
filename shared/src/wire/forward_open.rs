//! Forward_Open 0x54 and Large_Forward_Open 0x5B: open a connection through the Connection Manager.
//!
//! `tick | ticks | UDINT O->T id | UDINT T->O id | triad | USINT multiplier | 3 reserved | UDINT O->T RPI (us) | params |
//! UDINT T->O RPI | params | USINT class and trigger | USINT path size (words) | path`; no reserved byte before the path.
//! Parameters are a UINT in 0x54 and a UDINT in 0x5B. Source: OpENer `ConnectionObjectInitializeFromMessage`, pycomm3.

use alloc::vec::Vec;

use super::connection_manager::{self, ConnectionTriad};
use super::cursor::{DecodeError, Reader, TooLong};
use super::epath::Epath;
use super::message_router::MessageRouterRequest;
use super::request_timeout::RequestTimeout;
use super::send_unit_data::ConnectionId;
use super::service::ServiceCode;

/// Largest connection size that Forward_Open 0x54 can say: 9 bits.
pub const MAX_CLASSIC_SIZE: u16 = 511;

/// A request for a connection.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ForwardOpen {
    /// How long routers wait for the next one.
    pub timeout: RequestTimeout,
    /// Originator to target: 0, the target picks it.
    pub o_t_id: ConnectionId,
    /// Target to originator: picked by the originator.
    pub t_o_id: ConnectionId,
    /// Name of the connection.
    pub triad: ConnectionTriad,
    /// After how many silent intervals either side gives up.
    pub multiplier: TimeoutMultiplier,
    /// Requested packet interval from originator to target, us.
    pub o_t_rpi_us: u32,
    /// From originator to target.
    pub o_t: ConnectionParameters,
    /// Requested packet interval from target to originator, us.
    pub t_o_rpi_us: u32,
    /// From target to originator.
    pub t_o: ConnectionParameters,
    /// [`ForwardOpen::CLASS_3`] for explicit messages.
    pub transport: u8,
    /// Route and object: explicit messages end at the Message Router, `20 02 24 01`.
    pub path: Epath,
}

/// Size and kind of one direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ConnectionParameters {
    /// Bytes of one packet, with the sequence count.
    pub size: u16,
    /// Bits 15..9 of the 16-bit form: redundant owner, type, priority, variable size.
    flags: u16,
}

/// How long a connection may be silent: `RPI x (4 << n)`. OpENer cipconnectionobject.c.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TimeoutMultiplier(pub u8);

impl TimeoutMultiplier {
    /// The watchdog time of an interval, in us; codes above 7 count as 7.
    pub const fn watchdog_us(self, rpi_us: u32) -> u64 {
        let code = if self.0 > 7 { 7 } else { self.0 };
        (rpi_us as u64) * (4 << code)
    }
}

impl ConnectionParameters {
    /// Point to point, low priority, variable size. pycomm3 and libplctag: 0x4200 + size.
    pub const fn explicit(size: u16) -> Self {
        Self { size, flags: 0x4200 }
    }

    /// 0 null, 1 multicast, 2 point to point.
    pub const fn kind(self) -> u8 {
        ((self.flags >> 13) & 0b11) as u8
    }

    /// Bit 15 of the 16-bit form: several originators may own the connection. Never so for explicit messages.
    pub const fn is_redundant_owner(self) -> bool {
        self.flags & 0x8000 != 0
    }

    fn read(large: bool, reader: &mut Reader<'_>) -> Result<Self, DecodeError> {
        if large {
            let [s0, s1, f0, f1] = reader.array()?;
            return Ok(Self { size: u16::from_le_bytes([s0, s1]), flags: u16::from_le_bytes([f0, f1]) });
        }
        let bits = reader.u16()?;
        Ok(Self { size: bits & MAX_CLASSIC_SIZE, flags: bits & !MAX_CLASSIC_SIZE })
    }

    fn encode(self, large: bool, out: &mut Vec<u8>) {
        if large {
            out.extend_from_slice(&self.size.to_le_bytes());
            out.extend_from_slice(&self.flags.to_le_bytes());
        } else {
            out.extend_from_slice(&(self.flags | self.size).to_le_bytes());
        }
    }
}

impl ForwardOpen {
    /// Server direction, application object trigger, class 3.
    pub const CLASS_3: u8 = 0xA3;

    /// The request to the Connection Manager. Refuses a size that the service cannot say, and a path that is too long.
    pub fn request(&self, large: bool) -> Result<MessageRouterRequest, TooLong> {
        let size = self.o_t.size.max(self.t_o.size);
        if !large && size > MAX_CLASSIC_SIZE {
            let (length, max) = (size.into(), MAX_CLASSIC_SIZE.into());
            return Err(TooLong { what: "connection size", length, max });
        }
        let path = self.path.bytes();
        let mut data = self.timeout.bytes().to_vec();
        data.extend_from_slice(&self.o_t_id.0.to_le_bytes());
        data.extend_from_slice(&self.t_o_id.0.to_le_bytes());
        self.triad.encode(&mut data);
        data.extend_from_slice(&[self.multiplier.0, 0, 0, 0]);
        data.extend_from_slice(&self.o_t_rpi_us.to_le_bytes());
        self.o_t.encode(large, &mut data);
        data.extend_from_slice(&self.t_o_rpi_us.to_le_bytes());
        self.t_o.encode(large, &mut data);
        data.extend_from_slice(&[self.transport, connection_manager::words(&path)?]);
        data.extend_from_slice(&path);
        let service = if large { ServiceCode::LargeForwardOpen } else { ServiceCode::ForwardOpen };
        connection_manager::request(service, data)
    }

    /// Decodes the data of either service.
    pub fn decode(large: bool, data: &[u8]) -> Result<Self, DecodeError> {
        let mut reader = Reader::new(data);
        let (open, words) = Self::read_head(large, &mut reader)?;
        let path = connection_manager::read_path(words.into(), &mut reader)?;
        reader.finish()?;
        Ok(Self { path, ..open })
    }

    /// Reads everything before the path, and of how many words the path is: a router looks at a path one hop after
    /// the other. The path of the value is empty.
    pub fn read_head(large: bool, reader: &mut Reader<'_>) -> Result<(Self, u8), DecodeError> {
        let timeout = RequestTimeout::read(reader)?;
        let (o_t_id, t_o_id) = (ConnectionId(reader.u32()?), ConnectionId(reader.u32()?));
        let triad = ConnectionTriad::read(reader)?;
        let [multiplier, ..] = reader.array::<4>()?;
        let (o_t_rpi_us, o_t) = (reader.u32()?, ConnectionParameters::read(large, reader)?);
        let (t_o_rpi_us, t_o) = (reader.u32()?, ConnectionParameters::read(large, reader)?);
        let (transport, words) = (reader.u8()?, reader.u8()?);
        let open = Self {
            timeout,
            o_t_id,
            t_o_id,
            triad,
            multiplier: TimeoutMultiplier(multiplier),
            o_t_rpi_us,
            o_t,
            t_o_rpi_us,
            t_o,
            transport,
            path: Epath::default(),
        };
        Ok((open, words))
    }
}

/// The target's answer to either service: `O->T id | T->O id | triad | O->T API | T->O API | USINT words | 00 | words`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ForwardOpenReply {
    /// What requests carry.
    pub o_t_id: ConnectionId,
    /// What replies carry.
    pub t_o_id: ConnectionId,
    /// Name of the connection.
    pub triad: ConnectionTriad,
    /// Actual packet interval, us.
    pub o_t_api_us: u32,
    /// Actual packet interval, us.
    pub t_o_api_us: u32,
}

impl ForwardOpenReply {
    /// Decodes the data of the reply; the application's own words are not looked at.
    pub fn decode(data: &[u8]) -> Result<Self, DecodeError> {
        let mut reader = Reader::new(data);
        Ok(Self {
            o_t_id: ConnectionId(reader.u32()?),
            t_o_id: ConnectionId(reader.u32()?),
            triad: ConnectionTriad::read(&mut reader)?,
            o_t_api_us: reader.u32()?,
            t_o_api_us: reader.u32()?,
        })
    }

    /// Appends the data of the reply.
    pub fn encode(&self, out: &mut Vec<u8>) {
        out.extend_from_slice(&self.o_t_id.0.to_le_bytes());
        out.extend_from_slice(&self.t_o_id.0.to_le_bytes());
        self.triad.encode(out);
        out.extend_from_slice(&self.o_t_api_us.to_le_bytes());
        out.extend_from_slice(&self.t_o_api_us.to_le_bytes());
        out.extend_from_slice(&[0, 0]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hex_literal::hex;

    fn open(size: u16) -> ForwardOpen {
        ForwardOpen {
            timeout: RequestTimeout::read(&mut Reader::new(&[0x0A, 0x0E])).unwrap(),
            o_t_id: ConnectionId(0),
            t_o_id: ConnectionId(0x1122_3344),
            triad: ConnectionTriad { serial: 1, vendor: 0x1337, originator: 0xDEAD_BEEF },
            multiplier: TimeoutMultiplier(3),
            o_t_rpi_us: 2_000_000,
            o_t: ConnectionParameters::explicit(size),
            t_o_rpi_us: 2_000_000,
            t_o: ConnectionParameters::explicit(size),
            transport: ForwardOpen::CLASS_3,
            path: Epath::object(2, 1),
        }
    }

    #[test]
    fn the_classic_request_is_the_test_vector() {
        // built from the layout of OpENer and pycomm3: 504 bytes, 2 s
        let golden = hex!(
            "54 02 20 06 24 01 0A 0E 00000000 44332211 0100 3713 EFBEADDE 03 000000"
            "80841E00 F843 80841E00 F843 A3 02 20 02 24 01"
        );
        assert_eq!(open(504).request(false).unwrap().bytes(), golden);
        assert_eq!(ForwardOpen::decode(false, &golden[6..]), Ok(open(504)));
        assert_eq!(open(504).o_t.kind(), 2);
    }

    #[test]
    fn the_large_request_has_four_bytes_of_parameters() {
        let golden = hex!(
            "5B 02 20 06 24 01 0A 0E 00000000 44332211 0100 3713 EFBEADDE 03 000000"
            "80841E00 A20F0042 80841E00 A20F0042 A3 02 20 02 24 01"
        );
        assert_eq!(open(4002).request(true).unwrap().bytes(), golden);
        assert_eq!(ForwardOpen::decode(true, &golden[6..]), Ok(open(4002)));
        assert!(open(512).request(false).is_err(), "9 bits hold 511");
    }

    #[test]
    fn a_connection_may_be_silent_for_the_interval_times_the_multiplier() {
        for (code, factor) in [(0, 4), (1, 8), (7, 512), (255, 512)] {
            assert_eq!(TimeoutMultiplier(code).watchdog_us(1_000), factor * 1_000);
        }
    }

    #[test]
    fn every_prefix_is_an_error() {
        let request = open(504).request(false).unwrap();
        for end in 0..request.data().len() {
            assert!(ForwardOpen::decode(false, &request.data()[..end]).is_err(), "prefix of {end} bytes");
        }
    }
}
