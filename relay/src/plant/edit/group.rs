//! Groups: added, changed, turned on and off, forgotten.

use cipdeck_shared::config::{Group, GroupConfig, GroupId};
use cipdeck_shared::plan::plant;

use super::{at_most, changed, fresh_enough, refused, same, stays};
use crate::actor::Actor;
use crate::audit::Record;
use crate::error::ApiError;
use crate::plant::Plant;
use crate::runner::lock;

/// Groups of a device. Our own limit.
pub(crate) const MAX_GROUPS: usize = 64;

impl Plant {
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
}

fn of_group(actor: &Actor, how: &str, group: &Group) -> Record {
    changed(actor, "group", how)
        .with("id", group.id.to_string())
        .with("name", group.config.name.clone())
        .with("revision", group.revision)
        .with("on", group.config.on)
        .with("period_ms", group.config.period_ms)
}
