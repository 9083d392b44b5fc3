//! Devices and groups of a project that was taken in.

use cipdeck_shared::api::ProjectPart;
use tokio::sync::MutexGuard;

use super::changed;
use crate::actor::Actor;
use crate::error::ApiError;
use crate::plant::Plant;
use crate::plant::entries::Entries;
use crate::project::Touched;
use crate::runner::lock;

impl Plant {
    /// As long as this is held nobody changes a device.
    pub(crate) async fn hold(&self) -> MutexGuard<'_, ()> {
        self.0.edit.lock().await
    }

    /// Devices, groups and variables are stored that nobody has heard of yet.
    pub(crate) async fn take_over(
        &self,
        actor: &Actor,
        touched: &[Touched],
        parts: &[ProjectPart],
    ) -> Result<(), ApiError> {
        let mut entries = Entries::default();
        entries.add(self.0.store.load_plant().await?);
        *lock(&self.0.entries) = entries;
        for touched in touched {
            let (device, group, id) = match touched {
                Touched::Block(_) => continue,
                Touched::Device(device) => (*device, None, device.to_string()),
                Touched::Group(group) => {
                    let device = lock(&self.0.entries).group(*group)?.config.device;
                    (device, Some(*group), group.to_string())
                }
            };
            if let Some(part) = parts.iter().find(|part| part.id.as_deref() == Some(&id)) {
                let (what, how) =
                    (if group.is_some() { "group" } else { "device" }, format!("{:?}", part.how));
                let record =
                    changed(actor, what, &how.to_lowercase()).with("id", id).with("name", part.name.clone());
                self.0.note(&record.with_some("detail", part.detail.clone()));
            }
            self.0.apply(device, group);
        }
        self.0.hub.tree_changed();
        Ok(())
    }
}
