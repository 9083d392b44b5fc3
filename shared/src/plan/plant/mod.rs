//! Devices, groups and variables: what people have entered → what can be polled, or all findings.

mod checks;
mod csv;
mod finding;
mod together;

use alloc::string::String;
use alloc::vec::Vec;

use crate::config::{Connecting, DeviceConfig, GroupConfig, Profile, TargetPath, VariableConfig};
use crate::tag::{TagName, Type, Types, View};

use self::checks::Checks;
pub use self::csv::{COLUMNS, read_csv, write_csv};
pub use self::finding::{PlantFinding, PlantRule};
pub use self::together::{Accepted, MAX_ADDED, MAX_IN_GROUP, added, changed, variables};

/// Characters of a name of a device, a group or a site. Our own limit.
const MAX_NAME: usize = 64;

/// Characters of a variable's name. Our own limit.
const MAX_VARIABLE_NAME: usize = 128;

/// Characters of a unit. Our own limit.
const MAX_UNIT: usize = 16;

/// Words of one variable. Our own limit.
const MAX_CHOICES: usize = 256;

/// A device that can be asked.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DevicePlan {
    /// Where it is.
    pub path: TargetPath,
    /// What kind of device it is said to be.
    pub profile: Profile,
    /// How its messages go.
    pub connecting: Connecting,
    /// ms from a request to its reply.
    pub timeout_ms: u32,
    /// Requests a second.
    pub max_requests_per_s: u32,
    /// Named structures.
    pub types: Types,
}

/// A variable that can be read.
#[derive(Clone, Debug)]
pub struct VariablePlan {
    /// Its whole name.
    pub name: TagName,
    /// Its type, if it was entered or follows from its parent's.
    pub kind: Option<Type>,
    /// How a person sees it.
    pub view: View,
    /// The unit of what a person sees.
    pub unit: String,
}

/// Everything that is wrong with a device, or what can be asked.
pub fn device(config: &DeviceConfig) -> Result<DevicePlan, Vec<PlantFinding>> {
    let mut checks = Checks::default();
    checks.name("name", &config.name, MAX_NAME);
    checks.text("site", &config.site, MAX_NAME);
    let path: Option<TargetPath> = match config.path.parse() {
        Ok(path) => Some(path),
        Err(error) => checks.add("path", PlantRule::Path(error)),
    };
    let timeout_ms = checks.number("timeout_ms", config.timeout_ms, 250, 10_000);
    let max_requests_per_s = checks.number("max_requests_per_s", config.max_requests_per_s, 1, 1_000);
    let types = checks.types(&config.types);
    let plan = || {
        let (profile, connecting) = (config.profile, config.connection);
        let (timeout_ms, max_requests_per_s) = (timeout_ms?, max_requests_per_s?);
        Some(DevicePlan { path: path?, profile, connecting, timeout_ms, max_requests_per_s, types })
    };
    let plan = plan();
    checks.end(plan)
}

/// Everything that is wrong with a group, or its period in ms.
pub fn group(config: &GroupConfig) -> Result<u32, Vec<PlantFinding>> {
    let mut checks = Checks::default();
    checks.name("name", &config.name, MAX_NAME);
    let period = checks.number("period_ms", config.period_ms, 10, 3_600_000);
    checks.end(period)
}

/// Everything that is wrong with a variable, or how it is read. `parent` is what it is a part of.
pub fn variable(
    config: &VariableConfig,
    parent: Option<&VariablePlan>,
    types: &Types,
) -> Result<VariablePlan, Vec<PlantFinding>> {
    let mut checks = Checks::default();
    checks.name("name", &config.name, MAX_VARIABLE_NAME);
    checks.text("unit", &config.unit, MAX_UNIT);
    let digits = config.digits.map(|digits| checks.number("digits", digits, 0, 9));
    let scale = config.scale.filter(|scale| checks.scale(*scale));
    let limits = (config.min, config.max);
    if matches!(limits, (Some(min), Some(max)) if min > max) {
        checks.add::<()>("min", PlantRule::MinOverMax);
    }
    if config.choices.len() > MAX_CHOICES {
        checks.add::<()>("choices", PlantRule::TooMany { max: MAX_CHOICES });
    }
    for choice in &config.choices {
        checks.name("choices", &choice.text, MAX_NAME);
    }
    let name = checks.address(&config.address, parent);
    let kind = checks.kind(config, name.as_ref(), parent, types);
    let view = View {
        display: config.display,
        scale,
        digits: digits.flatten(),
        choices: config.choices.iter().map(|choice| (choice.value, choice.text.clone())).collect(),
    };
    let unit = config.unit.trim().into();
    let plan = name.map(|name| VariablePlan { name, kind, view, unit });
    checks.end(plan)
}

#[cfg(test)]
mod tests;
