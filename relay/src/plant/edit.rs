//! Changes: checked, stored, then told to tasks and viewers.

use cipdeck_shared::api::{CopyDevice, NewVariables, plant_findings};
use cipdeck_shared::config::{
    Device, DeviceConfig, DeviceId, Group, GroupConfig, GroupId, Variable, VariableId,
};
use cipdeck_shared::plan::plant::{self, PlantFinding};
use cipdeck_shared::tag::Types;

use super::entries::Entries;
use super::{Inner, Plant};
use crate::actor::Actor;
use crate::audit::{Event, Record};
use crate::error::ApiError;
use crate::permit::record;
use crate::runner::lock;
use crate::store::Fresh;

/// Devices of a relay. Our own limit.
const MAX_DEVICES: usize = 256;

/// Groups of a device. Our own limit.
const MAX_GROUPS: usize = 64;

impl Plant {
    /// A new device without groups.
    pub(crate) async fn add_device(&self, actor: &Actor, config: DeviceConfig) -> Result<Device, ApiError> {
        plant::device(&config).map_err(refused)?;
        let actor = actor.clone();
        self.edit(|inner| async move { inner.add_device(&actor, config, Vec::new()).await }).await
    }

    /// The same device elsewhere: its groups, which are off, and their variables.
    pub(crate) async fn copy_device(
        &self,
        actor: &Actor,
        id: DeviceId,
        copy: CopyDevice,
    ) -> Result<Device, ApiError> {
        let actor = actor.clone();
        self.edit(|inner| async move {
            let (config, groups) = {
                let entries = lock(&inner.entries);
                let CopyDevice { name, path } = copy;
                let config = DeviceConfig { name, path, ..entries.device(id)?.config.clone() };
                let copied = |group: &&Group| {
                    let config = GroupConfig { on: false, ..group.config.clone() };
                    (config, fresh(entries.variables_of(group.id)))
                };
                (config, entries.groups_of(id).iter().map(copied).collect())
            };
            plant::device(&config).map_err(refused)?;
            inner.add_device(&actor, config, groups).await
        })
        .await
    }

    /// A device as it is from now on. Its revision is the one that was seen.
    pub(crate) async fn replace_device(
        &self,
        actor: &Actor,
        id: DeviceId,
        device: Device,
    ) -> Result<Device, ApiError> {
        same(&id, &device.id)?;
        let actor = actor.clone();
        self.edit(|inner| async move {
            fresh_enough(lock(&inner.entries).device(id)?.revision, device.revision, &id)?;
            plant::device(&device.config).map_err(refused)?;
            let device = Device { revision: device.revision + 1, ..device };
            inner.store.put_device(device.clone()).await?;
            lock(&inner.entries).put_device(device.clone());
            inner.note(&of_device(&actor, "changed", &device));
            inner.told(id, None);
            Ok(device)
        })
        .await
    }

    /// Forgets a device and what belongs to it.
    pub(crate) async fn remove_device(
        &self,
        actor: &Actor,
        id: DeviceId,
        revision: u64,
    ) -> Result<(), ApiError> {
        let actor = actor.clone();
        self.edit(|inner| async move {
            let device = lock(&inner.entries).device(id)?.clone();
            fresh_enough(device.revision, revision, &id)?;
            inner.store.remove_device(id).await?;
            let groups = lock(&inner.entries).remove_device(id);
            inner.forget(id);
            for group in groups {
                inner.hub.remove_group(group);
            }
            inner.note(&of_device(&actor, "deleted", &device));
            inner.hub.tree_changed();
            Ok(())
        })
        .await
    }

    /// A new group.
    pub(crate) async fn add_group(&self, actor: &Actor, config: GroupConfig) -> Result<Group, ApiError> {
        plant::group(&config).map_err(refused)?;
        let actor = actor.clone();
        self.edit(|inner| async move {
            {
                let entries = lock(&inner.entries);
                entries.device(config.device)?;
                at_most(MAX_GROUPS, entries.groups_of(config.device).len(), "groups of one device")?;
            }
            let group = inner.store.add_group(config).await?;
            lock(&inner.entries).put_group(group.clone());
            inner.note(&of_group(&actor, "created", &group));
            inner.told(group.config.device, None);
            Ok(group)
        })
        .await
    }

    /// A group as it is from now on.
    pub(crate) async fn replace_group(
        &self,
        actor: &Actor,
        id: GroupId,
        group: Group,
    ) -> Result<Group, ApiError> {
        same(&id, &group.id)?;
        let actor = actor.clone();
        self.edit(|inner| async move {
            {
                let entries = lock(&inner.entries);
                let there = entries.group(id)?;
                fresh_enough(there.revision, group.revision, &id)?;
                stays(&there.config.device, &group.config.device, "a group stays with its device")?;
            }
            plant::group(&group.config).map_err(refused)?;
            let group = Group { revision: group.revision + 1, ..group };
            inner.store.put_group(group.clone()).await?;
            lock(&inner.entries).put_group(group.clone());
            inner.note(&of_group(&actor, "changed", &group));
            inner.told(group.config.device, None);
            Ok(group)
        })
        .await
    }

