//! What kind of device a target is.

use serde::{Deserialize, Serialize};

/// What a target is known to want. docs/PROFILES.md lists what each changes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
#[serde(rename_all = "lowercase")]
pub enum Profile {
    /// Asked of the device's identity, where it matters.
    #[default]
    Auto,
    /// Nothing special.
    Generic,
    /// Rockwell Micro800: takes no route to its own slot and packs no requests.
    Micro800,
    /// Rockwell ControlLogix, CompactLogix: large connections.
    Logix,
    /// Omron NJ and NX: large connections of its own size.
    Omron,
}

impl Profile {
    /// All of them.
    pub const ALL: [Self; 5] = [Self::Auto, Self::Generic, Self::Micro800, Self::Logix, Self::Omron];

    /// The word in a configuration.
    pub const fn word(self) -> &'static str {
        match self {
            Self::Auto => "auto",
            Self::Generic => "generic",
            Self::Micro800 => "micro800",
            Self::Logix => "logix",
            Self::Omron => "omron",
        }
    }

    /// From the word in a configuration.
    pub fn of_word(word: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|profile| profile.word() == word)
    }

    /// From what a device says of itself. Sources: pycomm3 logix_driver.py (Micro800 product names start with 2080),
    /// ODVA vendor ids 1 (Rockwell) and 47 (Omron), device type 0x0E (programmable logic controller).
    pub fn of_identity(vendor: u16, device_type: u16, product_name: &[u8]) -> Self {
        match (vendor, device_type) {
            (1, _) if product_name.starts_with(b"2080") => Self::Micro800,
            (1, 0x0E) => Self::Logix,
            (47, _) => Self::Omron,
            _ => Self::Generic,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_device_is_known_by_its_identity() {
        for (vendor, device_type, name, profile) in [
            (1, 0x0E, &b"1756-L61/B LOGIX5561"[..], Profile::Logix),
            (1, 0x0E, b"2080-LC50-24QWB", Profile::Micro800),
            (1, 0x02, b"PowerFlex 525", Profile::Generic),
            (47, 0x0C, b"NX102-9000", Profile::Omron),
            (0xFFFF, 0x0E, b"2080", Profile::Generic),
        ] {
            assert_eq!(Profile::of_identity(vendor, device_type, name), profile);
        }
        for profile in Profile::ALL {
            assert_eq!(Profile::of_word(profile.word()), Some(profile));
        }
    }
}
