//! Messages of the WebSocket at `/api/v1/live`: devices, groups, and the values of variables. Described with examples
//! in docs/LIVE.md.

use alloc::string::String;
use alloc::vec::Vec;

use serde::{Deserialize, Serialize};

use super::devices::Tree;
use super::write::WriteState;
use crate::config::{DeviceId, GroupId, VariableId};

/// The `protocol` in `hello`.
pub const LIVE_PROTOCOL: u32 = 1;

/// What the relay says.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
#[serde(tag = "type", rename_all = "lowercase")]
pub enum LiveServerMessage {
    /// First.
    Hello {
        /// [`LIVE_PROTOCOL`].
        protocol: u32,
        /// The relay's version.
        relay: String,
    },
    /// Whether something may be written at all: at the beginning, and whenever it changes.
    Access(WriteState),
    /// All devices and groups: at the beginning, and whenever one of them has changed.
    Tree(Tree),
    /// Variables of a watched group have changed: ask for them again.
    Variables {
        /// Which group.
        group: GroupId,
    },
    /// How devices are: all of them at the beginning, then those that have changed.
    Status {
        /// Whole.
        devices: Vec<DeviceStatus>,
    },
    /// The newest value of each variable that has changed; at the beginning of watching a group all that there are.
    Values {
        /// Which group.
        group: GroupId,
        /// Whole.
        values: Vec<VariableValue>,
    },
    /// The viewer's message was not understood.
    Problem {
        /// Why, in English.
        detail: String,
    },
}

/// What a viewer says.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
#[serde(tag = "type", rename_all = "lowercase", deny_unknown_fields)]
pub enum LiveClientMessage {
    /// From now on the values of these groups, and of no others. At most 64.
    Watch {
        /// Groups that are not there are left out.
        groups: Vec<GroupId>,
    },
}

/// A variable's value as everybody sees it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct VariableValue {
    /// Which variable.
    pub variable: VariableId,
    /// Whether it can be relied on.
    pub quality: Quality,
    /// Why not, in words.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reason: Option<String>,
    /// As it is shown, with its unit; empty where there never was a value.
    pub text: String,
    /// The scaled number, for what is one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub number: Option<f64>,
    /// The raw value: a number, a text, TRUE or FALSE, a list, or an object with the members of a structure.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub value: Option<serde_json::Value>,
    /// What the value is: `REAL`, `DINT[10]`; empty where nobody knows yet.
    #[serde(rename = "type")]
    pub kind: String,
    /// When the value was read (RFC 3339).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at: Option<String>,
    /// ms since then, when this was said: clocks differ.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub age_ms: Option<u64>,
}

/// Whether a value can be relied on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
#[serde(rename_all = "lowercase")]
pub enum Quality {
    /// It has not been read yet; or its group is off.
    Waiting,
    /// As it is.
    Good,
    /// The last one that was read; newer ones do not come.
    Stale,
    /// The device does not give it.
    Bad,
}

/// How a device is.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct DeviceStatus {
    /// Which device.
    pub device: DeviceId,
    /// Whether it answers.
    pub health: DeviceHealth,
    /// What kind of device it is taken for: `omron`, `logix`, `micro800`, `generic`; empty until it was asked.
    pub profile: String,
    /// What asking it costs.
    pub load: DeviceLoad,
    /// What is wrong, in words; empty when nothing is.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub errors: Vec<String>,
}

/// A device's own opinion, from its Identity object, and ours.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct DeviceHealth {
    /// In a word.
    pub state: HealthState,
    /// What Identity's status word says, or why the device does not answer.
    pub words: String,
    /// Identity attribute 5.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub status_word: Option<u16>,
    /// What the device says that it is.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub identity: Option<DeviceIdentity>,
    /// When it said so (RFC 3339).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at: Option<String>,
}

/// How a device is, in a word.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
#[serde(rename_all = "lowercase")]
pub enum HealthState {
    /// Nobody asks: no group is on.
    Idle,
    /// It has been asked and has not answered yet.
    Asking,
    /// It answers.
    Good,
    /// It answers, and says that something is wrong.
    Fault,
    /// It does not answer.
    Lost,
    /// The relay must not ask it: it is not on the list of allowed targets.
    Denied,
}

/// What a device says that it is.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct DeviceIdentity {
    /// The vendor's name.
    pub vendor: String,
    /// The device type's name.
    pub device_type: String,
    /// Product name.
    pub name: String,
    /// Major and minor with three digits: `1.001`.
    pub revision: String,
    /// Serial number, eight hexadecimal digits.
    pub serial: String,
}

/// What polling a device costs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct DeviceLoad {
    /// Requests since the start of the relay.
    pub requests: u64,
    /// Requests in the last second.
    pub requests_per_s: u32,
    /// Requests that reading all groups once takes.
    pub requests_per_cycle: u32,
    /// µs that reading all groups once has taken.
    pub cycle_us: u64,
    /// µs that a reading began late.
    pub lateness_us: u64,
    /// Readings that were left out because the one before had not ended.
    pub skipped_periods: u64,
    /// Variables that are read.
    pub items: u32,
    /// Variables that the device does not give.
    pub bad_items: u32,
    /// The limit of requests a second makes readings wait.
    pub is_limited: bool,
}

impl Quality {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Waiting, Self::Good, Self::Stale, Self::Bad];

    /// The word in JSON.
    pub const fn word(self) -> &'static str {
        match self {
            Self::Waiting => "waiting",
            Self::Good => "good",
            Self::Stale => "stale",
            Self::Bad => "bad",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_viewers_message_is_as_documented() {
        let text = r#"{"type":"watch","groups":["g1","g2"]}"#;
        let message: LiveClientMessage = serde_json::from_str(text).unwrap();
        assert_eq!(serde_json::to_string(&message).unwrap(), text);
        for wrong in [r#"{"type":"watch","groups":["x"]}"#, r#"{"type":"watch","groups":[],"all":true}"#] {
            assert!(serde_json::from_str::<LiveClientMessage>(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn the_relays_messages_are_as_documented() {
        for text in [
            r#"{"type":"hello","protocol":1,"relay":"0.1.0"}"#,
            r#"{"type":"access","window":null,"read_only":false}"#,
            r#"{"type":"tree","devices":[],"groups":[{"id":"g1","revision":1,"device":"d1","name":"line 4","period_ms":500,"on":true,"order":0}]}"#,
            r#"{"type":"variables","group":"g1"}"#,
            r#"{"type":"status","devices":[{"device":"d1","health":{"state":"good","words":"no fault","status_word":0,"identity":{"vendor":"Omron","device_type":"PLC","name":"NX102","revision":"1.001","serial":"0a0b0c0d"},"at":"2026-11-22T13:31:25.123456Z"},"profile":"omron","load":{"requests":1200,"requests_per_s":12,"requests_per_cycle":2,"cycle_us":2100,"lateness_us":40,"skipped_periods":0,"items":51,"bad_items":1,"is_limited":false}}]}"#,
            r#"{"type":"values","group":"g1","values":[{"variable":"v1","quality":"good","text":"21.5 °C","number":21.5,"value":21.5,"type":"REAL","at":"2026-11-22T13:31:25.123456Z","age_ms":12},{"variable":"v2","quality":"bad","reason":"the device has no such variable","text":"","type":""}]}"#,
            r#"{"type":"problem","detail":"the message cannot be read"}"#,
        ] {
            let message: LiveServerMessage = serde_json::from_str(text).unwrap();
            assert_eq!(serde_json::to_string(&message).unwrap(), text);
        }
    }
}
