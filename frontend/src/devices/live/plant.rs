//! The connection that carries devices: keeps tree, statuses and values up to date.

use std::{cell::RefCell, rc::Rc};

use cipdeck_shared::{
    api::{DeviceStatus, LIVE_PROTOCOL, LiveClientMessage, Tree as Listed},
    config::{DeviceId, GroupId},
};
use yew::Callback;

use super::{heard::Heard, tree::Tree, values::ValueStore};
use crate::{
    net::{Carried, Line},
    store::Shelf,
};

/// A handle to all of it. Clones are the same connection.
pub type Plant = Line<Known>;

/// What is known of the devices.
#[derive(Debug)]
pub struct Known {
    values: ValueStore,
    tree: RefCell<Option<Rc<Tree>>>,
    statuses: RefCell<Shelf<DeviceId, Rc<DeviceStatus>>>,
    /// How often the variables of a group have changed; watched groups only.
    watched: RefCell<Shelf<GroupId, u32>>,
}

impl Line<Known> {
    /// A connection that is not opened yet. `spent` hears how many ms of script each message took.
    pub fn new(values: ValueStore, spent: Callback<f64>) -> Self {
        let (tree, statuses, watched) = (RefCell::default(), RefCell::default(), RefCell::default());
        Self::carrying(Known { values, tree, statuses, watched }, spent)
    }

    /// The newest values.
    pub fn values(&self) -> &ValueStore {
        &self.carried().values
    }

    /// The tree; `None` before the relay has said it.
    pub fn tree(&self) -> Option<Rc<Tree>> {
        self.carried().tree.borrow().clone()
    }

    /// What a device says of itself.
    pub fn status(&self, id: DeviceId) -> Option<Rc<DeviceStatus>> {
        self.carried().statuses.borrow().get(&id).cloned()
    }

    /// Asks for the values of a group.
    pub fn want(&self, group: GroupId) {
        self.carried().watched.borrow_mut().insert(group, 0);
        self.tell_watched();
    }

    /// Nobody looks at a group any more.
    pub fn leave(&self, group: GroupId) {
        self.carried().watched.borrow_mut().remove(&group);
        self.values().forget(group);
        self.tell_watched();
    }

    /// How often the variables of a watched group have changed.
    pub fn edition(&self, group: GroupId) -> u32 {
        self.carried().watched.borrow().get(&group).copied().unwrap_or(0)
    }

    fn tell_watched(&self) {
        let groups = self.carried().watched.borrow().keys().copied().collect();
        // Without a connection it is said after the next hello.
        self.say(&LiveClientMessage::Watch { groups });
    }

    fn take(&self, message: Heard, now_ms: f64) {
        match message {
            Heard::Values(group, values) => return self.values().put(group, values, now_ms),
            Heard::Hello(protocol) => return self.hello(protocol),
            Heard::Access(state) => return self.heard_access(state),
            Heard::Tree(Listed { devices, groups }) => {
                self.carried().tree.replace(Some(Rc::new(Tree::sorted(devices, groups))));
                self.complete();
            }
            Heard::Variables(group) => {
                if let Some(edition) = self.carried().watched.borrow_mut().get_mut(&group) {
                    *edition += 1;
                }
            }
            Heard::Status(devices) => {
                for status in devices {
                    self.carried().statuses.borrow_mut().insert(status.device, Rc::new(status));
                }
            }
        }
        self.wake();
    }

    fn hello(&self, protocol: u32) {
        let is_back = self.was_online();
        if !self.greeted(protocol, LIVE_PROTOCOL) {
            return;
        }
        if is_back {
            // Nobody has told what has changed in between.
            self.carried().watched.borrow_mut().iter_mut().for_each(|(_, edition)| *edition += 1);
        }
        self.tell_watched();
    }
}

impl Carried for Known {
    const PATH: &'static str = "/api/v1/live";

    fn hear(line: &Line<Self>, text: &str, now_ms: f64) {
        if let Some(message) = Heard::read(text) {
            line.take(message, now_ms);
        }
    }

    fn forget(&self) {
        self.tree.take();
        self.statuses.take();
        self.values.clear();
    }
}
