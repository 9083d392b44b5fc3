//! What can be wrong with a SEND_REQ or DATA_EXCH, how it is said, and which report a controller would give.

use alloc::string::ToString;
use core::fmt;

use crate::config::{AddressError, SendReqForm, WordsError};
use crate::plan::rule::{Rule, Said};

use super::fields::FieldsError;

/// A rule of these blocks alone.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum WordsRule {
    /// The address cannot be read.
    Address(AddressError),
    /// The address does not have the shape that the form needs.
    AddressShape(SendReqForm),
    /// On a TSX ETC 101 the IP address is in the words.
    AddressWithIp,
    /// ADDR, ADDM, ADDMX: of another family.
    AddressFunction {
        /// What is usual.
        usual: &'static str,
    },
    /// The address goes over bridges; we go straight to the device.
    Xway,
    /// A channel other than 0.
    Channel(u8),
    /// A member that this form does not have.
    NotOfForm(SendReqForm),
    /// `Request_Code` 16#50.
    ModbusTcp,
    /// `Request_Code` is not 14.
    RequestCode(i64),
    /// `Type` is not 1.
    ExchangeType(i64),
    /// `Data_to_Send` cannot be read.
    Words(WordsError),
    /// Neither 0 nor 1 in word 0.
    MessageType(u16),
    /// The words do not hold a request with a path.
    Request(FieldsError),
    /// A path of no words.
    NoPath,
    /// Service 0, or one with the bit of replies.
    Service(u8),
    /// A path that cannot be understood.
    Path {
        /// The byte in `Data_to_Send`, counted from 0.
        byte: usize,
        /// What is there.
        found: Option<u8>,
    },
    /// Not four entries in `Management_Param`.
    ManagementCount(usize),
    /// The system's words.
    SystemWord,
    /// `Management_Param[2]` is 0.
    WaitsForEver,
    /// `Management_Param[3]` is 0.
    LengthZero,
    /// `Management_Param[3]` counts more bytes than there are.
    LengthOver {
        /// What it says.
        length: usize,
        /// Bytes that are there.
        bytes: usize,
    },
    /// `Management_Param[3]` leaves bytes behind.
    LengthUnder {
        /// Bytes that are sent.
        sent: usize,
        /// Bytes that are there.
        bytes: usize,
    },
    /// A layout that does not fit the data.
    LayoutLength {
        /// Bytes of the layout.
        layout: usize,
        /// Bytes of the request's data.
        length: usize,
    },
}

impl WordsRule {
    /// The stable name in JSON.
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Address(_) => "address_unreadable",
            Self::AddressShape(_) => "address_shape",
            Self::AddressWithIp => "address_with_ip",
            Self::AddressFunction { .. } => "address_function",
            Self::Xway => "address_xway",
            Self::Channel(_) => "address_channel",
            Self::NotOfForm(_) => "not_of_form",
            Self::ModbusTcp => "modbus_tcp",
            Self::RequestCode(_) => "request_code",
            Self::ExchangeType(_) => "exchange_type",
            Self::Words(_) => "words_unreadable",
            Self::MessageType(_) => "message_type",
            Self::Request(_) => "words_too_short",
            Self::NoPath => "path_size_zero",
            Self::Service(_) => "service",
            Self::Path { .. } => "path_unreadable",
            Self::ManagementCount(_) => "management_count",
            Self::SystemWord => "system_word",
            Self::WaitsForEver => "waits_for_ever",
            Self::LengthZero => "length_zero",
            Self::LengthOver { .. } => "length_over_words",
            Self::LengthUnder { .. } => "length_under_words",
            Self::LayoutLength { .. } => "layout_length",
        }
    }

    /// The communication report that the controller would give, as far as the help's words for the codes tell.
    /// D-NA-0014195: 03 address, 05 management parameters, 06 specific parameters, 0E length. Which check gives which is
    /// inferred. `None`: the block sends it, and the device refuses.
    pub const fn report(&self) -> Option<u8> {
        match self {
            Self::Address(_) | Self::AddressShape(_) | Self::AddressWithIp => Some(0x03),
            Self::ManagementCount(_) => Some(0x05),
            Self::ModbusTcp
            | Self::RequestCode(_)
            | Self::ExchangeType(_)
            | Self::Words(_)
            | Self::MessageType(_) => Some(0x06),
            Self::LengthZero | Self::LengthOver { .. } | Self::Request(_) => Some(0x0E),
            _ => None,
        }
    }
}

