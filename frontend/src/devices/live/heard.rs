//! What the relay says over the WebSocket, as this page reads it.
//!
//! Reading `LiveServerMessage` itself, which is told by its `type`, would read each message twice, with what is not shown,
//! and cost 10 kB of the page. A test holds both against each other.

use cipdeck_shared::{
    api::{DeviceStatus, Quality, Tree, WriteState},
    config::{GroupId, VariableId},
};
use serde::{Deserialize, de::DeserializeOwned};

/// A value as the relay says it, without what is not shown.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct Newest {
    /// Of which variable.
    pub variable: VariableId,
    /// Whether it can be relied on.
    pub quality: Quality,
    /// Why not, in words.
    #[serde(default)]
    pub reason: Option<String>,
    /// As it is shown.
    pub text: String,
    /// For what is a number.
    #[serde(default)]
    pub number: Option<f64>,
    /// Its type; empty where nobody knows yet.
    #[serde(rename = "type")]
    pub kind: String,
    /// ms since it was read, when this was said.
    #[serde(default)]
    pub age_ms: Option<u64>,
}

/// One message.
#[derive(Debug, PartialEq)]
pub(super) enum Heard {
    /// The protocol's number.
    Hello(u32),
    Access(WriteState),
    Tree(Tree),
    /// The variables of this group have changed.
    Variables(GroupId),
    Status(Vec<DeviceStatus>),
    Values(GroupId, Vec<Newest>),
}

impl Heard {
    /// Nothing for what a newer relay says that we do not know, and for our own mistakes.
    pub(super) fn read(text: &str) -> Option<Self> {
        let Kind { kind } = parse(text)?;
        Some(match kind.as_str() {
            "hello" => Self::Hello(parse::<Hello>(text)?.protocol),
            "access" => Self::Access(parse(text)?),
            "tree" => Self::Tree(parse(text)?),
            "variables" => Self::Variables(parse::<Variables>(text)?.group),
            "status" => Self::Status(parse::<Status>(text)?.devices),
            "values" => {
                let Values { group, values } = parse(text)?;
                Self::Values(group, values)
            }
            _ => return None,
        })
    }
}

fn parse<T: DeserializeOwned>(text: &str) -> Option<T> {
    serde_json::from_str(text).ok()
}

#[derive(Deserialize)]
struct Kind {
    #[serde(rename = "type")]
    kind: String,
}

#[derive(Deserialize)]
struct Hello {
    protocol: u32,
}

#[derive(Deserialize)]
struct Variables {
    group: GroupId,
}

#[derive(Deserialize)]
struct Status {
    devices: Vec<DeviceStatus>,
}

#[derive(Deserialize)]
struct Values {
    group: GroupId,
    values: Vec<Newest>,
}

#[cfg(test)]
mod tests {
    use cipdeck_shared::{
        api::{LIVE_PROTOCOL, LiveServerMessage, VariableValue, WindowView},
        config::{Device, DeviceConfig, DeviceId},
    };

    use super::*;

    fn heard(message: &LiveServerMessage) -> Option<Heard> {
        Heard::read(&serde_json::to_string(message).unwrap())
    }

    #[test]
    fn what_the_relay_says_is_read() {
        let relay = "0.1.0".to_owned();
        let hello = heard(&LiveServerMessage::Hello { protocol: LIVE_PROTOCOL, relay });
        assert_eq!(hello, Some(Heard::Hello(LIVE_PROTOCOL)));
        let (owner, opened_at, ends_at) = ("anna".to_owned(), String::new(), String::new());
        let window = Some(WindowView { owner, opened_at, ends_at, left_ms: 900_000 });
        let access = WriteState { window, read_only: true, stopped: None };
        assert_eq!(heard(&LiveServerMessage::Access(access.clone())), Some(Heard::Access(access)));
        let config = DeviceConfig::new("NX 1", "4,10.0.0.1");
        let tree =
            Tree { devices: vec![Device { id: DeviceId(1), revision: 2, config }], groups: Vec::new() };
        assert_eq!(heard(&LiveServerMessage::Tree(tree.clone())), Some(Heard::Tree(tree)));
        let group = GroupId(3);
        assert_eq!(heard(&LiveServerMessage::Variables { group }), Some(Heard::Variables(group)));
        assert_eq!(
            heard(&LiveServerMessage::Status { devices: Vec::new() }),
            Some(Heard::Status(Vec::new()))
        );
        assert_eq!(heard(&LiveServerMessage::Problem { detail: String::new() }), None);
        assert_eq!(Heard::read(r#"{"type":"weather"}"#), None);
    }

    #[test]
    fn a_value_is_read_without_what_is_not_shown() {
        let value = VariableValue {
            variable: VariableId(7),
            quality: Quality::Stale,
            reason: Some("no answer".to_owned()),
            text: "21.5 °C".to_owned(),
            number: Some(21.5),
            value: Some(serde_json::json!({ "a": [1, 2] })),
            kind: "REAL".to_owned(),
            at: Some("2026-11-22T13:31:25Z".to_owned()),
            age_ms: Some(12),
        };
        let VariableValue { variable, quality, reason, text, number, kind, age_ms, .. } = value.clone();
        let newest = Newest { variable, quality, reason, text, number, kind, age_ms };
        let message = LiveServerMessage::Values { group: GroupId(3), values: vec![value] };
        assert_eq!(heard(&message), Some(Heard::Values(GroupId(3), vec![newest])));
    }
}
