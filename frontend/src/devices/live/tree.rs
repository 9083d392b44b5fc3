//! Devices and groups.

use cipdeck_shared::config::{Device, DeviceId, Group, GroupId};

/// Devices and groups, in the order in which they are shown.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tree {
    /// By site and name.
    pub devices: Vec<Device>,
    /// By their order.
    pub groups: Vec<Group>,
}

impl Tree {
    /// In their order.
    pub(super) fn sorted(mut devices: Vec<Device>, mut groups: Vec<Group>) -> Self {
        let of = |device: &Device| (device.config.site.clone(), device.config.name.clone(), device.id);
        devices.sort_by_key(of);
        groups.sort_by_key(|group| (group.config.order, group.id));
        Self { devices, groups }
    }

    /// A device.
    pub fn device(&self, id: DeviceId) -> Option<&Device> {
        self.devices.iter().find(|device| device.id == id)
    }

    /// A group.
    pub fn group(&self, id: GroupId) -> Option<&Group> {
        self.groups.iter().find(|group| group.id == id)
    }

    /// The groups of a device.
    pub fn groups_of(&self, id: DeviceId) -> impl Iterator<Item = &Group> {
        self.groups.iter().filter(move |group| group.config.device == id)
    }
}
