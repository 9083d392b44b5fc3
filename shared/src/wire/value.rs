//! CIP values: the elementary types that Identity, TCP/IP, Ethernet Link and a drive parameter need.

use alloc::string::String;
use alloc::vec::Vec;
use core::fmt;

use super::cursor::{DecodeError, Reader, TooLong};

/// An elementary type.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum CipType {
    /// Unsigned 8 bit.
    Usint,
    /// Unsigned 16 bit.
    Uint,
    /// Unsigned 32 bit.
    Udint,
    /// Signed 16 bit.
    Int,
    /// Signed 32 bit.
    Dint,
    /// IEEE 754 single precision.
    Real,
    /// 16 bits, shown as hexadecimal.
    Word,
    /// 32 bits, shown as hexadecimal.
    Dword,
    /// USINT length and that many characters.
    ShortString,
}

impl CipType {
    /// The name as the specification spells it.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Usint => "USINT",
            Self::Uint => "UINT",
            Self::Udint => "UDINT",
            Self::Int => "INT",
            Self::Dint => "DINT",
            Self::Real => "REAL",
            Self::Word => "WORD",
            Self::Dword => "DWORD",
            Self::ShortString => "SHORT_STRING",
        }
    }

    /// Reads one value of this type.
    pub fn read(self, reader: &mut Reader<'_>) -> Result<CipValue, DecodeError> {
        Ok(match self {
            Self::Usint => CipValue::Usint(reader.u8()?),
            Self::Uint => CipValue::Uint(reader.u16()?),
            Self::Udint => CipValue::Udint(reader.u32()?),
            Self::Int => CipValue::Int(i16::from_le_bytes(reader.array()?)),
            Self::Dint => CipValue::Dint(i32::from_le_bytes(reader.array()?)),
            Self::Real => CipValue::Real(f32::from_le_bytes(reader.array()?)),
            Self::Word => CipValue::Word(reader.u16()?),
            Self::Dword => CipValue::Dword(reader.u32()?),
            Self::ShortString => CipValue::ShortString(ShortString::read(reader)?),
        })
    }
}

/// A value of an elementary type. It prints as an engineer would write it.
#[derive(Clone, Debug, PartialEq)]
pub enum CipValue {
    /// USINT
    Usint(u8),
    /// UINT
    Uint(u16),
    /// UDINT
    Udint(u32),
    /// INT
    Int(i16),
    /// DINT
    Dint(i32),
    /// REAL
    Real(f32),
    /// WORD
    Word(u16),
    /// DWORD
    Dword(u32),
    /// SHORT_STRING
    ShortString(ShortString),
}

impl CipValue {
    /// Appends the value.
    pub fn encode(&self, out: &mut Vec<u8>) {
        match self {
            Self::Usint(value) => out.push(*value),
            Self::Uint(value) | Self::Word(value) => out.extend_from_slice(&value.to_le_bytes()),
            Self::Udint(value) | Self::Dword(value) => out.extend_from_slice(&value.to_le_bytes()),
            Self::Int(value) => out.extend_from_slice(&value.to_le_bytes()),
            Self::Dint(value) => out.extend_from_slice(&value.to_le_bytes()),
            Self::Real(value) => out.extend_from_slice(&value.to_le_bytes()),
            Self::ShortString(value) => value.encode(out),
        }
    }
}

impl fmt::Display for CipValue {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Usint(value) => write!(f, "{value}"),
            Self::Uint(value) => write!(f, "{value}"),
            Self::Udint(value) => write!(f, "{value}"),
            Self::Int(value) => write!(f, "{value}"),
            Self::Dint(value) => write!(f, "{value}"),
            Self::Real(value) => {
                let mut buffer = zmij::Buffer::new();
                let text = buffer.format(*value);
                f.write_str(text.strip_suffix(".0").unwrap_or(text))
            }
            Self::Word(value) => write!(f, "{value:#06x}"),
            Self::Dword(value) => write!(f, "{value:#010x}"),
            Self::ShortString(value) => write!(f, "{value}"),
        }
    }
}

/// USINT length and up to 255 characters. Bytes outside ASCII survive; they print as Latin-1.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub struct ShortString {
    length: u8,
    bytes: Vec<u8>,
}

impl ShortString {
    /// Refuses more than 255 bytes.
    pub fn new(bytes: &[u8]) -> Result<Self, TooLong> {
        let too_long = TooLong { what: "SHORT_STRING", length: bytes.len(), max: 255 };
        let length = u8::try_from(bytes.len()).map_err(|_| too_long)?;
        Ok(Self { length, bytes: bytes.to_vec() })
    }

    /// Reads length and characters.
    pub fn read(reader: &mut Reader<'_>) -> Result<Self, DecodeError> {
        let length = reader.u8()?;
        Ok(Self { length, bytes: reader.take(length.into())?.to_vec() })
    }

    /// Appends length and characters.
    pub fn encode(&self, out: &mut Vec<u8>) {
        out.push(self.length);
        out.extend_from_slice(&self.bytes);
    }

    /// The characters as they are on the wire.
    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// The characters as text.
    pub fn text(&self) -> String {
        self.bytes.iter().copied().map(char::from).collect()
    }
}

impl fmt::Display for ShortString {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.text())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use alloc::string::ToString;

    #[test]
    fn values_read_and_write_the_same_bytes() {
        let rows = [
            (CipType::Usint, &[0x7B][..], "123"),
            (CipType::Uint, &[0x01, 0x80], "32769"),
            (CipType::Int, &[0x01, 0x80], "-32767"),
            (CipType::Udint, &[0xFF, 0xFF, 0xFF, 0xFF], "4294967295"),
            (CipType::Dint, &[0xFE, 0xFF, 0xFF, 0xFF], "-2"),
            (CipType::Real, &[0x00, 0x00, 0x48, 0x42], "50"),
            (CipType::Word, &[0x34, 0x12], "0x1234"),
            (CipType::Dword, &[0x78, 0x56, 0x34, 0x12], "0x12345678"),
            (CipType::ShortString, &[4, b'C', b'H', b'P', b'1'], "CHP1"),
        ];
        for (kind, bytes, text) in rows {
            let mut reader = Reader::new(bytes);
            let value = kind.read(&mut reader).unwrap();
            assert!(reader.finish().is_ok(), "{}", kind.name());
            assert_eq!(value.to_string(), text, "{}", kind.name());
            let mut out = Vec::new();
            value.encode(&mut out);
            assert_eq!(out, bytes, "{}", kind.name());
        }
    }
}
