//! Padded EPATH: logical segments in their smallest form, and one-byte port segments.
//!
//! Top three bits of a segment: 000 port, 001 logical. Source: OpENer `cipepath.h`, Omron W506 8-4.

use alloc::vec::Vec;

use super::cursor::{DecodeError, DecodeErrorKind, Reader};

/// A sequence of segments. Its size on the wire is counted in 16-bit words.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub struct Epath {
    segments: Vec<Segment>,
}

/// One segment.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Segment {
    /// Class, instance, attribute, member …
    Logical(LogicalSegment),
    /// One hop of a route.
    Port(PortSegment),
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

/// A hop with a link address of one byte, such as backplane port 1, slot 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct PortSegment {
    port: u8,
    link: u8,
}

impl PortSegment {
    /// Port 1..=14: 0 is reserved, 15 announces an extended port number.
    pub const fn new(port: u8, link: u8) -> Option<Self> {
        match port {
            1..=14 => Some(Self { port, link }),
            _ => None,
        }
    }

    /// 1..=14; 1 is the backplane.
    pub const fn port(self) -> u8 {
        self.port
    }

    /// Slot or node.
    pub const fn link(self) -> u8 {
        self.link
    }
}

impl Epath {
    /// Class and instance.
    pub fn object(class: u16, instance: u32) -> Self {
        Self::default().then(LogicalKind::Class, class.into()).then(LogicalKind::Instance, instance)
    }

    /// Adds a logical segment.
    #[must_use]
    pub fn then(mut self, kind: LogicalKind, value: u32) -> Self {
        self.segments.push(Segment::Logical(LogicalSegment { kind, value }));
        self
    }

    /// Adds a hop.
    #[must_use]
    pub fn hop(mut self, port: PortSegment) -> Self {
        self.segments.push(Segment::Port(port));
        self
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
        if let 0x01..=0x0E = byte {
            return Ok(Self::Port(PortSegment { port: byte, link: reader.u8()? }));
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

    fn encode(self, out: &mut Vec<u8>) {
        match self {
            Self::Port(PortSegment { port, link }) => out.extend_from_slice(&[port, link]),
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
        assert_eq!((PortSegment::new(0, 0), PortSegment::new(15, 0)), (None, None));
    }

    #[test]
    fn an_unknown_segment_is_named_with_its_byte() {
        let error = Epath::decode(&hex!("20 01 91 04")).unwrap_err();
        assert_eq!(
            (error.at, error.kind),
            (2, DecodeErrorKind::Unexpected { field: "segment", found: 0x91 })
        );
    }
}
