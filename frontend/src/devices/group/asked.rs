//! What somebody wants to do with a group or with one of its variables.

use cipdeck_shared::config::VariableId;

/// One wish.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Asked {
    /// One more variable, perhaps a part of another.
    Add(Option<VariableId>),
    /// The form of a variable.
    Change(VariableId),
    /// Another value.
    Write(VariableId),
    /// Into the trend, or out of it.
    Trace(VariableId),
    /// Many variables at once.
    Paste,
    /// Variables that the device lists.
    Browse,
    /// The form of the group.
    Settings,
    /// The group goes.
    Delete,
    /// A variable goes, and its parts with it.
    Remove(VariableId),
}
