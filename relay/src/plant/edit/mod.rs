//! Changes: checked, stored, then told to tasks and viewers.

mod device;
mod group;
mod project;
mod variable;

use std::fmt::Display;

use cipdeck_shared::api::plant_findings;
use cipdeck_shared::config::{DeviceId, GroupId};
use cipdeck_shared::plan::plant::{self, PlantFinding};
use cipdeck_shared::tag::Types;

pub(crate) use self::device::MAX_DEVICES;
pub(crate) use self::group::MAX_GROUPS;
use super::Inner;
use super::entries::Entries;
use crate::actor::Actor;
use crate::audit::{Event, Record};
use crate::error::ApiError;
use crate::permit::record;

impl Inner {
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

/// Nothing was stored.
fn refused(findings: impl AsRef<[PlantFinding]>) -> ApiError {
    ApiError::Findings(plant_findings(findings.as_ref()))
}

/// The body is about what the address says.
fn same<T: PartialEq + Display>(address: &T, body: &T) -> Result<(), ApiError> {
    let about = || ApiError::Unreadable(format!("the body is about {body}, not about {address}"));
    if address == body { Ok(()) } else { Err(about()) }
}

/// Something that does not change.
fn stays<T: PartialEq>(there: &T, wanted: &T, words: &str) -> Result<(), ApiError> {
    if there == wanted { Ok(()) } else { Err(ApiError::Unreadable(words.to_owned())) }
}

/// The revision that was seen is the newest.
fn fresh_enough(there: u64, seen: u64, id: &impl Display) -> Result<(), ApiError> {
    let outdated = || ApiError::Outdated { what: id.to_string(), revision: there };
    if there == seen { Ok(()) } else { Err(outdated()) }
}

/// There is room for one more.
fn at_most(max: usize, there: usize, of_what: &str) -> Result<(), ApiError> {
    if there < max {
        Ok(())
    } else {
        Err(ApiError::Conflict(format!("there are {max} {of_what}, and no more fit")))
    }
}

/// A record of a change.
fn changed(actor: &Actor, what: &str, how: &str) -> Record {
    record(Event::PlantChanged, actor).with("what", what).with("how", how)
}
