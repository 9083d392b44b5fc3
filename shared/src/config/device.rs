//! A device whose variables are polled: where it is, what it is, and how much it is asked.

use alloc::collections::BTreeMap;
use alloc::string::String;

use serde::{Deserialize, Serialize};

use super::plant_id::DeviceId;
use super::profile::Profile;

/// Milliseconds that a device has for an answer when nobody says otherwise.
pub const DEVICE_TIMEOUT_MS: i64 = 3_000;

/// Requests a second that a device gets at most when nobody says otherwise.
pub const DEVICE_REQUESTS_PER_S: i64 = 100;

/// A device as the relay stores and sends it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct Device {
    /// Given by the relay.
    pub id: DeviceId,
    /// Counts up with every change; a change names the revision that it replaces.
    pub revision: u64,
    /// What people have entered.
    #[serde(flatten)]
    pub config: DeviceConfig,
}

/// What people enter about a device.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct DeviceConfig {
    /// What people call it: 1 to 64 characters.
    pub name: String,
    /// Where it stands; devices are shown by site. At most 64 characters.
    #[serde(default)]
    pub site: String,
    /// As `TargetCfg.Path` of a block: `4,192.168.1.100` or `4,192.168.1.100,1,0`.
    pub path: String,
    /// What kind of device it is.
    #[serde(default)]
    pub profile: Profile,
    /// How its messages go.
    #[serde(default)]
    pub connection: Connecting,
    /// ms from a request to its reply; 250 to 10000.
    #[serde(default = "timeout_ms")]
    pub timeout_ms: i64,
    /// Requests a second that the relay sends at most, for all groups together; 1 to 1000.
    #[serde(default = "max_requests_per_s")]
    pub max_requests_per_s: i64,
    /// Named structures, for types that the device does not tell: `Motor` is `STRUCT{speed: REAL; run: BOOL}`.
    #[serde(default)]
    pub types: BTreeMap<String, String>,
}

/// How messages to a device go.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
#[serde(rename_all = "lowercase")]
pub enum Connecting {
    /// What suits the kind of device: connected for a Micro800, unconnected for all others.
    #[default]
    Auto,
    /// Each message by itself.
    Unconnected,
    /// Over a class 3 connection, with larger packets where the device takes them.
    Connected,
}

impl DeviceConfig {
    /// With everything that may be left out as it is then.
    pub fn new(name: &str, path: &str) -> Self {
        Self {
            name: name.into(),
            path: path.into(),
            timeout_ms: DEVICE_TIMEOUT_MS,
            max_requests_per_s: DEVICE_REQUESTS_PER_S,
            ..Self::default()
        }
    }
}

impl Connecting {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Auto, Self::Unconnected, Self::Connected];

    /// The word in JSON.
    pub const fn word(self) -> &'static str {
        match self {
            Self::Auto => "auto",
            Self::Unconnected => "unconnected",
            Self::Connected => "connected",
        }
    }
}

const fn timeout_ms() -> i64 {
    DEVICE_TIMEOUT_MS
}

const fn max_requests_per_s() -> i64 {
    DEVICE_REQUESTS_PER_S
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_device_is_read_with_what_is_left_out() {
        let config: DeviceConfig = serde_json::from_str(r#"{"name":"NX 1","path":"4,10.0.0.1"}"#).unwrap();
        assert_eq!(config, DeviceConfig::new("NX 1", "4,10.0.0.1"));
        let device = Device { id: DeviceId(7), revision: 3, config };
        let text = r#"{"id":"d7","revision":3,"name":"NX 1","site":"","path":"4,10.0.0.1","profile":"auto","connection":"auto","timeout_ms":3000,"max_requests_per_s":100,"types":{}}"#;
        assert_eq!(serde_json::to_string(&device).unwrap(), text);
        assert_eq!(serde_json::from_str::<Device>(text).unwrap(), device);
    }

    #[test]
    fn a_member_that_nobody_knows_is_refused() {
        let text = r#"{"name":"NX 1","path":"4,10.0.0.1","timeout":5}"#;
        assert!(serde_json::from_str::<DeviceConfig>(text).is_err());
    }
}
