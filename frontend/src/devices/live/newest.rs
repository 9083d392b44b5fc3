//! The newest value of a variable, with what the page needs of it.

use cipdeck_shared::{
    api::{Quality, VariableValue},
    config::{GroupId, VariableId},
};
use serde::Deserialize;

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

/// The message that comes most often, by far. Read by itself, it is read once, and without what is not shown: of 5,000
/// values that is the difference between a frame and several.
#[derive(Debug, Deserialize)]
pub(super) struct Values {
    pub(super) group: GroupId,
    pub(super) values: Vec<Newest>,
}

impl Values {
    /// The message, if it is this one as our relays write it. Any other way to write it is read like all messages.
    pub(super) fn read(text: &str) -> Option<Self> {
        text.starts_with(BEGIN).then(|| serde_json::from_str(text).ok()).flatten()
    }
}

const BEGIN: &str = r#"{"type":"values","#;

impl From<VariableValue> for Newest {
    fn from(value: VariableValue) -> Self {
        let VariableValue { variable, quality, reason, text, number, kind, age_ms, .. } = value;
        Self { variable, quality, reason, text, number, kind, age_ms }
    }
}

#[cfg(test)]
mod tests {
    use cipdeck_shared::api::LiveServerMessage;

    use super::*;

    #[test]
    fn both_ways_to_read_a_message_find_the_same() {
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
        let message = LiveServerMessage::Values { group: GroupId(3), values: vec![value.clone()] };
        let read = Values::read(&serde_json::to_string(&message).unwrap()).expect("as the relay writes it");
        assert_eq!((read.group, read.values), (GroupId(3), vec![Newest::from(value)]));
        assert!(Values::read(r#"{"group":"g3","type":"values","values":[]}"#).is_none());
        assert!(Values::read(r#"{"type":"values","group":"g3"}"#).is_none());
    }
}
