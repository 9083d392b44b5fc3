//! Devices, groups and variables as they are stored, in memory.

use std::collections::{BTreeMap, BTreeSet};

use cipdeck_shared::api::Tree;
use cipdeck_shared::config::{Device, DeviceId, Group, GroupId, Variable, VariableId};

use crate::error::ApiError;
use crate::store::StoredPlant;

/// Everything that is stored.
#[derive(Clone, Debug, Default)]
pub(super) struct Entries {
    devices: BTreeMap<DeviceId, Device>,
    groups: BTreeMap<GroupId, Group>,
    variables: BTreeMap<GroupId, Vec<Variable>>,
    /// Where each variable is.
    homes: BTreeMap<VariableId, GroupId>,
}

impl Entries {
    /// Adds all of these.
    pub(super) fn add(&mut self, stored: StoredPlant) {
        self.devices.extend(stored.devices.into_iter().map(|device| (device.id, device)));
        self.groups.extend(stored.groups.into_iter().map(|group| (group.id, group)));
        self.add_variables(stored.variables);
    }

    /// Everything but the variables.
    pub(super) fn tree(&self) -> Tree {
        let mut groups: Vec<_> = self.groups.values().cloned().collect();
        groups.sort_by_key(|group| (group.config.device, group.config.order, group.id));
        Tree { devices: self.devices.values().cloned().collect(), groups }
    }

    /// All devices.
    pub(super) fn devices(&self) -> impl Iterator<Item = &Device> {
        self.devices.values()
    }

    /// A device.
    pub(super) fn device(&self, id: DeviceId) -> Result<&Device, ApiError> {
        self.devices.get(&id).ok_or_else(|| ApiError::NotFound(format!("there is no device {id}")))
    }

    /// The groups of a device, in their order.
    pub(super) fn groups_of(&self, device: DeviceId) -> Vec<&Group> {
        let mut groups: Vec<_> = self.groups.values().filter(|group| group.config.device == device).collect();
        groups.sort_by_key(|group| (group.config.order, group.id));
        groups
    }

    /// A group.
    pub(super) fn group(&self, id: GroupId) -> Result<&Group, ApiError> {
        self.groups.get(&id).ok_or_else(|| ApiError::NotFound(format!("there is no group {id}")))
    }

    /// The variables of a group, in their order.
    pub(super) fn variables_of(&self, group: GroupId) -> &[Variable] {
        self.variables.get(&group).map_or(&[], Vec::as_slice)
    }

    /// A variable.
    pub(super) fn variable(&self, id: VariableId) -> Result<&Variable, ApiError> {
        let group = self.homes.get(&id).map_or(&[][..], |group| self.variables_of(*group));
        let variable = group.iter().find(|variable| variable.id == id);
        variable.ok_or_else(|| ApiError::NotFound(format!("there is no variable {id}")))
    }

    /// A variable and all its parts, and parts of parts.
    pub(super) fn with_parts(&self, id: VariableId) -> Vec<VariableId> {
        let all = self.homes.get(&id).map_or(&[][..], |group| self.variables_of(*group));
        let mut found = vec![id];
        let mut at = 0;
        while let Some(parent) = found.get(at).copied() {
            let parts = all.iter().filter(|part| part.config.parent == Some(parent) && part.id != parent);
            let parts: Vec<_> = parts.map(|part| part.id).filter(|id| !found.contains(id)).collect();
            found.extend(parts);
            at += 1;
        }
        found
    }

    /// A device as it is now.
    pub(super) fn put_device(&mut self, device: Device) {
        self.devices.insert(device.id, device);
    }

    /// Removes a device and what belongs to it; returns its groups.
    pub(super) fn remove_device(&mut self, id: DeviceId) -> Vec<GroupId> {
        self.devices.remove(&id);
        let groups: Vec<_> =
            self.groups.values().filter(|group| group.config.device == id).map(|group| group.id).collect();
        for group in &groups {
            self.remove_group(*group);
        }
        groups
    }

    /// A group as it is now.
    pub(super) fn put_group(&mut self, group: Group) {
        self.groups.insert(group.id, group);
    }

    /// A group less, with its variables.
    pub(super) fn remove_group(&mut self, id: GroupId) {
        self.groups.remove(&id);
        self.variables.remove(&id);
        self.homes.retain(|_, home| *home != id);
    }

    /// More variables.
    pub(super) fn add_variables(&mut self, variables: Vec<Variable>) {
        for variable in variables {
            self.homes.insert(variable.id, variable.group);
            self.variables.entry(variable.group).or_default().push(variable);
        }
        for variables in self.variables.values_mut() {
            sort(variables);
        }
    }

    /// A variable as it is now.
    pub(super) fn put_variable(&mut self, variable: &Variable) {
        let Some(variables) = self.variables.get_mut(&variable.group) else { return };
        for there in variables.iter_mut().filter(|there| there.id == variable.id) {
            *there = variable.clone();
        }
        sort(variables);
    }

    /// Variables less.
    pub(super) fn remove_variables(&mut self, ids: &[VariableId]) {
        let gone: BTreeSet<_> = ids.iter().copied().collect();
        let homes: BTreeSet<_> = ids.iter().filter_map(|id| self.homes.remove(id)).collect();
        for group in homes {
            if let Some(variables) = self.variables.get_mut(&group) {
                variables.retain(|variable| !gone.contains(&variable.id));
            }
        }
    }

    /// How many variables there are.
    pub(super) fn count(&self) -> usize {
        self.homes.len()
    }
}

fn sort(variables: &mut [Variable]) {
    variables.sort_by_key(|variable| (variable.config.order, variable.id));
}