    /// Forgets a group and its variables.
    pub(crate) async fn remove_group(
        &self,
        actor: &Actor,
        id: GroupId,
        revision: u64,
    ) -> Result<(), ApiError> {
        let actor = actor.clone();
        self.edit(|inner| async move {
            let group = lock(&inner.entries).group(id)?.clone();
            fresh_enough(group.revision, revision, &id)?;
            inner.store.remove_group(id).await?;
            lock(&inner.entries).remove_group(id);
            inner.hub.remove_group(id);
            inner.note(&of_group(&actor, "deleted", &group));
            inner.told(group.config.device, None);
            Ok(())
        })
        .await
    }

    /// New variables: all of them or none.
    pub(crate) async fn add_variables(
        &self,
        actor: &Actor,
        id: GroupId,
        new: NewVariables,
    ) -> Result<Vec<Variable>, ApiError> {
        let actor = actor.clone();
        self.edit(|inner| async move {
            let accepted = {
                let entries = lock(&inner.entries);
                let types = entries.types(id)?;
                let there = entries.variables_of(id);
                plant::added(there, &new.variables, &types, |place| format!("variables[{place}]"))
            };
            inner.add_variables(&actor, id, accepted.map_err(refused)?).await
        })
        .await
    }

    /// The variables of a file: all of them or none.
    pub(crate) async fn add_csv(
        &self,
        actor: &Actor,
        id: GroupId,
        text: String,
    ) -> Result<Vec<Variable>, ApiError> {
        let actor = actor.clone();
        self.edit(|inner| async move {
            let accepted = {
                let entries = lock(&inner.entries);
                let types = entries.types(id)?;
                let (lines, new): (Vec<_>, Vec<_>) =
                    plant::read_csv(&text).map_err(refused)?.into_iter().unzip();
                let line = |place: usize| format!("line {}", lines.get(place).copied().unwrap_or_default());
                plant::added(entries.variables_of(id), &new, &types, line)
            };
            inner.add_variables(&actor, id, accepted.map_err(refused)?).await
        })
        .await
    }

    /// A variable as it is from now on.
    pub(crate) async fn replace_variable(
        &self,
        actor: &Actor,
        id: VariableId,
        variable: Variable,
    ) -> Result<Variable, ApiError> {
        same(&id, &variable.id)?;
        let actor = actor.clone();
        self.edit(|inner| async move {
            let (config, device) = {
                let entries = lock(&inner.entries);
                let there = entries.variable(id)?;
                fresh_enough(there.revision, variable.revision, &id)?;
                stays(&there.group, &variable.group, "a variable stays in its group")?;
                let (all, types) = (entries.variables_of(there.group), entries.types(there.group)?);
                let config = plant::changed(id, &variable.config, all, &types).map_err(refused)?;
                (config, entries.group(there.group)?.config.device)
            };
            let variable = Variable { revision: variable.revision + 1, config, ..variable };
            inner.store.put_variable(variable.clone()).await?;
            lock(&inner.entries).put_variable(&variable);
            inner.note(&of_variable(&actor, "changed", &variable));
            inner.told(device, Some(variable.group));
            Ok(variable)
        })
        .await
    }

    /// Forgets a variable and its parts.
    pub(crate) async fn remove_variable(
        &self,
        actor: &Actor,
        id: VariableId,
        revision: u64,
    ) -> Result<(), ApiError> {
        let actor = actor.clone();
        self.edit(|inner| async move {
            let (variable, device, ids) = {
                let entries = lock(&inner.entries);
                let variable = entries.variable(id)?.clone();
                fresh_enough(variable.revision, revision, &id)?;
                let device = entries.group(variable.group)?.config.device;
                (variable, device, entries.with_parts(id))
            };
            inner.store.remove_variables(ids.clone()).await?;
            lock(&inner.entries).remove_variables(&ids);
            inner.note(&of_variable(&actor, "deleted", &variable).with("parts", ids.len() - 1));
            inner.told(device, Some(variable.group));
            Ok(())
        })
        .await
    }
}

impl Inner {
    async fn add_device(
        &self,
        actor: &Actor,
        config: DeviceConfig,
        groups: Vec<(GroupConfig, Vec<Fresh>)>,
    ) -> Result<Device, ApiError> {
        at_most(MAX_DEVICES, lock(&self.entries).devices().count(), "devices")?;
        let made = self.store.add_device(config, groups).await?;
        let device = made.devices.first().cloned();
        let device = device.ok_or_else(|| ApiError::Internal("no device was stored".to_owned()))?;
        lock(&self.entries).add(made);
        self.note(&of_device(actor, "created", &device));
        self.told(device.id, None);
        Ok(device)
    }

