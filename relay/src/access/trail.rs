//! What is recorded of all this. Never a secret, and never a name that nobody has: people type passwords there.

use crate::actor::Actor;
use crate::audit::{Audit, Record};

pub(super) use crate::audit::Event;

/// Where it is recorded.
#[derive(Debug)]
pub(super) struct Trail(Audit);

impl Trail {
    pub(super) const fn new(audit: Audit) -> Self {
        Self(audit)
    }

    /// Somebody has done something, with members that depend on the event.
    pub(super) fn note(&self, event: Event, by: &Actor, members: &[(&str, &str)]) {
        self.record(event, by.name(), by.from(), members);
    }

    /// Somebody who is not signed in, or the relay itself.
    pub(super) fn record(&self, event: Event, actor: &str, from: &str, members: &[(&str, &str)]) {
        let record = Record::new(event, actor, from);
        let record = members.iter().fold(record, |record, (key, value)| record.with(key, *value));
        // What cannot be recorded has been logged and stops writes; people are not locked out by a full disk.
        let _ = self.0.append(&record);
    }
}
