//! The fields of `Data_to_Send`, as they are typed.

use std::net::Ipv4Addr;

use cipdeck_shared::{
    config::{SendReqForm, read_number, space_hex, write_hex},
    plan::words::{WordsFields, WordsObject, WordsPath},
};

use super::data_as::{DataAs, read_bytes};

/// A field of `Data_to_Send`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Part {
    /// 0 or 1.
    MessageType,
    /// Of the device, for a TSX ETC 101.
    Ip,
    /// 1..=127
    Service,
    /// 0..=65535
    Class,
    /// Empty: none.
    Instance,
    /// Empty: none.
    Attribute,
    /// Numbers, outer first. Empty: none.
    Members,
    /// The path as bytes.
    Path,
    /// What follows the path.
    Data,
}

impl Part {
    /// All of them.
    pub const ALL: [Self; 9] = [
        Self::MessageType,
        Self::Ip,
        Self::Service,
        Self::Class,
        Self::Instance,
        Self::Attribute,
        Self::Members,
        Self::Path,
        Self::Data,
    ];

    /// Its stable name.
    pub const fn word(self) -> &'static str {
        match self {
            Self::MessageType => "Message_Type",
            Self::Ip => "IP",
            Self::Service => "Service",
            Self::Class => "Class",
            Self::Instance => "Instance",
            Self::Attribute => "Attribute",
            Self::Members => "Members",
            Self::Path => "Path",
            Self::Data => "Data",
        }
    }

    /// Whether words of this form, with a path as numbers or as bytes, have it.
    pub const fn is_in(self, form: SendReqForm, raw_path: bool) -> bool {
        match self {
            Self::MessageType => form.head() > 0,
            Self::Ip => form.head() > 1,
            Self::Service | Self::Data => true,
            Self::Path => raw_path,
            Self::Class | Self::Instance | Self::Attribute | Self::Members => !raw_path,
        }
    }

    /// Whether it is about the path, in one of its two ways.
    pub(super) const fn is_of_path(self) -> bool {
        matches!(self, Self::Class | Self::Instance | Self::Attribute | Self::Members | Self::Path)
    }

    /// As it would be typed; empty where the words have no such part.
    pub(super) fn write(self, parts: &WordsFields, data_as: DataAs) -> String {
        let number = |value: Option<u32>| value.map(|value| value.to_string()).unwrap_or_default();
        match (self, &parts.path) {
            (Self::MessageType, _) => parts.message_type.to_string(),
            (Self::Ip, _) => Ipv4Addr::from(parts.ip).to_string(),
            (Self::Service, _) => parts.service.to_string(),
            (Self::Class, WordsPath::Object(object)) => object.class.to_string(),
            (Self::Instance, WordsPath::Object(object)) => number(object.instance),
            (Self::Attribute, WordsPath::Object(object)) => number(object.attribute),
            (Self::Members, WordsPath::Object(object)) => {
                object.members.iter().map(ToString::to_string).collect::<Vec<_>>().join(" ")
            }
            (Self::Path, path) => space_hex(&write_hex(&path.bytes())).to_ascii_uppercase(),
            (Self::Data, _) => {
                data_as.write(&parts.data).or_else(|| DataAs::Bytes.write(&parts.data)).unwrap_or_default()
            }
            _ => String::new(),
        }
    }
}

/// Texts → parts; each field that cannot be read, with the reason.
pub(super) fn read(
    form: SendReqForm,
    raw_path: bool,
    data_as: DataAs,
    text: impl Fn(Part) -> String,
) -> Result<WordsFields, Vec<(Part, String)>> {
    let mut wrong = Vec::new();
    let mut number = |part: Part, low: i64, high: i64| {
        if !part.is_in(form, raw_path) {
            return 0;
        }
        let value = read_number(&text(part)).map_err(|error| error.to_string()).and_then(|value| {
            u32::try_from(value)
                .ok()
                .filter(|_| (low..=high).contains(&value))
                .ok_or_else(|| format!("{value}: it has to be {low} to {high}"))
        });
        value.unwrap_or_else(|why| {
            wrong.push((part, why));
            0
        })
    };
    let service = number(Part::Service, 1, 0x7F);
    let class = number(Part::Class, 0, 0xFFFF);
    let message_type = number(Part::MessageType, 0, 0xFFFF);
    let mut optional = |part: Part, high: i64| {
        let is_there = part.is_in(form, raw_path) && !text(part).trim().is_empty();
        is_there.then(|| number(part, 0, high))
    };
    let instance = optional(Part::Instance, 0xFFFF_FFFF);
    let attribute = optional(Part::Attribute, 0xFFFF);
    let members =
        if Part::Members.is_in(form, raw_path) { read_members(&text(Part::Members)) } else { Ok(Vec::new()) };
    let path = if raw_path { read_path(&text(Part::Path)) } else { Ok(Vec::new()) };
    let ip = if Part::Ip.is_in(form, raw_path) { read_ip(&text(Part::Ip)) } else { Ok([0; 4]) };
    let data = data_as.read(&text(Part::Data));
    let mut take = |part: Part, why: Option<&String>| wrong.extend(why.map(|why| (part, why.clone())));
    take(Part::Members, members.as_ref().err());
    take(Part::Path, path.as_ref().err());
    take(Part::Ip, ip.as_ref().err());
    take(Part::Data, data.as_ref().err());
    match (members, path, ip, data) {
        (Ok(members), Ok(path), Ok(ip), Ok(data)) if wrong.is_empty() => Ok(WordsFields {
            message_type: u16::try_from(message_type).unwrap_or_default(),
            ip,
            service: u8::try_from(service).unwrap_or_default(),
            path: if raw_path {
                WordsPath::Other(path)
            } else {
                WordsPath::Object(WordsObject { class, instance, attribute, members })
            },
            data,
            behind: Vec::new(),
        }),
        _ => Err(wrong),
    }
}

