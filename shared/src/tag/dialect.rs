//! How a family of controllers lays values out.

use crate::config::Profile;

/// A family of controllers, as far as the bytes of tags are concerned.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Dialect {
    /// Rockwell ControlLogix and CompactLogix, and whoever does as they do (cpppo).
    #[default]
    Logix,
    /// Rockwell Micro800.
    Micro800,
    /// Omron NJ and NX.
    Omron,
}

impl Dialect {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Logix, Self::Micro800, Self::Omron];

    /// What devices of this kind speak; a device of which nothing is known is taken for a Logix.
    pub const fn of(profile: Profile) -> Self {
        match profile {
            Profile::Micro800 => Self::Micro800,
            Profile::Omron => Self::Omron,
            Profile::Auto | Profile::Generic | Profile::Logix => Self::Logix,
        }
    }

    /// Characters of a STRING that says nothing about its length: Logix 1756-PM020 (82), Omron W501 (255 and a
    /// terminator), Micro800 (80).
    pub const fn string_capacity(self) -> u16 {
        match self {
            Self::Logix => 82,
            Self::Micro800 => 80,
            Self::Omron => 256,
        }
    }
}
