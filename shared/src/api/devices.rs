//! Devices, groups and variables: bodies of REST requests and answers. The entries themselves are
//! [`config`](crate::config)'s.

use alloc::string::{String, ToString};
use alloc::vec::Vec;

use serde::{Deserialize, Serialize};

use super::live::VariableValue;
use super::rest::Finding;
use super::write::Written;
use crate::config::{Device, Group, GroupId, NewVariable, VariableId};
use crate::plan::Severity;
use crate::plan::plant::{PlantFinding, PlantRule};

/// `GET /api/v1/devices`, and the message `tree` of the WebSocket: everything but the variables.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct Tree {
    /// All devices, by id.
    pub devices: Vec<Device>,
    /// All groups, in their order.
    pub groups: Vec<Group>,
}

/// `POST /api/v1/devices/{id}/copy`: a device with the same groups and variables.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct CopyDevice {
    /// What the copy is called.
    pub name: String,
    /// Where the copy is.
    pub path: String,
}

/// `POST /api/v1/groups/{id}/variables`: all of them are added, or none.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct NewVariables {
    /// At most 5000. Findings name the place, counted from 0: `variables[3].address`.
    pub variables: Vec<NewVariable>,
}

/// `POST /api/v1/groups/{id}/variables.csv`: the text of a file, whose first line names the columns. All of it is
/// added, or nothing. Findings name line and column: `line 4.address`.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct VariablesCsv {
    /// Separated by commas, semicolons or tabs.
    pub csv: String,
}

/// `GET /api/v1/groups/{id}/values`
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct GroupValues {
    /// Which group.
    pub group: GroupId,
    /// One of each variable, in their order.
    pub values: Vec<VariableValue>,
}

/// `POST /api/v1/variables/{id}/offer`: the first half of a write.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct NewValue {
    /// As a person types it, in the unit that is shown: `12.5`, `0x1F`, `TRUE`, a choice's word, `"text"`, `[1, 2]`.
    pub text: String,
}

/// `POST /api/v1/variables/{id}/write`: the second half.
#[derive(Clone, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct WriteVariable {
    /// From the offer.
    pub ticket: String,
}

/// A variable that has been written, or that the device has refused to write.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct VariableWritten {
    /// Whether the device has taken it.
    pub is_done: bool,
    /// Why it has not, in words.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reason: Option<String>,
    /// The request was sent and no answer came: the device may have carried it out.
    #[serde(default, skip_serializing_if = "is_false")]
    pub may_have_acted: bool,
    /// What was there, what was written, and what was read afterwards.
    pub written: Written,
    /// The value as it was read afterwards; none where it could not be read.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub value: Option<VariableValue>,
}

/// One entry of `GET /api/v1/devices/{id}/writes`, the newest first.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct WriteEntry {
    /// When it ended (RFC 3339).
    pub at: String,
    /// Who.
    pub actor: String,
    /// Which variable; it may have been deleted since.
    pub variable: VariableId,
    /// What it was called.
    pub name: String,
    /// Its full address.
    pub address: String,
    /// What was there, as it was shown.
    pub old: Option<String>,
    /// What was to be written, as it was shown.
    pub new: Option<String>,
    /// What was read afterwards.
    pub read_back: Option<String>,
    /// Whether the device has taken it.
    pub is_done: bool,
    /// Why it has not.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reason: Option<String>,
    /// Whether what was read is what was written.
    pub is_equal: Option<bool>,
}

/// `POST /api/v1/devices/{id}/browse`: the device is asked what it has. One such question at a time and device; a new
/// one ends the one before.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct BrowseRequest {
    /// Also the device's own variables.
    #[serde(default)]
    pub system: bool,
}

/// `GET /api/v1/devices/{id}/browse?from=N`: what has been found from the Nth on.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct BrowsePage {
    /// Whether more is to come.
    pub state: BrowseStep,
    /// Why it failed, or what the device cannot list.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reason: Option<String>,
    /// Requests that have been answered.
    pub requests: u64,
    /// Names that have been found until now.
    pub found: usize,
    /// How many there will be, where the device says so.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub expected: Option<usize>,
    /// From `from` on, at most 1000.
    pub symbols: Vec<BrowsedSymbol>,
    /// What to ask `from` next time.
    pub next: usize,
}

/// How far a listing is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
#[serde(rename_all = "lowercase")]
pub enum BrowseStep {
    /// Nobody has asked.
    Idle,
    /// The device is being asked.
    Running,
    /// Everything is there.
    Done,
    /// It ended early; what was found before stays.
    Failed,
    /// Somebody has ended it; what was found before stays.
    Cancelled,
}