fn read_members(text: &str) -> Result<Vec<u32>, String> {
    text.split([' ', ',', ';'])
        .filter(|piece| !piece.is_empty())
        .map(|piece| {
            let value = read_number(piece).map_err(|error| format!("“{piece}”: {error}"))?;
            u16::try_from(value).map(u32::from).map_err(|_| format!("“{piece}”: it has to be 0 to 65535"))
        })
        .collect()
}

fn read_path(text: &str) -> Result<Vec<u8>, String> {
    let bytes = read_bytes(text)?;
    match bytes.len() {
        odd if !odd.is_multiple_of(2) => Err("a path has whole words: an even number of bytes".to_owned()),
        511.. => Err("a path has at most 255 words".to_owned()),
        _ => Ok(bytes),
    }
}

/// Four numbers, or what is wrong with them.
pub fn read_ip(text: &str) -> Result<[u8; 4], String> {
    let text = text.trim();
    if text.is_empty() {
        return Err("an address is missing, such as 192.168.1.102".to_owned());
    }
    if let Some((address, port)) = text.rsplit_once(':') {
        return Err(format!("write the address alone, {address}, without the port {port}"));
    }
    let pieces: Vec<_> = text.split('.').collect();
    let bytes: Result<Vec<u8>, String> = pieces
        .iter()
        .map(|piece| {
            let digits = !piece.is_empty() && piece.bytes().all(|byte| byte.is_ascii_digit());
            match piece.parse::<u8>() {
                Ok(byte) if digits => Ok(byte),
                _ if digits => Err(format!("“{piece}” is over 255")),
                _ if piece.contains(',') => Err("dots separate the numbers, as in 192.168.1.102".to_owned()),
                _ => Err(format!("“{piece}” is no number from 0 to 255, as in 192.168.1.102")),
            }
        })
        .collect();
    <[u8; 4]>::try_from(bytes?).map_err(|bytes| {
        format!("an address has four numbers, as in 192.168.1.102; this has {}", bytes.len())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_address_is_four_numbers() {
        assert_eq!(read_ip(" 192.168.1.102 "), Ok([192, 168, 1, 102]));
        for (text, says) in [
            ("192.168.1.256", "“256” is over 255"),
            ("192.168.1", "this has 3"),
            ("192.168.1.", "“” is no number"),
            ("192.168.1.x", "“x” is no number"),
            ("192.168.1.+2", "“+2” is no number"),
            ("192,168,1,102", "dots separate"),
            ("192.168.1.102:44820", "write the address alone, 192.168.1.102, without the port 44820"),
            (" ", "an address is missing"),
        ] {
            assert!(read_ip(text).unwrap_err().contains(says), "{text}: {:?}", read_ip(text));
        }
    }

    #[test]
    fn every_field_that_cannot_be_read_is_named() {
        let text = |part: Part| match part {
            Part::Service => "0x0E".to_owned(),
            Part::Class => "3F".to_owned(),
            Part::Members => "1 x".to_owned(),
            Part::Data => "0".to_owned(),
            _ => String::new(),
        };
        let wrong = read(SendReqForm::DataExch, false, DataAs::Bytes, text).unwrap_err();
        let parts: Vec<_> = wrong.iter().map(|(part, _)| *part).collect();
        assert_eq!(parts, [Part::Class, Part::Members, Part::Data]);
    }
}
