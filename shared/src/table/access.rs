//! Does a request read or write? The page asks before a write, so doubt counts as a write.

use crate::wire::ServiceCode;

use super::{Confidence, service_row};

/// What a request does to the device, judged by service and class.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Access {
    /// Known to change nothing.
    Read,
    /// Known to change something: a value, a state, a counter.
    Write,
    /// Not known, or it carries other requests that nobody has looked at.
    Unknown,
}

impl Access {
    /// Whether to ask before sending. [`Access::Unknown`] counts as a write.
    pub const fn may_write(self) -> bool {
        !matches!(self, Self::Read)
    }

    /// What several requests do together: a write, if one of them is known to write; a read, only if all of them are.
    /// Nothing at all is unknown.
    pub fn of_all(all: impl IntoIterator<Item = Self>) -> Self {
        let worst = |a, b| match (a, b) {
            (Self::Write, _) | (_, Self::Write) => Self::Write,
            (Self::Unknown, _) | (_, Self::Unknown) => Self::Unknown,
            (Self::Read, Self::Read) => Self::Read,
        };
        all.into_iter().reduce(worst).unwrap_or(Self::Unknown)
    }
}

/// Reads are only those that a source confirms. Judges one service by its number and class; a request that carries
/// others is looked into by [`plan::effects`](crate::plan::effects).
pub fn classify(service: ServiceCode, class: u16) -> Access {
    let Some(row) = service_row(class, service) else { return Access::Unknown };
    match row.access {
        "read" if row.entry().confidence == Confidence::Confirmed => Access::Read,
        "write" => Access::Write,
        _ => Access::Unknown,
    }
}