/// A name that a device has.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct BrowsedSymbol {
    /// As an address takes it.
    pub name: String,
    /// `DINT[10]`, or the name of a structure.
    #[serde(rename = "type")]
    pub kind: String,
    /// It has members: `GET devices/{id}/browse/type?of=` tells them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub structure: Option<String>,
    /// What the device allows, where it says so.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub access: Option<String>,
    /// What else is worth knowing.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub note: Option<String>,
}

/// `GET /api/v1/devices/{id}/browse/type?of=…`
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct BrowsedType {
    /// The structure's name.
    pub name: String,
    /// Its members, with names as an address takes them after the parent's.
    pub members: Vec<BrowsedSymbol>,
    /// The whole type, as a device's `types` takes it.
    #[serde(rename = "type")]
    pub kind: String,
}

/// Findings about devices, groups and variables as JSON has them.
pub fn plant_findings(findings: &[PlantFinding]) -> Vec<Finding> {
    let finding = |found: &PlantFinding| {
        let (min, max) = match found.rule {
            PlantRule::OutOfRange { min, max, .. } => (Some(min), Some(max)),
            _ => (None, None),
        };
        Finding {
            field: found.field.clone(),
            severity: Severity::Error,
            rule: found.rule.key().into(),
            message: found.rule.to_string(),
            min,
            max,
            error_id: None,
            sub_error_id: None,
            communication_report: None,
        }
    };
    findings.iter().map(finding).collect()
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde calls it")]
const fn is_false(value: &bool) -> bool {
    !*value
}

super::secret::hide!(WriteVariable);

#[cfg(test)]
mod tests {
    use super::*;

    fn comes_back<T: Serialize + for<'a> Deserialize<'a>>(text: &str) {
        let value: T = serde_json::from_str(text).unwrap();
        assert_eq!(serde_json::to_string(&value).unwrap(), text);
    }

    #[test]
    fn requests_are_as_documented() {
        comes_back::<CopyDevice>(r#"{"name":"NX 2","path":"4,10.0.0.2"}"#);
        comes_back::<NewVariables>(
            r#"{"variables":[{"name":"motor","address":"stMotor","writable":false,"order":0},{"parent_address":"stMotor","name":"speed","address":"speed","type":"REAL","unit":"1/min","writable":true,"min":0.0,"max":1500.0,"order":0}]}"#,
        );
        comes_back::<VariablesCsv>(r#"{"csv":"name,address\nPV,grHWCs_PV\n"}"#);
        comes_back::<NewValue>(r#"{"text":"12.5"}"#);
        comes_back::<WriteVariable>(r#"{"ticket":"9f2c"}"#);
        comes_back::<BrowseRequest>(r#"{"system":true}"#);
    }

    #[test]
    fn answers_are_as_documented() {
        comes_back::<Tree>(
            r#"{"devices":[{"id":"d1","revision":1,"name":"NX 1","site":"hall 3","path":"4,10.0.0.1","profile":"omron","connection":"auto","timeout_ms":3000,"max_requests_per_s":100,"types":{"Motor":"STRUCT{speed: REAL; run: BOOL}"}}],"groups":[{"id":"g1","revision":2,"device":"d1","name":"line 4","period_ms":500,"on":true,"order":0}]}"#,
        );
        comes_back::<GroupValues>(
            r#"{"group":"g1","values":[{"variable":"v1","quality":"good","text":"21.5 °C","number":21.5,"value":21.5,"type":"REAL","at":"2026-11-22T13:31:25.123456Z","age_ms":12}]}"#,
        );
        comes_back::<VariableWritten>(
            r#"{"is_done":true,"written":{"old":{"data":"0000a841","text":"21 °C"},"new":{"data":"0000ac41","text":"21.5 °C"},"read_back":{"data":"0000ac41","text":"21.5 °C"},"is_equal":true},"value":{"variable":"v1","quality":"good","text":"21.5 °C","number":21.5,"value":21.5,"type":"REAL","at":"2026-11-22T13:31:25.123456Z","age_ms":0}}"#,
        );
        comes_back::<WriteEntry>(
            r#"{"at":"2026-11-22T13:31:25.123456Z","actor":"anna","variable":"v1","name":"PV","address":"grHWCs_PV","old":"21 °C","new":"21.5 °C","read_back":"21.5 °C","is_done":true,"is_equal":true}"#,
        );
        comes_back::<BrowsePage>(
            r#"{"state":"running","requests":3,"found":120,"expected":400,"symbols":[{"name":"stMotor","type":"Motor","structure":"4660","access":"read"},{"name":"TAG1","type":"BOOL"}],"next":120}"#,
        );
        comes_back::<BrowsedType>(
            r#"{"name":"Motor","members":[{"name":"speed","type":"REAL"}],"type":"STRUCT{speed: REAL}"}"#,
        );
    }

    #[test]
    fn a_ticket_is_not_printed() {
        let write = WriteVariable { ticket: "9f2c".into() };
        assert!(!alloc::format!("{write:?}").contains("9f2c"));
    }
}
