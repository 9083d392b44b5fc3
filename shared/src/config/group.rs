//! A group: variables of one device that are read together.

use alloc::string::String;

use serde::{Deserialize, Serialize};

use super::plant_id::{DeviceId, GroupId};

/// A group as the relay stores and sends it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct Group {
    /// Given by the relay.
    pub id: GroupId,
    /// Counts up with every change; a change names the revision that it replaces.
    pub revision: u64,
    /// What people have entered.
    #[serde(flatten)]
    pub config: GroupConfig,
}

/// What people enter about a group.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct GroupConfig {
    /// Whose variables these are. It stays as it was made.
    pub device: DeviceId,
    /// What people call it: 1 to 64 characters.
    pub name: String,
    /// ms from the begin of one reading to the begin of the next; 10 to 3600000.
    #[serde(default = "period_ms")]
    pub period_ms: i64,
    /// Whether it is read at all.
    #[serde(default)]
    pub on: bool,
    /// Its place among the groups of the device; those with the same number follow by id.
    #[serde(default)]
    pub order: i64,
}

/// What a group's period is when nobody says otherwise.
pub const GROUP_PERIOD_MS: i64 = 1_000;

impl GroupConfig {
    /// Off, with everything that may be left out as it is then.
    pub fn new(device: DeviceId, name: &str) -> Self {
        Self { device, name: name.into(), period_ms: GROUP_PERIOD_MS, on: false, order: 0 }
    }
}

const fn period_ms() -> i64 {
    GROUP_PERIOD_MS
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_group_is_read_with_what_is_left_out() {
        let config: GroupConfig = serde_json::from_str(r#"{"device":"d1","name":"line 4"}"#).unwrap();
        assert_eq!(config, GroupConfig::new(DeviceId(1), "line 4"));
        let group = Group { id: GroupId(2), revision: 1, config };
        let text =
            r#"{"id":"g2","revision":1,"device":"d1","name":"line 4","period_ms":1000,"on":false,"order":0}"#;
        assert_eq!(serde_json::to_string(&group).unwrap(), text);
        assert_eq!(serde_json::from_str::<Group>(text).unwrap(), group);
    }
}
