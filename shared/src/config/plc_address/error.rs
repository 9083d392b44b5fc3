//! Why a text is no address, where, and what to write instead.

use core::fmt;

/// Where a text stops to be an address.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AddressError {
    /// Character position, counted from 0.
    pub position: usize,
    /// What is wrong there.
    pub kind: AddressErrorKind,
}

/// What is wrong with an address.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AddressErrorKind {
    /// Nothing was typed.
    Empty,
    /// Over 100 characters.
    TooLong,
    /// Another function than ADDR, ADDM and ADDMX.
    UnknownFunction,
    /// Something else is needed here: what.
    Expected(Needed),
    /// A number over 255.
    TooBig,
    /// A TCP port that is not 1 to 65535.
    BadPort,
    /// The device in braces is not followed by UNC.CIP or CON.CIP.
    MissingMode,
    /// Another protocol, such as TCP.MBS, or SYS.
    UnknownMode,
    /// UNC.CIP or CON.CIP, but no device in braces before it.
    ModeWithoutDevice,
    /// More text behind the end.
    Surplus,
}

/// What is needed where something else was found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Needed {
    /// A number from 0 to 255: of what.
    Number(&'static str),
    /// `.` before the number: of what.
    Dot(&'static str),
    /// `(` behind the function.
    Open,
    /// `)` at the end.
    Close,
    /// The quote at the end.
    Quote,
    /// `}` behind the station or the device.
    Brace,
}

impl fmt::Display for AddressError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.kind {
            AddressErrorKind::Empty => {
                f.write_str("the address is empty; write ADDR('0.2.0.192.168.1.102') or ADDMX('0.2.0{192.168.1.102}UNC.CIP')")
            }
            AddressErrorKind::TooLong => f.write_str("the address has more than 100 characters"),
            kind => write!(f, "character {}: {}", self.position + 1, Why(kind)),
        }
    }
}

struct Why(AddressErrorKind);

impl fmt::Display for Why {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self.0 {
            AddressErrorKind::Empty | AddressErrorKind::TooLong => "no address",
            AddressErrorKind::UnknownFunction => "not ADDR, ADDM or ADDMX",
            AddressErrorKind::Expected(needed) => return write!(f, "{needed}"),
            AddressErrorKind::TooBig => "the number is over 255",
            AddressErrorKind::BadPort => "a TCP port is 1 to 65535",
            AddressErrorKind::MissingMode => {
                "UNC.CIP or CON.CIP is missing, as in 0.2.0{192.168.1.102}UNC.CIP"
            }
            AddressErrorKind::UnknownMode => {
                "only UNC.CIP (unconnected) and CON.CIP (class 3 connection) are EtherNet/IP messages"
            }
            AddressErrorKind::ModeWithoutDevice => {
                "the device's IP address comes before it, in braces, as in 0.2.0{192.168.1.102}UNC.CIP"
            }
            AddressErrorKind::Surplus => "nothing more is expected here",
        })
    }
}

impl fmt::Display for Needed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(what) => write!(f, "a number is missing: {what}, 0 to 255"),
            Self::Dot(what) => write!(f, "a dot and {what} are missing, as in 0.2.0.192.168.1.102"),
            Self::Open => f.write_str("( is missing, as in ADDR('0.2.0.192.168.1.102')"),
            Self::Close => f.write_str(") is missing"),
            Self::Quote => f.write_str("the quote that was opened is not closed"),
            Self::Brace => f.write_str("} is missing"),
        }
    }
}
