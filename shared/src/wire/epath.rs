//! Padded EPATH: logical segments in their smallest form, port segments, and names of tags.
//!
//! Top three bits of a segment: 000 port, 001 logical; 0x91 is a name. Source: OpENer `cipepath.h`, Omron W506 8-4.
//!
//! A port segment: `port and flags | [address length] | [UINT extended port] | link address | [00]`. Bits 3..0 are the
//! port (15: an extended one follows), bit 4 says that the link address is longer than one byte. The length does not
//! count the pad. Source: Wireshark packet-cip.c, OpENer cipepath.c.

use alloc::vec::Vec;

use super::cursor::{DecodeError, DecodeErrorKind, Reader};
use super::simple_data::SimpleDataSegment;
use super::symbol::SymbolSegment;

/// A sequence of segments. Its size on the wire is counted in 16-bit words.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub struct Epath {
    segments: Vec<Segment>,
}

/// One segment.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Segment {
    /// Class, instance, attribute, member …
    Logical(LogicalSegment),
    /// One hop of a route.
    Port(PortSegment),
    /// A part of a tag's name.
    Symbol(SymbolSegment),
    /// A part of a variable.
    SimpleData(SimpleDataSegment),
}

/// A logical segment: what it addresses, and its number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct LogicalSegment {
    /// What the number is.
    pub kind: LogicalKind,
    /// The number; the encoding follows from its size.
    pub value: u32,
}

/// What a logical segment addresses: bits 4..2 of the segment byte.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum LogicalKind {
    /// 0x20
    Class,
    /// 0x24
    Instance,
    /// 0x28
    Member,
    /// 0x2C
    ConnectionPoint,
    /// 0x30
    Attribute,
}

impl LogicalKind {
    const ALL: [Self; 5] =
        [Self::Class, Self::Instance, Self::Member, Self::ConnectionPoint, Self::Attribute];

    /// The segment byte of the 8-bit form.
    pub const fn code(self) -> u8 {
        match self {
            Self::Class => 0x20,
            Self::Instance => 0x24,
            Self::Member => 0x28,
            Self::ConnectionPoint => 0x2C,
            Self::Attribute => 0x30,
        }
    }
}

/// A hop: a port of the device that the message has reached, and the address behind it, such as backplane port 1,
/// slot 0, or Ethernet port 2, `192.168.1.100`.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct PortSegment {
    port: u16,
    link: Vec<u8>,
}

impl PortSegment {
    /// A hop to a slot or node. Port 0 is reserved.
    pub fn new(port: u16, slot: u8) -> Option<Self> {
        Self::with_address(port, &[slot])
    }

    /// A hop to a link address of 1 to 255 bytes; IP addresses are ASCII text. Port 0 is reserved.
    pub fn with_address(port: u16, address: &[u8]) -> Option<Self> {
        let valid = port != 0 && (1..=255).contains(&address.len());
        valid.then(|| Self { port, link: address.to_vec() })
    }

    /// 1..=65535; 1 is the backplane. From 15 up it is encoded as an extended port.
    pub const fn port(&self) -> u16 {
        self.port
    }

    /// Slot, node, or the bytes of a longer address.
    pub fn link(&self) -> &[u8] {
        &self.link
    }

    /// The slot or node, for an address of one byte.
    pub fn slot(&self) -> Option<u8> {
        match *self.link.as_slice() {
            [slot] => Some(slot),
            _ => None,
        }
    }

    /// The address as text, if it is longer than one byte and ASCII.
    pub fn address(&self) -> Option<&str> {
        let text = core::str::from_utf8(&self.link).ok()?;
        (text.len() > 1 && text.bytes().all(|byte| byte.is_ascii_graphic())).then_some(text)
    }

    fn read(byte: u8, reader: &mut Reader<'_>) -> Result<Self, DecodeError> {
        let length = if byte & LONG_ADDRESS == 0 { 1 } else { usize::from(reader.u8()?) };
        let empty = reader.error(DecodeErrorKind::Unexpected { field: "link address length", found: 0 });
        if length == 0 {
            return Err(empty);
        }
        let port = match byte & PORT {
            EXTENDED_PORT => {
                let zero = reader.error(DecodeErrorKind::Unexpected { field: "extended port", found: 0 });
                Some(reader.u16()?).filter(|port| *port != 0).ok_or(zero)?
            }
            port => port.into(),
        };
        let link = reader.take(length)?.to_vec();
        if byte & LONG_ADDRESS != 0 && !length.is_multiple_of(2) {
            reader.u8()?;
        }
        Ok(Self { port, link })
    }

