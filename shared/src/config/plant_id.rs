//! `d1`, `g1`, `v1`: names of devices, groups and variables, given by the relay and never used again.

use alloc::string::String;
use core::fmt;
use core::str::FromStr;

use serde::{Deserialize, Serialize};

macro_rules! plant_id {
    ($(#[$doc:meta])* $name:ident, $letter:literal, $pattern:literal, $example:literal) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
        #[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
        #[cfg_attr(feature = "openapi", schema(value_type = String, pattern = $pattern, examples($example)))]
        #[serde(into = "String", try_from = "String")]
        pub struct $name(pub u32);

        impl fmt::Display for $name {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write!(f, "{}{}", $letter, self.0)
            }
        }

        impl From<$name> for String {
            fn from(id: $name) -> Self {
                alloc::format!("{id}")
            }
        }

        impl FromStr for $name {
            type Err = BadId;

            fn from_str(text: &str) -> Result<Self, BadId> {
                let bad = BadId { letter: $letter };
                let number = text.strip_prefix($letter).and_then(|digits| digits.parse().ok()).map(Self);
                // "d+7" and "d07" parse as numbers, but are not how we write d7.
                number.filter(|id| String::from(*id) == text).ok_or(bad)
            }
        }

        impl TryFrom<String> for $name {
            type Error = BadId;

            fn try_from(text: String) -> Result<Self, BadId> {
                text.parse()
            }
        }
    };
}

plant_id! {
    /// The number behind `d7`: a device.
    DeviceId, 'd', "^d(0|[1-9][0-9]{0,9})$", "d7"
}
plant_id! {
    /// The number behind `g7`: a group of variables.
    GroupId, 'g', "^g(0|[1-9][0-9]{0,9})$", "g7"
}
plant_id! {
    /// The number behind `v7`: a variable.
    VariableId, 'v', "^v(0|[1-9][0-9]{0,9})$", "v7"
}

/// The text is not the letter and a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("this id is {letter} and a number, such as {letter}7")]
pub struct BadId {
    letter: char,
}

#[cfg(test)]
mod tests {
    use alloc::string::ToString;

    use super::*;

    #[test]
    fn only_its_own_spelling_is_an_id() {
        assert_eq!("d7".parse(), Ok(DeviceId(7)));
        assert_eq!("g0".parse(), Ok(GroupId(0)));
        assert_eq!("v4294967295".parse(), Ok(VariableId(u32::MAX)));
        for text in ["7", "d", "d-1", "d+7", "d07", "D7", "d7 ", "g7", "d4294967296"] {
            assert!(text.parse::<DeviceId>().is_err(), "{text}");
        }
        let why = "x".parse::<VariableId>().map_err(|error| error.to_string());
        assert_eq!(why, Err("this id is v and a number, such as v7".into()));
    }
}
