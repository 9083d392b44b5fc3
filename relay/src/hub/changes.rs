//! What a viewer has not seen yet.

use std::collections::BTreeMap;
use std::ops::Bound;

use cipdeck_shared::api::{BlockStatus, TargetStatus};
use cipdeck_shared::config::{Block, BlockId};

use super::Latest;

/// How much one viewer has seen.
#[derive(Debug, Default)]
pub(crate) struct Cursor {
    /// Everything up to this version; `None` at the start.
    seen: Option<u64>,
    /// Edges of each block that it has been told about.
    edges: BTreeMap<BlockId, u64>,
}

/// News for one viewer.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Update {
    /// Everything there is, not only what has changed.
    pub(crate) is_snapshot: bool,
    /// New and changed blocks.
    pub(crate) blocks: Vec<Block>,
    /// New statuses, the newest of each block.
    pub(crate) statuses: Vec<BlockStatus>,
    /// Blocks that are gone.
    pub(crate) removed: Vec<BlockId>,
    /// Targets that look different.
    pub(crate) targets: Vec<TargetStatus>,
    /// Targets that no block needs any more.
    pub(crate) targets_removed: Vec<String>,
}

impl Latest {
    pub(super) fn update(&self, cursor: &mut Cursor) -> Option<Update> {
        let seen = cursor.seen.replace(self.version);
        match seen {
            Some(seen) if seen == self.version => None,
            Some(seen) if seen >= self.forgotten => Some(self.changes(seen, cursor)),
            _ => Some(self.snapshot(cursor)),
        }
    }

    fn snapshot(&self, cursor: &mut Cursor) -> Update {
        cursor.edges.clear();
        let mut update = Update { is_snapshot: true, targets: self.targets.all(), ..Update::default() };
        for (id, row) in &self.rows {
            update.blocks.push(row.block.clone());
            let (status, edges) = row.status(None);
            update.statuses.push(status);
            cursor.edges.insert(*id, edges);
        }
        update
    }

    fn changes(&self, seen: u64, cursor: &mut Cursor) -> Update {
        let (targets, targets_removed) = self.targets.newer(seen);
        let mut update = Update { targets, targets_removed, ..Update::default() };
        for (_, id) in self.removed.iter().filter(|(version, _)| *version > seen) {
            cursor.edges.remove(id);
            update.removed.push(*id);
        }
        for id in self.order.range((Bound::Excluded(seen), Bound::Unbounded)).map(|(_, id)| id) {
            let Some(row) = self.rows.get(id) else { continue };
            if row.block_version > seen {
                update.blocks.push(row.block.clone());
            }
            let (status, edges) = row.status(Some(cursor.edges.get(id).copied().unwrap_or(0)));
            update.statuses.push(status);
            cursor.edges.insert(*id, edges);
        }
        update
    }
}
