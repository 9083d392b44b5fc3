//! What every block looks like now. State is kept, changes may be dropped: a viewer asks for what is newer than the
//! last thing that it has seen, so a slow one costs no memory and gets the newest state.

mod changes;
mod row;
mod targets;

use std::collections::{BTreeMap, VecDeque};
use std::sync::Mutex;

use cipdeck_shared::api::{BlockStatus, ExchangeView};
use cipdeck_shared::config::{Block, BlockId, Target};
use cipdeck_shared::engine::{BlockView, Exchange, TargetView};
use tokio::sync::watch;

pub(crate) use self::changes::{Cursor, Update};
use self::row::Row;
use self::targets::Targets;
use crate::capture::Carried;
use crate::history::Recorder;
use crate::runner::{Observer, Trace, lock};
use crate::wall_clock;

/// The newest state of all blocks.
#[derive(Debug)]
pub(crate) struct Hub {
    latest: Mutex<Latest>,
    version: watch::Sender<u64>,
    recorder: Recorder,
}

/// Counts up with every change. Each row remembers when it changed last, and `order` finds the newest ones.
#[derive(Debug, Default)]
struct Latest {
    version: u64,
    rows: BTreeMap<BlockId, Row>,
    order: BTreeMap<u64, BlockId>,
    removed: VecDeque<(u64, BlockId)>,
    targets: Targets,
    /// Viewers that have seen less than this need a snapshot: removals have been forgotten.
    forgotten: u64,
}

/// Removals that are remembered for viewers that are behind.
const MAX_REMOVED: usize = 1_024;

impl Hub {
    /// Without blocks. What ends is handed over to the history.
    pub(crate) fn recording(recorder: Recorder) -> Self {
        Self { latest: Mutex::default(), version: watch::Sender::new(0), recorder }
    }

    /// A block is new or has changed.
    pub(crate) fn put(&self, block: Block) {
        self.change(|latest| {
            let (id, version) = (block.id, latest.next(block.id));
            match latest.rows.get_mut(&id) {
                Some(row) => row.replace(block, version),
                None => drop(latest.rows.insert(id, Row::new(block, version))),
            }
        });
    }

    /// A block is gone.
    pub(crate) fn remove(&self, id: BlockId) {
        self.change(|latest| {
            let Some(row) = latest.rows.remove(&id) else { return };
            latest.order.remove(&row.version);
            latest.version += 1;
            latest.removed.push_back((latest.version, id));
            if latest.removed.len() > MAX_REMOVED
                && let Some((version, _)) = latest.removed.pop_front()
            {
                latest.forgotten = version;
            }
        });
    }

    /// All blocks, by id.
    pub(crate) fn blocks(&self) -> Vec<Block> {
        lock(&self.latest).rows.values().map(|row| row.block.clone()).collect()
    }

    /// One block.
    pub(crate) fn block(&self, id: BlockId) -> Option<Block> {
        lock(&self.latest).rows.get(&id).map(|row| row.block.clone())
    }

    /// How many blocks there are.
    pub(crate) fn len(&self) -> usize {
        lock(&self.latest).rows.len()
    }

    /// The status of a block that looks like this now.
    pub(crate) fn status(&self, id: BlockId, view: &BlockView) -> Option<BlockStatus> {
        lock(&self.latest).rows.get(&id).map(|row| row.with(id, view))
    }

    /// The last exchanges of a block, the newest last.
    pub(crate) fn exchanges(&self, id: BlockId) -> Option<Vec<ExchangeView>> {
        lock(&self.latest).rows.get(&id).map(Row::exchanges)
    }

    /// The frames of the last exchanges of a block, the newest last.
    pub(crate) fn frames(&self, id: BlockId) -> Option<Vec<Carried>> {
        lock(&self.latest).rows.get(&id).map(Row::frames)
    }

    /// Since when a target is in its state.
    pub(crate) fn target_since(&self, target: &Target) -> Option<String> {
        lock(&self.latest).targets.since(target)
    }

    /// Changes whenever something has changed.
    pub(crate) fn watch(&self) -> watch::Receiver<u64> {
        self.version.subscribe()
    }

    /// What a viewer has not seen yet; `None` when it has seen everything.
    pub(crate) fn update(&self, cursor: &mut Cursor) -> Option<Update> {
        lock(&self.latest).update(cursor)
    }

    fn change(&self, call: impl FnOnce(&mut Latest)) {
        let mut latest = lock(&self.latest);
        call(&mut latest);
        let version = latest.version;
        drop(latest);
        // Messages that are nobody's block, as those of polls, wake nobody.
        self.version.send_if_modified(|told| std::mem::replace(told, version) != version);
    }
}

impl Latest {
    /// A new version for a row: it becomes the newest.
    fn next(&mut self, id: BlockId) -> u64 {
        self.version += 1;
        if let Some(row) = self.rows.get(&id) {
            self.order.remove(&row.version);
        }
        self.order.insert(self.version, id);
        self.version
    }
}

impl Observer for Hub {
    fn watches(&self) -> bool {
        true
    }

    fn changed(&self, block: BlockId, view: &BlockView) {
        self.change(|latest| {
            if latest.rows.contains_key(&block) {
                let version = latest.next(block);
                if let Some(row) = latest.rows.get_mut(&block) {
                    row.changed(view, version, wall_clock::now());
                }
            }
        });
    }

    fn finished(
        &self,
        block: BlockId,
        view: &BlockView,
        exchange: &Exchange,
        trace: Option<Trace>,
    ) -> Option<BlockStatus> {
        let mut status = None;
        self.change(|latest| {
            if latest.rows.contains_key(&block) {
                let version = latest.next(block);
                if let Some(row) = latest.rows.get_mut(&block) {
                    row.finished(view, exchange.clone(), trace, version);
                    status = Some(row.with(block, view));
                }
            }
        });
        // Reads that belong to a write are nobody's block.
        if status.is_some() {
            self.recorder.record(block, view, exchange);
        }
        status
    }

    fn target(&self, target: &Target, view: Option<&TargetView>) {
        self.change(|latest| {
            latest.version += 1;
            let forgotten = match view {
                Some(view) => {
                    latest.targets.put(target, view, latest.version);
                    None
                }
                None => latest.targets.remove(target, latest.version),
            };
            latest.forgotten = latest.forgotten.max(forgotten.unwrap_or(0));
        });
    }
}

#[cfg(test)]
mod tests;
