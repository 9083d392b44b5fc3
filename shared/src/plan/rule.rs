//! What can be wrong with a configuration, and how it is said.

use alloc::string::{String, ToString};
use alloc::vec::Vec;
use core::fmt;

use crate::config::{HexErrorKind, PathError};
use crate::tag::TypeError;

/// What is wrong. The page translates [`Rule::key`] with [`Rule::arguments`]; `Display` is the English text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Rule {
    /// A number outside its range.
    OutOfRange {
        /// What was given.
        value: i64,
        /// The smallest that is allowed.
        min: i64,
        /// The biggest that is allowed.
        max: i64,
    },
    /// A text that must not be empty.
    Missing,
    /// A text that is too long, in characters.
    TextTooLong {
        /// How long it may be.
        max: usize,
    },
    /// A kind of block that this version does not know.
    UnknownKind,
    /// A member that this version does not know: kept, not used.
    UnknownMember,
    /// The path cannot be used.
    Path(PathError),
    /// The path has a TCP port; a controller takes none.
    TcpPort {
        /// The port.
        port: u16,
    },
    /// The path has a name; a controller takes addresses only.
    HostName,
    /// A controller takes two hops.
    ThreeHops,
    /// The device takes no route to its own slot: the last hop is not sent.
    OwnSlot,
    /// The request data is not readable as hexadecimal.
    Hex {
        /// Character position, counted from 0.
        position: usize,
        /// What is wrong there.
        kind: HexErrorKind,
    },
    /// More request data than a message can carry.
    TooMuchData {
        /// Bytes in `ReqData`.
        length: usize,
        /// Bytes that are allowed.
        max: usize,
    },
    /// `ReqLength` is over the number of bytes in `ReqData`.
    LengthOverData {
        /// Bytes in `ReqData`.
        length: usize,
    },
    /// `ReqLength` is under the number of bytes in `ReqData`: the rest is not sent.
    LengthUnderData {
        /// Bytes that are sent.
        sent: usize,
        /// Bytes in `ReqData`.
        length: usize,
    },
    /// The whole message is longer than most devices take unconnected.
    LongMessage {
        /// Bytes of the message.
        length: usize,
        /// Bytes that are usual.
        max: usize,
    },
    /// A timeout was moved into its range.
    Clamped {
        /// What was given.
        value: i64,
        /// What is used, in ms.
        used: u32,
    },
    /// The manual types `TriggerType` as USINT.
    OverUsint,
    /// Reserved; the manual gives it no meaning.
    Reserved,
    /// `Cancel` is an input of the running block; it is stored FALSE.
    CancelIsAnInput,
    /// Fewer entries in `MemberId` than `MemberCnt`, or more than three.
    MemberIdCount {
        /// Entries that are there.
        found: usize,
    },
    /// `Resume` is for services that are known to read.
    ResumeNeedsRead,
    /// `ConnClose` acts on class 3 connections only.
    ConnCloseUnconnected,
    /// A layout that cannot be read.
    Layout(TypeError),
    /// A layout that does not fit the data.
    LayoutLength {
        /// Bytes of the layout.
        layout: usize,
        /// Bytes in `ReqData`.
        length: usize,
    },
    /// What is wrong with the words of a SEND_REQ or DATA_EXCH.
    Words(Said),
}

/// A finding about words. It is put into words where it is found, so that a page without such blocks has none of its text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Said {
    /// The stable name in JSON.
    pub name: &'static str,
    /// English.
    pub text: String,
    /// The communication report that the controller would give, as far as that is known.
    pub report: Option<u8>,
}

impl Rule {
    /// Every key that [`Self::key`] can return: the page has a text for each.
    pub const KEYS: [&'static str; 35] = [
        "out_of_range",
        "missing",
        "text_too_long",
        "unknown_kind",
        "unknown_member",
        "path_empty",
        "path_too_long",
        "path_half_hop",
        "path_too_many_hops",
        "path_serial_port",
        "path_bad_port",
        "path_bad_address",
        "path_bad_route_port",
        "path_bad_slot",
        "tcp_port",
        "host_name",
        "three_hops",
        "own_slot",
        "hex_not_hex",
        "hex_odd_digits",
        "too_much_data",
        "length_over_data",
        "length_under_data",
        "long_message",
        "clamped",
        "over_usint",
        "reserved",
        "cancel_is_an_input",
        "member_id_count",
        "resume_needs_read",
        "conn_close_unconnected",
        "layout",
        "layout_length",
        "words",
        "unreadable_number",
    ];