    fn encode(&self, out: &mut Vec<u8>) {
        let (port, extended) = match u8::try_from(self.port) {
            Ok(port @ 1..EXTENDED_PORT) => (port, None),
            _ => (EXTENDED_PORT, Some(self.port)),
        };
        let long = self.link.len() > 1;
        out.push(if long { port | LONG_ADDRESS } else { port });
        // `with_address` has refused what is over 255 bytes.
        out.extend(long.then(|| u8::try_from(self.link.len()).unwrap_or(u8::MAX)));
        out.extend(extended.into_iter().flat_map(u16::to_le_bytes));
        out.extend_from_slice(&self.link);
        if long && !self.link.len().is_multiple_of(2) {
            out.push(0);
        }
    }
}

/// Bits 3..0 of a port segment.
const PORT: u8 = 0x0F;

/// The port number follows as a UINT.
const EXTENDED_PORT: u8 = 15;

/// Bit 4: the link address is longer than one byte, its length follows.
const LONG_ADDRESS: u8 = 0x10;

impl Epath {
    /// Class and instance.
    pub fn object(class: u16, instance: u32) -> Self {
        Self::default().then(LogicalKind::Class, class.into()).then(LogicalKind::Instance, instance)
    }

    /// Adds a logical segment.
    #[must_use]
    pub fn then(self, kind: LogicalKind, value: u32) -> Self {
        self.with(Segment::Logical(LogicalSegment { kind, value }))
    }

    /// Adds a hop.
    #[must_use]
    pub fn hop(self, port: PortSegment) -> Self {
        self.with(Segment::Port(port))
    }

    /// Adds any segment.
    #[must_use]
    pub fn with(mut self, segment: Segment) -> Self {
        self.segments.push(segment);
        self
    }

    /// Adds everything of another path.
    #[must_use]
    pub fn join(mut self, other: &Self) -> Self {
        self.segments.extend_from_slice(&other.segments);
        self
    }

    /// Whether there is no segment.
    pub const fn is_empty(&self) -> bool {
        self.segments.is_empty()
    }

    /// The segments in order.
    pub fn segments(&self) -> &[Segment] {
        &self.segments
    }

    /// The number of the first logical segment of a kind.
    pub fn logical(&self, kind: LogicalKind) -> Option<u32> {
        self.segments.iter().find_map(|segment| match segment {
            Segment::Logical(logical) if logical.kind == kind => Some(logical.value),
            _ => None,
        })
    }

    /// Decodes all bytes. Positions in errors are counted from the first byte of the path.
    pub fn decode(bytes: &[u8]) -> Result<Self, DecodeError> {
        let mut reader = Reader::new(bytes);
        let mut segments = Vec::new();
        while !reader.is_empty() {
            segments.push(Segment::read(&mut reader)?);
        }
        Ok(Self { segments })
    }

    /// Appends the path: always an even number of bytes.
    pub fn encode(&self, out: &mut Vec<u8>) {
        for segment in &self.segments {
            segment.encode(out);
        }
    }

    /// The encoded path.
    pub fn bytes(&self) -> Vec<u8> {
        let mut out = Vec::new();
        self.encode(&mut out);
        out
    }
}

impl Segment {
    /// Reads one segment. Other widths than the smallest are understood.
    pub fn read(reader: &mut Reader<'_>) -> Result<Self, DecodeError> {
        let start = reader.clone();
        let unexpected =
            |found: u8| start.error(DecodeErrorKind::Unexpected { field: "segment", found: found.into() });
        let byte = reader.u8()?;
        if byte & !(PORT | LONG_ADDRESS) == 0 && byte & PORT != 0 {
            return PortSegment::read(byte, reader).map(Self::Port);
        }
        if byte == SymbolSegment::CODE {
            return SymbolSegment::read(reader).map(Self::Symbol);
        }
        if byte == SimpleDataSegment::CODE {
            return SimpleDataSegment::read(reader).map(Self::SimpleData);
        }
        let kind = LogicalKind::ALL.into_iter().find(|kind| kind.code() == byte & 0b1111_1100);
        let kind = kind.ok_or_else(|| unexpected(byte))?;
        let value = match byte & 0b11 {
            0 => reader.u8()?.into(),
            1 => {
                reader.u8()?;
                reader.u16()?.into()
            }
            2 => {
                reader.u8()?;
                reader.u32()?
            }
            _ => return Err(unexpected(byte)),
        };
        Ok(Self::Logical(LogicalSegment { kind, value }))
    }

