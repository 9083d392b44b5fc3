//! Devices, groups and variables: stored, polled by one task for each device however many people look, and written
//! with a ticket.

mod browse;
mod edit;
mod entries;
mod health;
mod hub;
mod point;
mod poll;
mod work;
mod write;

use std::collections::{BTreeMap, HashMap};
use std::future::Future;
use std::sync::{Arc, Mutex};

use cipdeck_shared::api::{DeviceStatus, GroupValues, Tree, WriteEntry};
use cipdeck_shared::config::{Device, DeviceId, GroupId, Variable};
use cipdeck_shared::plan::plant;
use tokio::sync::watch;
use tokio_util::sync::CancellationToken;
use tokio_util::task::TaskTracker;

use self::browse::Browsing;
pub(crate) use self::edit::{MAX_DEVICES, MAX_GROUPS};
use self::entries::Entries;
pub(crate) use self::hub::{Hub, Seen};
use self::poll::Work;
use self::write::Pending;
use crate::error::ApiError;
use crate::permit::Policy;
use crate::runner::{Clock, Runner, lock};
use crate::store::{Store, StoreError};

/// All devices. Clones share them.
#[derive(Clone, Debug)]
pub(crate) struct Plant(Arc<Inner>);

#[derive(Debug)]
struct Inner {
    store: Store,
    runner: Runner,
    policy: Arc<Policy>,
    hub: Arc<Hub>,
    entries: Mutex<Entries>,
    /// Held from the store to the viewers, so that everybody sees changes in the order in which they were stored.
    edit: tokio::sync::Mutex<()>,
    /// What the task of each device has to do.
    polls: Mutex<BTreeMap<DeviceId, watch::Sender<Arc<Work>>>>,
    /// Writes that have been offered, by their ticket.
    pending: Mutex<HashMap<String, Pending>>,
    /// What devices are asked for, or were.
    browses: Mutex<BTreeMap<DeviceId, Arc<Browsing>>>,
    clock: Clock,
    tasks: TaskTracker,
    stop: CancellationToken,
}

impl Plant {
    /// Loads what is stored, and begins to poll.
    pub(crate) async fn open(store: Store, runner: Runner, policy: Arc<Policy>) -> Result<Self, StoreError> {
        let mut entries = Entries::default();
        entries.add(store.load_plant().await?);
        let devices: Vec<_> = entries.devices().map(|device| device.id).collect();
        tracing::info!(devices = devices.len(), variables = entries.count(), "loaded");
        let inner = Inner {
            store,
            runner,
            policy,
            hub: Arc::default(),
            entries: Mutex::new(entries),
            edit: tokio::sync::Mutex::default(),
            polls: Mutex::default(),
            pending: Mutex::default(),
            browses: Mutex::default(),
            clock: Clock::start(),
            tasks: TaskTracker::new(),
            stop: CancellationToken::new(),
        };
        let plant = Self(Arc::new(inner));
        for device in devices {
            plant.0.apply(device, None);
        }
        Ok(plant)
    }

    /// What viewers look at.
    pub(crate) fn hub(&self) -> &Hub {
        &self.0.hub
    }

    /// Everything but the variables.
    pub(crate) fn tree(&self) -> Tree {
        lock(&self.0.entries).tree()
    }

    /// A device.
    pub(crate) fn device(&self, id: DeviceId) -> Result<Device, ApiError> {
        lock(&self.0.entries).device(id).cloned()
    }

    /// How a device is.
    pub(crate) fn status(&self, id: DeviceId) -> Result<DeviceStatus, ApiError> {
        self.device(id)?;
        // Each device has one from its beginning on.
        self.0.hub.status(id).ok_or_else(|| ApiError::Internal(format!("{id} has no status")))
    }

    /// The variables of a group, in their order.
    pub(crate) fn variables(&self, group: GroupId) -> Result<Vec<Variable>, ApiError> {
        let entries = lock(&self.0.entries);
        entries.group(group)?;
        Ok(entries.variables_of(group).to_vec())
    }

    /// What the variables are called as a file, and what to call the file.
    pub(crate) fn csv(&self, group: GroupId) -> Result<(String, String), ApiError> {
        let entries = lock(&self.0.entries);
        entries.group(group)?;
        Ok((format!("{group}.csv"), plant::write_csv(entries.variables_of(group))))
    }

    /// The newest values of a group.
    pub(crate) fn values(&self, group: GroupId) -> Result<GroupValues, ApiError> {
        lock(&self.0.entries).group(group)?;
        Ok(self.0.hub.values(group).unwrap_or(GroupValues { group, values: Vec::new() }))
    }

    /// What was written to a device, the newest first.
    pub(crate) async fn writes(&self, device: DeviceId) -> Result<Vec<WriteEntry>, ApiError> {
        self.device(device)?;
        Ok(self.0.store.writes(device).await?)
    }

    /// Ends polling.
    pub(crate) async fn stop(&self) {
        self.0.stop.cancel();
        self.0.tasks.close();
        self.0.tasks.wait().await;
    }

    /// A change runs to its end even when nobody waits for it any more: the database and the tasks must agree.
    async fn edit<T, F>(&self, change: impl FnOnce(Arc<Inner>) -> F) -> Result<T, ApiError>
    where
        T: Send + 'static,
        F: Future<Output = Result<T, ApiError>> + Send + 'static,
    {
        let (inner, change) = (Arc::clone(&self.0), change(Arc::clone(&self.0)));
        let edit = tokio::spawn(async move {
            let _one_at_a_time = inner.edit.lock().await;
            change.await
        });
        edit.await.unwrap_or_else(|error| Err(ApiError::Internal(error.to_string())))
    }
}
