//! What was changed, and what has become of it.

use cipdeck_shared::api::ProjectPart;
use cipdeck_shared::config::{BlockId, DeviceId, GroupId};

/// What a change is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Touched {
    Block(BlockId),
    /// Itself, and groups that it has got.
    Device(DeviceId),
    /// With its variables.
    Group(GroupId),
}

/// What has become of everything.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Outcome {
    pub(crate) parts: Vec<ProjectPart>,
    /// Everything that was changed, created or removed.
    pub(crate) touched: Vec<Touched>,
}
