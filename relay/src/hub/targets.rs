//! Targets as viewers see them.

use std::collections::{BTreeMap, VecDeque};

use cipdeck_shared::api::TargetStatus;
use cipdeck_shared::config::Target;
use cipdeck_shared::engine::TargetView;

use super::MAX_REMOVED;
use crate::wall_clock;

/// The newest state of every target, and when it changed.
#[derive(Debug, Default)]
pub(super) struct Targets {
    all: BTreeMap<String, (u64, TargetStatus)>,
    removed: VecDeque<(u64, String)>,
}

impl Targets {
    pub(super) fn put(&mut self, target: &Target, view: &TargetView, version: u64) {
        let status = TargetStatus::new(target, view, Some(wall_clock::now()), 0);
        let before = self.all.get(&status.target).map(|(_, before)| (before.state, before.since.clone()));
        // Since when it is in this state, not since it changed last.
        let since = before.filter(|(state, _)| *state == status.state).and_then(|(_, since)| since);
        let since = since.or_else(|| status.since.clone());
        self.all.insert(status.target.clone(), (version, TargetStatus { since, ..status }));
    }

    /// Returns the version from which viewers that are behind need a snapshot, if one was reached.
    pub(super) fn remove(&mut self, target: &Target, version: u64) -> Option<u64> {
        let target = target.to_string();
        self.all.remove(&target)?;
        self.removed.push_back((version, target));
        if self.removed.len() <= MAX_REMOVED {
            return None;
        }
        self.removed.pop_front().map(|(version, _)| version)
    }

    pub(super) fn since(&self, target: &Target) -> Option<String> {
        self.all.get(&target.to_string()).and_then(|(_, status)| status.since.clone())
    }

    pub(super) fn all(&self) -> Vec<TargetStatus> {
        self.all.values().map(|(_, status)| status.clone()).collect()
    }

    /// What is newer than `seen`: changed, and gone.
    pub(super) fn newer(&self, seen: u64) -> (Vec<TargetStatus>, Vec<String>) {
        let changed = self.all.values().filter(|(version, _)| *version > seen);
        let gone = self.removed.iter().filter(|(version, target)| {
            // A target that is back again is told as changed.
            *version > seen && !self.all.contains_key(target)
        });
        (
            changed.map(|(_, status)| status.clone()).collect(),
            gone.map(|(_, target)| target.clone()).collect(),
        )
    }
}
