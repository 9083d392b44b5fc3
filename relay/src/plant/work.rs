//! From what is stored to what is polled and shown.

use cipdeck_shared::api::{DeviceHealth, DeviceLoad, DeviceStatus, HealthState};
use cipdeck_shared::config::{DeviceId, GroupId, Variable};
use cipdeck_shared::plan::plant::{self, PlantFinding};
use cipdeck_shared::tag::{Types, View};

use super::Inner;
use super::point::Shown;
use crate::runner::lock;

impl Inner {
    /// A device, or something that belongs to it, has changed. Variables of the `changed` group are told anew in any case.
    pub(super) fn apply(&self, device: DeviceId, changed: Option<GroupId>) {
        let entries = lock(&self.entries);
        let Ok(device) = entries.device(device) else { return };
        let plan = plant::device(&device.config);
        let types = plan.as_ref().map(|plan| plan.types.clone()).unwrap_or_default();
        for group in entries.groups_of(device.id) {
            let shown = shown(entries.variables_of(group.id), &types);
            self.hub.put_group(group.id, shown, changed == Some(group.id));
        }
        if self.hub.status(device.id).is_none() {
            self.hub.put_status(idle(device.id));
        }
    }

    /// A device is gone.
    pub(super) fn forget(&self, device: DeviceId) {
        self.hub.remove_status(device);
    }
}

/// How variables are shown.
fn shown(variables: &[Variable], types: &Types) -> Vec<Shown> {
    let mut plans = plant::variables(variables, types);
    let shown = |variable: &Variable| match plans.remove(&variable.id) {
        Some(Ok(plan)) => Shown {
            variable: variable.id,
            address: plan.name.to_string(),
            view: plan.view,
            unit: plan.unit,
            wrong: None,
        },
        other => Shown {
            variable: variable.id,
            address: variable.config.address.clone(),
            view: View::default(),
            unit: String::new(),
            wrong: Some(in_words(other.and_then(Result::err).as_deref().unwrap_or_default())),
        },
    };
    variables.iter().map(shown).collect()
}

/// Findings as one line.
pub(super) fn in_words(findings: &[PlantFinding]) -> String {
    let words: Vec<_> =
        findings.iter().map(|finding| format!("{}: {}", finding.field, finding.rule)).collect();
    words.join("; ")
}

/// A device that nobody has asked yet.
pub(super) fn idle(device: DeviceId) -> DeviceStatus {
    let health = DeviceHealth {
        state: HealthState::Idle,
        words: "no group is on".to_owned(),
        status_word: None,
        identity: None,
        at: None,
    };
    DeviceStatus { device, health, profile: String::new(), load: DeviceLoad::default(), errors: Vec::new() }
}
