//! Addresses of Schneider's communication functions: `ADDR('{network.station}rack.module.channel.ip')` of SEND_REQ on a
//! TSX ETC 100, the same without IP on a TSX ETC 101, and `ADDMX('rack.slot.channel{ip}UNC.CIP')` of DATA_EXCH.
//!
//! Sources: Control Expert help D-NA-0014148 (TSX ETC 100), D-SE-0006431 (TSX ETC 101), D-SE-0006557 (BMX NOC 0401). The six
//! words that ADDR makes of the text are not documented for an IP address, so they are not made here.

mod error;
mod scan;

use alloc::string::String;
use alloc::vec::Vec;
use core::fmt;
use core::ops::Range;
use core::str::FromStr;

pub use self::error::{AddressError, AddressErrorKind, Needed};
use self::scan::Scan;
use super::target_path::{Endpoint, Host, Target};

/// The address that stands for the built-in simulated device, as the path `0,0` does.
const BUILT_IN: Host = Host::Ip([0; 4]);

/// A readable address.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PlcAddress {
    /// The function around it, if there is one.
    pub function: Option<AddressFunction>,
    /// The station that the modules below are in; this one, if there is none.
    pub xway: Option<Xway>,
    /// The rack of the communication module.
    pub rack: u8,
    /// The module's position in the rack; Control Expert also says slot.
    pub module: u8,
    /// 0; 3 is known from modules with HART.
    pub channel: u8,
    /// The device, if the address names it.
    pub device: Option<AddressDevice>,
}

/// The function that makes an address of a text. What it is does not change what it says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AddressFunction {
    /// Premium, Atrium.
    Addr,
    /// M340.
    Addm,
    /// M580.
    Addmx,
}

/// A station behind bridges.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Xway {
    /// The network's number.
    pub network: u8,
    /// The station's number.
    pub station: u8,
}

/// The device, in one of two spellings.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum AddressDevice {
    /// `.192.168.1.102` behind the channel.
    Dotted(Endpoint),
    /// `{192.168.1.102}UNC.CIP` behind the channel.
    Braced(Endpoint, AddressMode),
}

/// How a message of DATA_EXCH goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AddressMode {
    /// `UNC.CIP`: unconnected.
    Unconnected,
    /// `CON.CIP`: over a class 3 connection.
    Connected,
}

/// What a part of an address means.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AddressPart {
    /// Its bytes in the text.
    pub range: Range<usize>,
    /// `function`, `network`, `station`, `rack`, `module`, `channel`, `ip`, `port` or `mode`.
    pub name: &'static str,
    /// English.
    pub text: String,
}

impl PlcAddress {
    /// Reads an address and says what each part of it means, in the order of the text.
    pub fn read(text: &str) -> Result<(Self, Vec<AddressPart>), AddressError> {
        Scan::new(text).address()
    }

    /// Address and TCP port of the device, if the address names it.
    pub const fn endpoint(&self) -> Option<&Endpoint> {
        match &self.device {
            Some(AddressDevice::Dotted(endpoint) | AddressDevice::Braced(endpoint, _)) => Some(endpoint),
            None => None,
        }
    }

    /// Where messages go, if the address names a device: `0.0.0.0` is the built-in simulated one.
    pub fn target(&self) -> Option<Target> {
        self.endpoint().cloned().map(device_target)
    }
}

/// Where an endpoint of one of these addresses is.
pub fn device_target(endpoint: Endpoint) -> Target {
    if endpoint.host == BUILT_IN { Target::BuiltIn } else { Target::Network(endpoint) }
}

impl AddressFunction {
    /// As it is written.
    pub const fn word(self) -> &'static str {
        match self {
            Self::Addr => "ADDR",
            Self::Addm => "ADDM",
            Self::Addmx => "ADDMX",
        }
    }
}

impl AddressMode {
    /// As it is written.
    pub const fn word(self) -> &'static str {
        match self {
            Self::Unconnected => "UNC.CIP",
            Self::Connected => "CON.CIP",
        }
    }
}

impl FromStr for PlcAddress {
    type Err = AddressError;

    fn from_str(text: &str) -> Result<Self, AddressError> {
        Self::read(text).map(|(address, _)| address)
    }
}

/// As Control Expert takes it, but for a TCP port.
impl fmt::Display for PlcAddress {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let usual = match &self.device {
            Some(AddressDevice::Braced(..)) => AddressFunction::Addmx,
            Some(AddressDevice::Dotted(_)) | None => AddressFunction::Addr,
        };
        write!(f, "{}('", self.function.unwrap_or(usual).word())?;
        if let Some(Xway { network, station }) = self.xway {
            write!(f, "{{{network}.{station}}}")?;
        }
        write!(f, "{}.{}.{}", self.rack, self.module, self.channel)?;
        match &self.device {
            Some(AddressDevice::Dotted(endpoint)) => write!(f, ".{}", Shown(endpoint))?,
            Some(AddressDevice::Braced(endpoint, mode)) => {
                write!(f, "{{{}}}{}", Shown(endpoint), mode.word())?;
            }
            None => {}
        }
        f.write_str("')")
    }
}

/// An endpoint with its TCP port only where it is an unusual one.
struct Shown<'a>(&'a Endpoint);

impl fmt::Display for Shown<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.0.has_unusual_port() { write!(f, "{}", self.0) } else { write!(f, "{}", self.0.host) }
    }
}

#[cfg(test)]
mod tests;
