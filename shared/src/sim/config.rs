//! What a simulated device is like.

use alloc::vec::Vec;
use core::fmt;
use core::str::FromStr;

use crate::engine::time::Millis;
use crate::wire::SocketAddress;

use super::fault::Fault;
use super::identity::SimIdentity;
use super::modbus::Registers;
use super::module::SimModule;
use super::profile::SimProfile;
use super::tags::Tags;

/// A device and what is around it.
#[derive(Clone, Debug)]
pub struct SimConfig {
    /// What kind of controller it is, if it is one. [`SimProfile::config`] has what goes with it.
    pub profile: SimProfile,
    /// Who it says it is.
    pub identity: SimIdentity,
    /// Where it says it is: in ListIdentity and in TCP/IP attribute 5.
    pub address: SocketAddress,
    /// From a request to its reply; requests are worked on one after the other.
    pub delay: Millis,
    /// The first reply suffers the first, and so on, round and round. Empty: all is well.
    pub faults: Vec<Fault>,
    /// What is in its chassis and on its Ethernet beside it.
    pub modules: Vec<SimModule>,
    /// How many class 3 connections can be open at once.
    pub max_connections: usize,
    /// Longest connected message, in bytes, with its sequence count. Forward_Open alone cannot say more than 511.
    pub max_size: u16,
    /// Whether Large_Forward_Open is there.
    pub large: bool,
    /// Habits of other devices.
    pub quirks: Vec<Quirk>,
    /// The tags of a controller.
    pub tags: Option<Tags>,
    /// The registers of its Modbus object, if it has one.
    pub registers: Option<Registers>,
}

impl Default for SimConfig {
    fn default() -> Self {
        Self {
            profile: SimProfile::Generic,
            identity: SimIdentity::default(),
            address: SocketAddress::v4([127, 0, 0, 1], 44_818),
            delay: Millis(0),
            faults: Vec::new(),
            modules: SimModule::usual(),
            max_connections: 32,
            max_size: 4_002,
            large: true,
            quirks: Vec::new(),
            tags: None,
            registers: None,
        }
    }
}

/// Something that a device always does differently. As text: the names below, as in `--quirk no-context`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quirk {
    /// `no-context`: every reply has sender context 0.
    NoContext,
    /// `own-connection-id`: connected replies carry the id of the request, as those of cpppo do.
    OwnConnectionId,
}

/// The text is none of the quirk names.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("a quirk is one of no-context, own-connection-id")]
pub struct UnknownQuirk;

impl FromStr for Quirk {
    type Err = UnknownQuirk;

    fn from_str(text: &str) -> Result<Self, UnknownQuirk> {
        match text {
            "no-context" => Ok(Self::NoContext),
            "own-connection-id" => Ok(Self::OwnConnectionId),
            _ => Err(UnknownQuirk),
        }
    }
}

impl fmt::Display for Quirk {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::NoContext => "no-context",
            Self::OwnConnectionId => "own-connection-id",
        })
    }
}
