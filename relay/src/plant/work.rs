//! From what is stored to what is polled and shown.

use std::collections::BTreeMap;
use std::sync::Arc;

use cipdeck_shared::api::{DeviceHealth, DeviceLoad, DeviceStatus, HealthState};
use cipdeck_shared::config::{DeviceId, GroupId, Variable, VariableId};
use cipdeck_shared::engine::{Millis, poll};
use cipdeck_shared::plan::plant::{self, PlantFinding, VariablePlan};
use cipdeck_shared::tag::View;
use tokio::sync::watch;

use super::Inner;
use super::point::Shown;
use super::poll::{self as task, Shared, Work};
use crate::runner::lock;

impl Inner {
    /// A device, or something that belongs to it, has changed. Variables of the `changed` group are told anew in any case.
    pub(super) fn apply(&self, device: DeviceId, changed: Option<GroupId>) {
        let entries = lock(&self.entries);
        let Ok(device) = entries.device(device) else { return };
        let plan = plant::device(&device.config).map_err(|findings| in_words(&findings));
        let types = plan.as_ref().map(|plan| plan.types.clone()).unwrap_or_default();
        let mut groups = Vec::new();
        for group in entries.groups_of(device.id) {
            let variables = entries.variables_of(group.id);
            let plans = plant::variables(variables, &types);
            groups.push(poll::Group {
                id: group.id.0,
                period: Millis(plant::group(&group.config).unwrap_or(GROUP_PERIOD).into()),
                on: group.config.on,
                items: items(variables, &plans),
            });
            self.hub.put_group(group.id, shown(variables, plans), changed == Some(group.id));
        }
        let (id, name) = (device.id, device.config.name.clone());
        drop(entries);
        self.give(Work { device: id, name, plan, groups });
    }

    /// The device's task gets its work; one that is new begins.
    fn give(&self, work: Work) {
        let mut polls = lock(&self.polls);
        let work = Arc::new(work);
        if let Some(poll) = polls.get(&work.device) {
            poll.send_replace(work);
            return;
        }
        self.hub.put_status(idle(work.device));
        let (sender, receiver) = watch::channel(Arc::clone(&work));
        polls.insert(work.device, sender);
        let shared = Shared {
            hub: Arc::clone(&self.hub),
            runner: self.runner.clone(),
            policy: Arc::clone(&self.policy),
            clock: self.clock,
            stop: self.stop.clone(),
        };
        self.tasks.spawn(task::run(shared, receiver));
    }

    /// A device is gone.
    pub(super) fn forget(&self, device: DeviceId) {
        // Its task ends when nobody can give it work any more.
        lock(&self.polls).remove(&device);
        if let Some(browsing) = lock(&self.browses).remove(&device) {
            browsing.end();
        }
        self.hub.remove_status(device);
    }
}

/// A group whose period is wrong is read so often, in ms.
const GROUP_PERIOD: u32 = 1_000;

type Plans = BTreeMap<VariableId, Result<VariablePlan, Vec<PlantFinding>>>;

/// What is read.
fn items(variables: &[Variable], plans: &Plans) -> Vec<poll::Item> {
    let item = |variable: &Variable| {
        let plan = plans.get(&variable.id)?.as_ref().ok()?;
        Some(poll::Item { id: variable.id.0, name: plan.name.clone(), kind: plan.kind.clone() })
    };
    variables.iter().filter_map(item).collect()
}

/// How variables are shown.
fn shown(variables: &[Variable], mut plans: Plans) -> Vec<Shown> {
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