    fn encode(&self, out: &mut Vec<u8>) {
        match *self {
            Self::Port(ref port) => port.encode(out),
            Self::Symbol(ref symbol) => symbol.encode(out),
            Self::SimpleData(part) => part.encode(out),
            Self::Logical(LogicalSegment { kind, value }) => {
                let [b0, b1, b2, b3] = value.to_le_bytes();
                match value {
                    0..=0xFF => out.extend_from_slice(&[kind.code(), b0]),
                    0x100..=0xFFFF => out.extend_from_slice(&[kind.code() | 1, 0, b0, b1]),
                    _ => out.extend_from_slice(&[kind.code() | 2, 0, b0, b1, b2, b3]),
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hex_literal::hex;

    #[test]
    fn object_path_uses_the_smallest_form() {
        // layout: OpENer cipepath.h; class 0x374 as in the Kinetix 300 example
        let path = Epath::object(0x374, 274).then(LogicalKind::Attribute, 1);
        assert_eq!(path.bytes(), hex!("21 00 74 03 25 00 12 01 30 01"));
        let path = Epath::object(0x0F, 39).then(LogicalKind::Attribute, 1);
        assert_eq!(path.bytes(), hex!("20 0F 24 27 30 01"));
        let members = Epath::default().then(LogicalKind::Member, 1).then(LogicalKind::Member, 300);
        assert_eq!(members.bytes(), hex!("28 01 29 00 2C 01"));
        let big = Epath::default().then(LogicalKind::Instance, 0x0001_0000);
        assert_eq!(big.bytes(), hex!("26 00 00 00 01 00"));
    }

    #[test]
    fn the_borders_of_each_width_are_right() {
        for (value, length) in [(0, 2), (0xFF, 2), (0x100, 4), (0xFFFF, 4), (0x1_0000, 6), (u32::MAX, 6)] {
            let path = Epath::default().then(LogicalKind::Instance, value);
            assert_eq!(path.bytes().len(), length, "{value:#x}");
            assert_eq!(Epath::decode(&path.bytes()), Ok(path));
        }
    }

    #[test]
    fn a_backplane_hop_is_port_and_slot() {
        let path = Epath::default().hop(PortSegment::new(1, 0).unwrap());
        assert_eq!(path.bytes(), hex!("01 00"));
        assert_eq!(Epath::decode(&hex!("01 00")), Ok(path));
        assert_eq!((PortSegment::new(0, 0), PortSegment::with_address(1, &[])), (None, None));
    }

    #[test]
    fn a_link_address_of_text_is_padded_and_its_length_does_not_count_the_pad() {
        // Wireshark packet-cip.c; libplctag issue 434 has the same form with port 0x12
        let odd = Epath::default().hop(PortSegment::with_address(2, b"192.168.1.100").unwrap());
        assert_eq!(odd.bytes(), hex!("12 0D 31 39 32 2E 31 36 38 2E 31 2E 31 30 30 00"));
        let even = Epath::default().hop(PortSegment::with_address(2, b"192.168.1.55").unwrap());
        assert_eq!(even.bytes(), hex!("12 0C 31 39 32 2E 31 36 38 2E 31 2E 35 35"));
        for path in [odd, even] {
            assert_eq!(Epath::decode(&path.bytes()), Ok(path));
        }
    }

    #[test]
    fn a_port_from_15_up_is_an_extended_one() {
        // OpENer cipepath.c: the extended port follows the length byte, if there is one
        let slot = Epath::default().hop(PortSegment::new(18, 3).unwrap());
        assert_eq!(slot.bytes(), hex!("0F 12 00 03"));
        let address = Epath::default().hop(PortSegment::with_address(0x0115, b"10.0.0.1").unwrap());
        assert_eq!(address.bytes(), hex!("1F 08 15 01 31 30 2E 30 2E 30 2E 31"));
        let fifteen = Epath::default().hop(PortSegment::new(15, 0).unwrap());
        assert_eq!(fifteen.bytes(), hex!("0F 0F 00 00"));
        for path in [slot, address, fifteen] {
            assert_eq!(Epath::decode(&path.bytes()), Ok(path));
        }
    }

    #[test]
    fn a_hop_that_cannot_be_is_named_with_its_byte() {
        for (bytes, at) in [(&hex!("12 00")[..], 2), (&hex!("0F 00 00 01"), 1), (&hex!("12 05 31"), 3)] {
            assert_eq!(Epath::decode(bytes).unwrap_err().at, at, "{bytes:02x?}");
        }
    }

    #[test]
    fn an_unknown_segment_is_named_with_its_byte() {
        let error = Epath::decode(&hex!("20 01 34 04")).unwrap_err();
        assert_eq!(
            (error.at, error.kind),
            (2, DecodeErrorKind::Unexpected { field: "segment", found: 0x34 })
        );
    }
}