    async fn add_variables(
        &self,
        actor: &Actor,
        group: GroupId,
        accepted: Vec<plant::Accepted>,
    ) -> Result<Vec<Variable>, ApiError> {
        let device = lock(&self.entries).group(group)?.config.device;
        let fresh = accepted
            .into_iter()
            .map(|accepted| Fresh { config: accepted.config, parent: accepted.parent })
            .collect();
        let variables = self.store.add_variables(group, fresh).await?;
        lock(&self.entries).add_variables(variables.clone());
        let record = changed(actor, "variables", "created").with("group", group.to_string());
        self.note(&record.with("count", variables.len()));
        self.told(device, Some(group));
        Ok(variables)
    }

    /// Tasks and viewers hear of a change.
    fn told(&self, device: DeviceId, group: Option<GroupId>) {
        self.apply(device, group);
        if group.is_none() {
            self.hub.tree_changed();
        }
    }

    fn note(&self, record: &Record) {
        self.policy.note(record);
    }
}

impl Entries {
    /// Named structures that the variables of a group may be.
    pub(super) fn types(&self, group: GroupId) -> Result<Types, ApiError> {
        let device = self.device(self.group(group)?.config.device)?;
        Ok(plant::device(&device.config).map(|plan| plan.types).unwrap_or_default())
    }
}

/// Variables as they can be stored again under other ids.
fn fresh(variables: &[Variable]) -> Vec<Fresh> {
    // Ids count up, and a parent may have become one later: parents first.
    let mut ordered: Vec<&Variable> = Vec::with_capacity(variables.len());
    let mut open: Vec<&Variable> = variables.iter().collect();
    while !open.is_empty() {
        let is_there = |id| ordered.iter().any(|above| above.id == id);
        let (ready, waiting): (Vec<_>, Vec<_>) =
            open.iter().copied().partition(|variable| variable.config.parent.is_none_or(is_there));
        if ready.is_empty() {
            break;
        }
        ordered.extend(ready);
        open = waiting;
    }
    let place = |id: VariableId| ordered.iter().position(|above| above.id == id);
    let fresh = |variable: &&Variable| {
        let mut config = variable.config.clone();
        let parent = config.parent.take().and_then(place);
        Fresh { config, parent }
    };
    ordered.iter().map(fresh).collect()
}

fn refused(findings: impl AsRef<[PlantFinding]>) -> ApiError {
    ApiError::Findings(plant_findings(findings.as_ref()))
}

fn same<T: PartialEq + std::fmt::Display>(address: &T, body: &T) -> Result<(), ApiError> {
    let about = || ApiError::Unreadable(format!("the body is about {body}, not about {address}"));
    if address == body { Ok(()) } else { Err(about()) }
}

fn stays<T: PartialEq>(there: &T, wanted: &T, words: &str) -> Result<(), ApiError> {
    if there == wanted { Ok(()) } else { Err(ApiError::Unreadable(words.to_owned())) }
}

fn fresh_enough(there: u64, seen: u64, id: &impl std::fmt::Display) -> Result<(), ApiError> {
    let outdated = || ApiError::Outdated { what: id.to_string(), revision: there };
    if there == seen { Ok(()) } else { Err(outdated()) }
}

fn at_most(max: usize, there: usize, of_what: &str) -> Result<(), ApiError> {
    if there < max {
        Ok(())
    } else {
        Err(ApiError::Conflict(format!("there are {max} {of_what}, and no more fit")))
    }
}

fn changed(actor: &Actor, what: &str, how: &str) -> Record {
    record(Event::PlantChanged, actor).with("what", what).with("how", how)
}

fn of_device(actor: &Actor, how: &str, device: &Device) -> Record {
    changed(actor, "device", how)
        .with("id", device.id.to_string())
        .with("name", device.config.name.clone())
        .with("revision", device.revision)
        .with("target", device.config.path.clone())
}

fn of_group(actor: &Actor, how: &str, group: &Group) -> Record {
    changed(actor, "group", how)
        .with("id", group.id.to_string())
        .with("name", group.config.name.clone())
        .with("revision", group.revision)
        .with("on", group.config.on)
        .with("period_ms", group.config.period_ms)
}

fn of_variable(actor: &Actor, how: &str, variable: &Variable) -> Record {
    changed(actor, "variable", how)
        .with("id", variable.id.to_string())
        .with("name", variable.config.name.clone())
        .with("revision", variable.revision)
        .with("address", variable.config.address.clone())
        .with("writable", variable.config.writable)
}