    /// The rule's stable name in JSON.
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Words(said) => said.name,
            rule => rule.key(),
        }
    }

    /// The key of the rule's text.
    pub const fn key(&self) -> &'static str {
        match self {
            Self::OutOfRange { .. } => "out_of_range",
            Self::Missing => "missing",
            Self::TextTooLong { .. } => "text_too_long",
            Self::UnknownKind => "unknown_kind",
            Self::UnknownMember => "unknown_member",
            Self::Path(error) => match error {
                PathError::Empty => "path_empty",
                PathError::TooLong => "path_too_long",
                PathError::HalfHop => "path_half_hop",
                PathError::TooManyHops => "path_too_many_hops",
                PathError::SerialPort => "path_serial_port",
                PathError::BadPort => "path_bad_port",
                PathError::BadAddress => "path_bad_address",
                PathError::BadRoutePort => "path_bad_route_port",
                PathError::BadSlot => "path_bad_slot",
            },
            Self::TcpPort { .. } => "tcp_port",
            Self::HostName => "host_name",
            Self::ThreeHops => "three_hops",
            Self::OwnSlot => "own_slot",
            Self::Hex { kind: HexErrorKind::NotHex(_), .. } => "hex_not_hex",
            Self::Hex { kind: HexErrorKind::OddDigits, .. } => "hex_odd_digits",
            Self::TooMuchData { .. } => "too_much_data",
            Self::LengthOverData { .. } => "length_over_data",
            Self::LengthUnderData { .. } => "length_under_data",
            Self::LongMessage { .. } => "long_message",
            Self::Clamped { .. } => "clamped",
            Self::OverUsint => "over_usint",
            Self::Reserved => "reserved",
            Self::CancelIsAnInput => "cancel_is_an_input",
            Self::MemberIdCount { .. } => "member_id_count",
            Self::ResumeNeedsRead => "resume_needs_read",
            Self::ConnCloseUnconnected => "conn_close_unconnected",
            Self::Layout(_) => "layout",
            Self::LayoutLength { .. } => "layout_length",
            Self::Words(_) => "words",
        }
    }

    /// The values that the rule's text names.
    pub fn arguments(&self) -> Vec<(&'static str, String)> {
        let (first, second, third) = match self {
            Self::OutOfRange { value, min, max } => (
                Some(("value", value.to_string())),
                Some(("min", min.to_string())),
                Some(("max", max.to_string())),
            ),
            Self::TextTooLong { max } => (Some(("max", max.to_string())), None, None),
            Self::TcpPort { port } => (Some(("port", port.to_string())), None, None),
            Self::Hex { position, kind: HexErrorKind::NotHex(found) } => {
                (Some(("position", (position + 1).to_string())), Some(("found", found.to_string())), None)
            }
            Self::Hex { position, .. } => (Some(("position", (position + 1).to_string())), None, None),
            Self::TooMuchData { length, max } | Self::LongMessage { length, max } => {
                (Some(("length", length.to_string())), Some(("max", max.to_string())), None)
            }
            Self::LengthOverData { length } => (Some(("length", length.to_string())), None, None),
            Self::LengthUnderData { sent, length } => {
                (Some(("sent", sent.to_string())), Some(("length", length.to_string())), None)
            }
            Self::Clamped { value, used } => {
                (Some(("value", value.to_string())), Some(("used", used.to_string())), None)
            }
            Self::MemberIdCount { found } => (Some(("found", found.to_string())), None, None),
            Self::Layout(error) => {
                (Some(("position", error.at.to_string())), Some(("why", error.why.clone())), None)
            }
            Self::LayoutLength { layout, length } => {
                (Some(("layout", layout.to_string())), Some(("length", length.to_string())), None)
            }
            Self::Words(said) => (Some(("why", said.text.clone())), None, None),
            _ => (None, None, None),
        };
        [first, second, third].into_iter().flatten().collect()
    }
}

