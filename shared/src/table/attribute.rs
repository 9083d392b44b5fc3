//! Layouts of attributes that the specification fixes. What is not here is shown as a guess, never as a fact.

use alloc::format;
use alloc::string::{String, ToString};

use crate::wire::{CipType, ClassCode, DecodeError, Reader};

/// One value inside an attribute.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Field {
    /// In the words of the specification, lower case.
    pub name: &'static str,
    /// How its bytes are read.
    pub kind: FieldKind,
}

/// How the bytes of a field are read and shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FieldKind {
    /// An elementary type.
    Value(CipType),
    /// A UDINT that is an IPv4 address.
    Ipv4,
    /// Six bytes.
    MacAddress,
    /// UINT length and that many characters.
    String,
}

impl FieldKind {
    /// The CIP type.
    pub const fn type_name(self) -> &'static str {
        match self {
            Self::Value(kind) => kind.name(),
            Self::Ipv4 => "UDINT",
            Self::MacAddress => "USINT[6]",
            Self::String => "STRING",
        }
    }

    /// Reads one field and prints it.
    pub fn read(self, reader: &mut Reader<'_>) -> Result<String, DecodeError> {
        Ok(match self {
            Self::Value(kind) => kind.read(reader)?.to_string(),
            Self::Ipv4 => {
                let [a, b, c, d] = reader.u32()?.to_be_bytes();
                format!("{a}.{b}.{c}.{d}")
            }
            Self::MacAddress => {
                let octets: [u8; 6] = reader.array()?;
                octets.map(|octet| format!("{octet:02x}")).join(":")
            }
            Self::String => {
                let length = reader.u16()?;
                reader.take(length.into())?.iter().copied().map(char::from).collect()
            }
        })
    }
}

/// The fields of an attribute, or `None` where its type is not known. Attribute 0 is all of an instance, as
/// Get_Attributes_All answers it; instance 0 is the class itself.
///
/// Sources: OpENer `cipidentity.c`, `ciptcpipinterface.c`, `cipethernetlink.c`; Rockwell 280E-UM001B for 245/1/5.
pub fn attribute(class: u16, instance: u32, attribute: u16) -> Option<&'static [Field]> {
    match (ClassCode(class), instance, attribute) {
        (ClassCode::Identity | ClassCode::TcpIpInterface | ClassCode::EthernetLink, 0, number) => {
            one_of(CLASS, number)
        }
        (ClassCode::Identity, _, 0) => Some(IDENTITY),
        (ClassCode::Identity, _, number) => identity(number),
        (ClassCode::TcpIpInterface, _, number) => tcp_ip(number),
        (ClassCode::EthernetLink, _, number) => one_of(ETHERNET_LINK, number),
        _ => None,
    }
}

const fn value(name: &'static str, kind: CipType) -> Field {
    Field { name, kind: FieldKind::Value(kind) }
}

const CLASS: &[Field] = &[
    value("revision", CipType::Uint),
    value("highest instance", CipType::Uint),
    value("number of instances", CipType::Uint),
];

const IDENTITY: &[Field] = &[
    value("vendor id", CipType::Uint),
    value("device type", CipType::Uint),
    value("product code", CipType::Uint),
    value("major revision", CipType::Usint),
    value("minor revision", CipType::Usint),
    value("status", CipType::Word),
    value("serial number", CipType::Udint),
    value("product name", CipType::ShortString),
];

const ETHERNET_LINK: &[Field] = &[
    value("interface speed (Mbit/s)", CipType::Udint),
    value("interface flags", CipType::Dword),
    Field { name: "MAC address", kind: FieldKind::MacAddress },
];

const INTERFACE_CONFIGURATION: &[Field] = &[
    Field { name: "IP address", kind: FieldKind::Ipv4 },
    Field { name: "network mask", kind: FieldKind::Ipv4 },
    Field { name: "gateway", kind: FieldKind::Ipv4 },
    Field { name: "name server", kind: FieldKind::Ipv4 },
    Field { name: "second name server", kind: FieldKind::Ipv4 },
    Field { name: "domain name", kind: FieldKind::String },
];

const INTERFACE_STATE: &[Field] = &[
    value("status", CipType::Dword),
    value("configuration capability", CipType::Dword),
    value("configuration control", CipType::Dword),
];

const HOST_NAME: &[Field] = &[Field { name: "host name", kind: FieldKind::String }];

/// Attribute 4 is two fields, so the numbers after it are one behind.
fn identity(number: u16) -> Option<&'static [Field]> {
    match number {
        1..=3 => one_of(IDENTITY, number),
        4 => IDENTITY.get(3..5),
        5..=7 => one_of(IDENTITY, number + 1),
        _ => None,
    }
}

fn tcp_ip(number: u16) -> Option<&'static [Field]> {
    match number {
        1..=3 => one_of(INTERFACE_STATE, number),
        5 => Some(INTERFACE_CONFIGURATION),
        6 => Some(HOST_NAME),
        _ => None,
    }
}

/// The field of an attribute in a list that starts with attribute 1.
fn one_of(fields: &'static [Field], number: u16) -> Option<&'static [Field]> {
    let end = usize::from(number);
    fields.get(end.checked_sub(1)?..end)
}
