//! Devices and groups of a project that was taken in.

use cipdeck_shared::api::{ProjectChange, ProjectPart};
use cipdeck_shared::config::{DeviceId, GroupId};
use tokio::sync::MutexGuard;

use super::changed;
use crate::actor::Actor;
use crate::error::ApiError;
use crate::plant::entries::Entries;
use crate::plant::{Inner, Plant};
use crate::project::Touched;
use crate::runner::lock;

impl Plant {
    /// As long as this is held nobody changes a device.
    pub(crate) async fn hold(&self) -> MutexGuard<'_, ()> {
        self.0.edit.lock().await
    }

    /// Devices, groups and variables are stored, or gone, that nobody has heard of yet.
    pub(crate) async fn take_over(
        &self,
        actor: &Actor,
        touched: &[Touched],
        parts: &[ProjectPart],
    ) -> Result<(), ApiError> {
        let mut entries = Entries::default();
        entries.add(self.0.store.load_plant().await?);
        let before = std::mem::replace(&mut *lock(&self.0.entries), entries);
        for touched in touched {
            match touched {
                Touched::Block(_) => {}
                Touched::Device(id) => {
                    self.0.note_part(actor, "device", &id.to_string(), parts);
                    self.0.take_over_device(*id, &before);
                }
                Touched::Group(id) => {
                    self.0.note_part(actor, "group", &id.to_string(), parts);
                    self.0.take_over_group(*id, &before);
                }
            }
        }
        self.0.hub.tree_changed();
        Ok(())
    }
}

impl Inner {
    fn take_over_device(&self, id: DeviceId, before: &Entries) {
        if lock(&self.entries).device(id).is_ok() {
            return self.apply(id, None);
        }
        self.forget(id);
        for group in before.groups_of(id) {
            self.hub.remove_group(group.id);
        }
    }

    fn take_over_group(&self, id: GroupId, before: &Entries) {
        let there = lock(&self.entries).group(id).map(|group| group.config.device).ok();
        if there.is_none() {
            self.hub.remove_group(id);
        }
        let device = there.or_else(|| before.group(id).map(|group| group.config.device).ok());
        if let Some(device) = device {
            self.apply(device, there.is_some().then_some(id));
        }
    }

    fn note_part(&self, actor: &Actor, what: &str, id: &str, parts: &[ProjectPart]) {
        let Some(part) = parts.iter().find(|part| part.id.as_deref() == Some(id)) else { return };
        let how = match part.how {
            ProjectChange::Created => "created",
            ProjectChange::Removed => "deleted",
            _ => "changed",
        };
        let record = changed(actor, what, how).with("id", id).with("name", part.name.clone());
        self.note(&record.with_some("detail", part.detail.clone()));
    }
}