impl fmt::Display for Rule {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::OutOfRange { value, min, max } => write!(f, "{value} is outside {min} to {max}"),
            Self::Missing => f.write_str("must not be empty"),
            Self::TextTooLong { max } => write!(f, "at most {max} characters"),
            Self::UnknownKind => f.write_str("this version knows MSG_CIPGENERIC, SEND_REQ and DATA_EXCH"),
            Self::UnknownMember => f.write_str("unknown member: kept, but not used"),
            Self::Path(error) => f.write_str(path_text(*error)),
            Self::TcpPort { port } => write!(f, "TCP port {port}: a controller always uses 44818"),
            Self::HostName => f.write_str("a controller takes an IP address here, not a name"),
            Self::ThreeHops => f.write_str("three hops: a controller takes two"),
            Self::OwnSlot => {
                f.write_str("a Micro800 takes no route to its own slot: the hop 1,0 is not sent")
            }
            Self::Hex { position, kind: HexErrorKind::NotHex(found) } => {
                write!(f, "'{found}' at character {} is not a hexadecimal digit", position + 1)
            }
            Self::Hex { position, kind: HexErrorKind::OddDigits } => {
                write!(f, "half a byte at character {}: each byte needs two hexadecimal digits", position + 1)
            }
            Self::TooMuchData { length, max } => write!(f, "{length} bytes; a message carries at most {max}"),
            Self::LengthOverData { length } => write!(f, "ReqData has only {length} bytes"),
            Self::LengthUnderData { sent, length } => {
                write!(f, "only the first {sent} of {length} bytes are sent")
            }
            Self::LongMessage { length, max } => {
                write!(f, "the message has {length} bytes; many devices take at most {max} unconnected")
            }
            Self::Clamped { value, used } => write!(f, "{value} ms is outside the range; {used} ms is used"),
            Self::OverUsint => {
                f.write_str("the manual types TriggerType as USINT (0 to 255) but allows 65535")
            }
            Self::Reserved => f.write_str("reserved: the manual gives it no meaning"),
            Self::CancelIsAnInput => {
                f.write_str("Cancel is an input of the running block; it is stored FALSE")
            }
            Self::MemberIdCount { found } => write!(f, "MemberId has {found} entries; it needs three"),
            Self::ResumeNeedsRead => {
                f.write_str("Resume is allowed for services that are known to read only")
            }
            Self::ConnCloseUnconnected => f.write_str("acts on class 3 connections only (CipConnMode 1)"),
            Self::Layout(error) => write!(f, "{error}; write REAL, or speed: REAL; run: BOOL"),
            Self::LayoutLength { layout, length } => {
                write!(f, "the layout has {layout} bytes, ReqData has {length}")
            }
            Self::Words(said) => f.write_str(&said.text),
        }
    }
}

const fn path_text(error: PathError) -> &'static str {
    match error {
        PathError::Empty => "the path is empty; write 4,192.168.1.100",
        PathError::TooLong => "the path has more than 80 characters",
        PathError::HalfHop => "each hop is a port and an address, such as 4,192.168.1.100",
        PathError::TooManyHops => {
            "at most two hops; a third has to leave the chassis, as in 4,192.168.1.100,1,3,2,192.168.1.20"
        }
        PathError::SerialPort => "a serial port: only the Ethernet port 4 can be used",
        PathError::BadPort => "not a port of the controller: Ethernet is port 4, as in 4,192.168.1.100",
        PathError::BadAddress => "not an IP address or host name, such as 192.168.1.100",
        PathError::BadRoutePort => "the port of a further hop is 1 to 65535; the backplane is 1",
        PathError::BadSlot => {
            "the address of a further hop is a slot, 0 to 255, or an IP address (not on backplane port 1)"
        }
    }
}
