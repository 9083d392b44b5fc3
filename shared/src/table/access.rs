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
}

/// Reads are only those that a source confirms.
pub fn classify(service: ServiceCode, class: u16) -> Access {
    let Some(row) = service_row(class, service) else { return Access::Unknown };
    match row.access {
        "read" if row.entry().confidence == Confidence::Confirmed => Access::Read,
        "write" => Access::Write,
        _ => Access::Unknown,
    }
}