impl From<WordsRule> for Rule {
    fn from(rule: WordsRule) -> Self {
        Self::Words(Said { name: rule.name(), text: rule.to_string(), report: rule.report() })
    }
}

impl fmt::Display for WordsRule {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Address(error) => write!(f, "{error}"),
            Self::AddressShape(SendReqForm::Etc100) => f.write_str(
                "the device's IP address follows the channel: ADDR('0.2.0.192.168.1.102')",
            ),
            Self::AddressShape(SendReqForm::Etc101) => {
                f.write_str("SEND_REQ takes the module's address, without braces: ADDR('0.4.0')")
            }
            Self::AddressShape(SendReqForm::DataExch) => f.write_str(
                "the device's IP address is in braces, and how it is sent follows: ADDMX('0.2.0{192.168.1.102}UNC.CIP')",
            ),
            Self::AddressWithIp => f.write_str(
                "on a TSX ETC 101 the IP address is in words 1 and 2 of Data_to_Send; here write ADDR('0.4.0')",
            ),
            Self::AddressFunction { usual } => write!(f, "{usual} is usual here; what it says is the same"),
            Self::Xway => {
                f.write_str("the way {network.station} over bridges is not taken: cipdeck goes straight to the IP address")
            }
            Self::Channel(3) => f.write_str("channel 3 is known from modules with HART; otherwise it is 0"),
            Self::Channel(channel) => write!(f, "channel {channel}: usual is 0"),
            Self::NotOfForm(form) => write!(f, "a {form} does not have this: kept, but not used"),
            Self::ModbusTcp => {
                f.write_str("16#50 is Modbus TCP on a TSX ETC 101, which is not EtherNet/IP: not supported; a CIP request is 14 (16#000E)")
            }
            Self::RequestCode(code) => write!(f, "{code} is not the code of a CIP request: write 14 (16#000E)"),
            Self::ExchangeType(kind) => {
                write!(f, "{kind} is no request with a reply: write 1 (transmission, then reception)")
            }
            Self::Words(error) => write!(f, "{error}"),
            Self::MessageType(word) => write!(
                f,
                "word 0 is the message type: 0 unconnected, 1 over a class 3 connection, not {word} (16#{word:04X})"
            ),
            Self::Request(error) => write!(f, "{error}"),
            Self::NoPath => f.write_str("the path size, the high byte of the request's first word, is 0: no object is named"),
            Self::Service(0) => f.write_str("the service, the low byte of the request's first word, is 0"),
            Self::Service(service) => {
                write!(f, "service {service} (16#{service:02X}) is a reply's: requests have 1 to 127")
            }
            Self::Path { byte, found } => {
                let (word, half) = (byte / 2, if byte % 2 == 0 { "low" } else { "high" });
                match found {
                    Some(found) => write!(f, "16#{found:02X} at byte {byte} (word {word}, {half} byte) is no path segment that is understood"),
                    None => write!(f, "the path ends in the middle of a segment at byte {byte} (word {word}, {half} byte)"),
                }
            }
            Self::ManagementCount(found) => write!(f, "Management_Param has {found} entries; it has four words"),
            Self::SystemWord => f.write_str("this word is the system's: it is overwritten at the start"),
            Self::WaitsForEver => f.write_str(
                "timeout 0: the block WAITS FOR EVER for an answer that may never come, and cannot be started again; write 30 for 3 s",
            ),
            Self::LengthZero => f.write_str("0 bytes to send: write the length of Data_to_Send in bytes"),
            Self::LengthOver { length, bytes } => {
                write!(f, "{length} bytes are to be sent, Data_to_Send has {bytes} (it counts bytes, not words)")
            }
            Self::LengthUnder { sent, bytes } => {
                write!(f, "only the first {sent} of {bytes} bytes are sent: {} stay behind", bytes - sent)
            }
            Self::LayoutLength { layout, length } => {
                write!(f, "the layout has {layout} bytes, the request's data has {length}")
            }
        }
    }
}
