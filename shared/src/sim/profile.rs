//! Kinds of controllers that the device can be.

use alloc::vec::Vec;
use core::fmt;
use core::str::FromStr;

use crate::tag::Dialect;
use crate::wire::{MAX_MESSAGE, ShortString};

use super::config::SimConfig;
use super::identity::SimIdentity;
use super::module::SimModule;
use super::tags::TagMemory;

/// What the device is like. As text: the names in lower case, as in `--profile omron`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SimProfile {
    /// A drive in a chassis, without tags.
    #[default]
    Generic,
    /// A Rockwell Micro800: tags over connections only, one in a message; it leads on to nobody.
    Micro800,
    /// A Rockwell Logix: tags, programs, structures, several requests in a message.
    Logix,
    /// An Omron NX: published variables, at most 502 bytes without a connection.
    Omron,
}

/// The text is none of the profile names.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("a profile is one of generic, micro800, logix, omron")]
pub struct UnknownProfile;

/// Names in the order of the text above.
const NAMES: [(SimProfile, &str); 4] = [
    (SimProfile::Generic, "generic"),
    (SimProfile::Micro800, "micro800"),
    (SimProfile::Logix, "logix"),
    (SimProfile::Omron, "omron"),
];

impl SimProfile {
    /// How it lays out tags; `None`: it has none.
    pub const fn dialect(self) -> Option<Dialect> {
        match self {
            Self::Generic => None,
            Self::Micro800 => Some(Dialect::Micro800),
            Self::Logix => Some(Dialect::Logix),
            Self::Omron => Some(Dialect::Omron),
        }
    }

    /// Such a device, with its [usual tags](TagMemory::usual).
    pub fn config(self) -> SimConfig {
        SimConfig {
            profile: self,
            identity: self.identity(),
            modules: self.modules(),
            max_size: self.max_size(),
            tags: self.dialect().map(|dialect| TagMemory::usual(dialect).into()),
            ..SimConfig::default()
        }
    }

    /// Vendor and device type are those by which clients tell the families; the name says that it is none of them.
    fn identity(self) -> SimIdentity {
        // vendor, device type, product code, major revision, serial number, name. 1 is Rockwell, 47 Omron; 0x0E a
        // programmable controller, 0x0C a communications adapter, as NJ and NX controllers say of themselves.
        let (vendor, device_type, product_code, major, serial, name): (_, _, _, _, _, &[u8]) = match self {
            Self::Generic => return SimIdentity::default(),
            // Clients know the family by the first characters (pycomm3).
            Self::Micro800 => (1, 0x0E, 0xCD, 12, 0x00C1_DE80, b"2080-DEMO by cipdeck"),
            // From 21 on clients address symbols by their numbers (pycomm3).
            Self::Logix => (1, 0x0E, 0xCD, 32, 0x00C1_DE10, b"cipdeck demo Logix"),
            Self::Omron => (47, 0x0C, 0xCD, 2, 0x00C1_DE47, b"cipdeck demo NX"),
        };
        let name = ShortString::new(name).unwrap_or_default();
        SimIdentity { vendor, device_type, product_code, revision: (major, 11), serial, name }
    }

    fn modules(self) -> Vec<SimModule> {
        match self {
            Self::Generic | Self::Logix => SimModule::usual(),
            Self::Micro800 | Self::Omron => Vec::new(),
        }
    }

    /// The slot in which the device itself is. libplctag, pycomm3: a Micro800 has none.
    pub(super) const fn slot(self) -> Option<u8> {
        match self {
            Self::Micro800 => None,
            _ => Some(SimModule::OWN_SLOT),
        }
    }

    /// Longest connected message with its sequence count, in bytes. libplctag (Omron: fork wegel, omron/conn.c).
    const fn max_size(self) -> u16 {
        match self {
            Self::Omron => 1_994,
            _ => 4_002,
        }
    }

    /// Longest unconnected request, and longest reply to one. Omron: aphyt n_series.py, MAXIMUM_LENGTH; the others: the size of a
    /// connection that Forward_Open makes (libplctag).
    pub(super) const fn max_unconnected(self) -> usize {
        match self {
            Self::Generic => MAX_MESSAGE,
            Self::Logix | Self::Micro800 => 504,
            Self::Omron => 502,
        }
    }

    /// Whether it takes several requests in a message. libplctag, pycomm3: a Micro800 does not.
    pub(super) const fn packs(self) -> bool {
        matches!(self, Self::Logix | Self::Omron)
    }

    /// Whether it hands messages on. libplctag, pycomm3: a Micro800 takes no Unconnected_Send.
    pub(super) const fn routes(self) -> bool {
        !matches!(self, Self::Micro800)
    }
}

impl FromStr for SimProfile {
    type Err = UnknownProfile;

    fn from_str(text: &str) -> Result<Self, UnknownProfile> {
        NAMES.iter().find(|row| row.1 == text).map(|row| row.0).ok_or(UnknownProfile)
    }
}

impl fmt::Display for SimProfile {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(NAMES.iter().find(|row| row.0 == *self).map_or("generic", |row| row.1))
    }
}
