//! A variable: one value of a device, how it is shown and whether it may be written.

use alloc::collections::BTreeMap;
use alloc::string::String;
use alloc::vec::Vec;

use serde::{Deserialize, Serialize};

use super::plant_id::{GroupId, VariableId};
use crate::tag::{Display, Scale};

/// A variable as the relay stores and sends it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct Variable {
    /// Given by the relay.
    pub id: VariableId,
    /// Counts up with every change; a change names the revision that it replaces.
    pub revision: u64,
    /// Where it belongs. It stays as it was made.
    pub group: GroupId,
    /// What people have entered.
    #[serde(flatten)]
    pub config: VariableConfig,
}

/// What people enter about a variable.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct VariableConfig {
    /// The structure or array that it is a part of; another variable of the same group.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub parent: Option<VariableId>,
    /// What people call it: 1 to 128 characters.
    pub name: String,
    /// Its name in the device: `grHWCs_PV`, `Program:Main.x`, `Status.5` for a bit. With a parent what follows the
    /// parent's: `speed` or `[3]`.
    pub address: String,
    /// `REAL`, `DINT[10]`, `STRING[20]`, `STRUCT{a: INT}` or a name from the device's `types`. Empty: what the device
    /// says.
    #[serde(rename = "type", default, skip_serializing_if = "String::is_empty")]
    pub kind: String,
    /// From the raw number to the one that is shown; absent: as it is.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scale: Option<Scale>,
    /// The unit of the number that is shown. At most 16 characters.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub unit: String,
    /// Digits after the point, 0 to 9; absent: as many as there are.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub digits: Option<i64>,
    /// How it is shown.
    #[serde(default, skip_serializing_if = "is_auto")]
    pub display: Display,
    /// Words for numbers.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub choices: Vec<Choice>,
    /// Whether it may be written at all.
    #[serde(default)]
    pub writable: bool,
    /// The smallest number that may be written, in its unit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub min: Option<f64>,
    /// The biggest number that may be written, in its unit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub max: Option<f64>,
    /// Its place among its neighbours; those with the same number follow by id.
    #[serde(default)]
    pub order: i64,
}

/// A variable that is to be added.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct NewVariable {
    /// Instead of `parent`: the full address of a variable of the group, which may be an earlier one of this list.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub parent_address: Option<String>,
    /// What is entered.
    #[serde(flatten)]
    pub config: VariableConfig,
}

/// A word for a number: `3 = "running"`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct Choice {
    /// The raw number.
    pub value: i64,
    /// What is shown.
    pub text: String,
}

impl VariableConfig {
    /// With everything that may be left out as it is then.
    pub fn new(name: &str, address: &str) -> Self {
        Self { name: name.into(), address: address.into(), ..Self::default() }
    }
}

/// The address of a part: `a` and `b` make `a.b`, `a` and `[3]` make `a[3]`.
pub fn join_address(parent: &str, own: &str) -> String {
    let (parent, own) = (parent.trim(), own.trim());
    let is_index = own.starts_with('[');
    let point = if is_index || parent.is_empty() || own.is_empty() { "" } else { "." };
    alloc::format!("{parent}{point}{own}")
}

/// The full addresses of variables, in their order. A parent that is not among them, or that is its own parent, gives
/// the own address alone.
pub fn full_addresses(all: &[Variable]) -> Vec<String> {
    let by_id: BTreeMap<_, _> = all.iter().map(|variable| (variable.id, variable)).collect();
    let find = |id: VariableId| by_id.get(&id).copied();
    all.iter()
        .map(|variable| {
            let mut address = String::from(variable.config.address.trim());
            let mut parent = variable.config.parent.and_then(find);
            for _ in 0..MAX_DEPTH {
                let Some(found) = parent else { break };
                address = join_address(&found.config.address, &address);
                parent = found.config.parent.and_then(find);
            }
            address
        })
        .collect()
}

/// Parents above a variable, at most.
pub const MAX_DEPTH: usize = 16;

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde calls it")]
fn is_auto(display: &Display) -> bool {
    *display == Display::Auto
}

#[cfg(test)]
mod tests {
    use alloc::vec;

    use super::*;

    #[test]
    fn a_variable_is_read_with_what_is_left_out() {
        let config: VariableConfig = serde_json::from_str(r#"{"name":"PV","address":"grHWCs_PV"}"#).unwrap();
        assert_eq!(config, VariableConfig::new("PV", "grHWCs_PV"));
        let variable = Variable { id: VariableId(7), revision: 1, group: GroupId(1), config };
        let text = r#"{"id":"v7","revision":1,"group":"g1","name":"PV","address":"grHWCs_PV","writable":false,"order":0}"#;
        assert_eq!(serde_json::to_string(&variable).unwrap(), text);
        assert_eq!(serde_json::from_str::<Variable>(text).unwrap(), variable);
    }

    #[test]
    fn everything_that_can_be_said_of_a_variable_comes_back() {
        let text = r#"{"parent":"v3","name":"mode","address":"mode","type":"INT","scale":{"factor":0.1,"offset":-5.0},"unit":"°C","digits":1,"display":"hex","choices":[{"value":3,"text":"running"}],"writable":true,"min":0.0,"max":99.5,"order":2}"#;
        let config: VariableConfig = serde_json::from_str(text).unwrap();
        assert_eq!(serde_json::to_string(&config).unwrap(), text);
    }

    #[test]
    fn a_part_is_called_by_all_its_parents() {
        let variable = |id, parent: Option<u32>, address: &str| Variable {
            id: VariableId(id),
            revision: 1,
            group: GroupId(1),
            config: VariableConfig { parent: parent.map(VariableId), ..VariableConfig::new("x", address) },
        };
        let all = [
            variable(4, Some(2), "speed"),
            variable(1, None, "Line"),
            variable(2, Some(1), "[3]"),
            variable(5, Some(9), "gone"),
            variable(6, Some(6), "self"),
        ];
        let found = full_addresses(&all);
        assert_eq!(found[..4], vec!["Line[3].speed", "Line", "Line[3]", "gone"]);
        assert!(found[4].starts_with("self.self"), "ends all the same");
    }
}
