//! Devices: added, copied, changed, forgotten.

use cipdeck_shared::api::CopyDevice;
use cipdeck_shared::config::{Device, DeviceConfig, DeviceId, Group, GroupConfig, Variable, VariableId};
use cipdeck_shared::plan::plant;

use super::{at_most, changed, fresh_enough, refused, same};
use crate::actor::Actor;
use crate::audit::Record;
use crate::error::ApiError;
use crate::plant::{Inner, Plant};
use crate::runner::lock;
use crate::store::Fresh;

/// Devices of a relay. Our own limit.
pub(crate) const MAX_DEVICES: usize = 256;

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

fn of_device(actor: &Actor, how: &str, device: &Device) -> Record {
    changed(actor, "device", how)
        .with("id", device.id.to_string())
        .with("name", device.config.name.clone())
        .with("revision", device.revision)
        .with("target", device.config.path.clone())
}
