//! The rows of the deck, outside the virtual DOM.
//!
//! Messages from the relay change rows as often as they like; the page hears of it once per animation frame, and
//! only those components hear of it whose row has changed.

use std::{cell::RefCell, fmt, rc::Rc};

use cipdeck_shared::{
    api::{BlockStatus, ExchangeView, Written},
    config::{Block, BlockConfig, BlockId},
    engine::BlockView,
};
use yew::Callback;

use super::{
    deck_id::DeckId,
    shelf::Shelf,
    trace::Trace,
    watch::{Watch, Watchers},
};

/// Asks for one call before the next picture is drawn.
pub type AskForFrame = Rc<dyn Fn(Box<dyn FnOnce()>)>;

/// One entry of the deck.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Which one.
    pub id: DeckId,
    /// The stored revision; 0 for a block that is not stored.
    pub revision: u64,
    /// The stored configuration; of a block that is not stored, its draft.
    pub config: Rc<BlockConfig>,
    /// What its engine said last.
    pub status: Rc<BlockStatus>,
    /// The edges of its newest run.
    pub trace: Rc<Trace>,
    /// The newest exchange that was fetched.
    pub exchange: Option<Rc<ExchangeView>>,
    /// What became of the write that this page has asked for, and after how many runs.
    pub written: Option<(u64, Rc<Written>)>,
}

/// A handle to the rows. Clones are the same store.
#[derive(Clone)]
pub struct RowStore(Rc<Inner>);

struct Inner {
    ask_for_frame: AskForFrame,
    state: RefCell<State>,
    ids_watchers: Watchers,
    frame_watchers: Watchers,
}

#[derive(Default)]
struct State {
    rows: Shelf<DeckId, Rc<Row>>,
    watchers: Shelf<DeckId, Watchers>,
    ids: Rc<[DeckId]>,
    dirty: Shelf<DeckId, ()>,
    ids_changed: bool,
    frame_asked: bool,
}

impl RowStore {
    /// An empty store.
    pub fn new(ask_for_frame: AskForFrame) -> Self {
        Self(Rc::new(Inner {
            ask_for_frame,
            state: RefCell::default(),
            ids_watchers: Watchers::default(),
            frame_watchers: Watchers::default(),
        }))
    }

    /// The row as it is now.
    pub fn row(&self, id: DeckId) -> Option<Rc<Row>> {
        self.0.state.borrow().rows.get(&id).cloned()
    }

    /// All entries, stored ones first. The same `Rc` until an entry comes or goes.
    pub fn ids(&self) -> Rc<[DeckId]> {
        self.0.state.borrow().ids.clone()
    }

    /// Wakes after frames in which this row has changed.
    pub fn watch(&self, id: DeckId, wake: Callback<()>) -> Watch {
        self.0.state.borrow_mut().watchers.or_default(id).watch(wake)
    }

    /// Wakes after frames in which entries came or went.
    pub fn watch_ids(&self, wake: Callback<()>) -> Watch {
        self.0.ids_watchers.watch(wake)
    }

    /// Wakes after every frame in which anything has changed.
    pub fn watch_frames(&self, wake: Callback<()>) -> Watch {
        self.0.frame_watchers.watch(wake)
    }

    /// The relay's whole state: replaces what was known of stored blocks.
    pub fn snapshot(&self, blocks: Vec<Block>, statuses: Vec<BlockStatus>) {
        let is_known = |id: &BlockId| blocks.iter().any(|block| block.id == *id);
        let gone: Vec<_> =
            self.ids().iter().filter_map(|id| id.stored()).filter(|id| !is_known(id)).collect();
        self.changes(statuses, blocks, &gone);
    }

    /// What has changed in the relay.
    pub fn changes(&self, statuses: Vec<BlockStatus>, blocks: Vec<Block>, removed: &[BlockId]) {
        for block in blocks {
            self.put_stored(block);
        }
        for status in statuses {
            self.put_status(DeckId::Stored(status.block), status);
        }
        for id in removed {
            self.remove(DeckId::Stored(*id));
        }
    }

    /// A stored block; an older revision than the known one is ignored.
    pub fn put_stored(&self, block: Block) {
        let id = DeckId::Stored(block.id);
        if self.row(id).is_some_and(|row| row.revision > block.revision) {
            return;
        }
        self.put_config(id, block.revision, Rc::new(block.config));
    }

    /// The configuration of a block that exists in this browser only.
    pub fn put_new(&self, id: DeckId, config: BlockConfig) {
        self.put_config(id, 0, Rc::new(config));
    }

    /// A newer status.
    pub fn put_status(&self, id: DeckId, status: BlockStatus) {
        self.change(id, |row| {
            Rc::make_mut(&mut row.trace).extend(&status.edges);
            row.status = Rc::new(status);
        });
    }

    /// What went over the wire for a block's newest message.
    pub fn put_exchange(&self, id: DeckId, exchange: ExchangeView) {
        self.change(id, |row| row.exchange = Some(Rc::new(exchange)));
    }

    /// What became of a write.
    pub fn put_written(&self, id: DeckId, runs: u64, written: Written) {
        self.change(id, |row| row.written = Some((runs, Rc::new(written))));
    }

    /// Forgets an entry.
    pub fn remove(&self, id: DeckId) {
        let mut state = self.0.state.borrow_mut();
        if state.rows.remove(&id).is_some() {
            state.dirty.insert(id, ());
            state.members_changed();
            drop(state);
            self.ask();
        }
    }

    fn change(&self, id: DeckId, change: impl FnOnce(&mut Row)) {
        let mut state = self.0.state.borrow_mut();
        let Some(row) = state.rows.get_mut(&id) else { return };
        change(Rc::make_mut(row));
        state.dirty.insert(id, ());
        drop(state);
        self.ask();
    }

    fn put_config(&self, id: DeckId, revision: u64, config: Rc<BlockConfig>) {
        let mut state = self.0.state.borrow_mut();
        if let Some(row) = state.rows.get_mut(&id) {
            let row = Rc::make_mut(row);
            (row.revision, row.config) = (revision, config);
        } else {
            let status = Rc::new(idle(id));
            state.rows.insert(
                id,
                Rc::new(Row {
                    id,
                    revision,
                    config,
                    status,
                    trace: Rc::default(),
                    exchange: None,
                    written: None,
                }),
            );
            state.members_changed();
        }
        state.dirty.insert(id, ());
        drop(state);
        self.ask();
    }

    fn ask(&self) {
        let mut state = self.0.state.borrow_mut();
        if state.frame_asked {
            return;
        }
        state.frame_asked = true;
        drop(state);
        let store = self.clone();
        (self.0.ask_for_frame)(Box::new(move || store.flush()));
    }

    fn flush(&self) {
        let mut state = self.0.state.borrow_mut();
        state.frame_asked = false;
        let dirty = std::mem::take(&mut state.dirty);
        let ids_changed = std::mem::take(&mut state.ids_changed);
        state.watchers.retain(|_, watchers| !watchers.is_empty());
        let woken: Vec<_> = dirty.keys().filter_map(|id| state.watchers.get(id).cloned()).collect();
        drop(state);
        for watchers in woken {
            watchers.wake();
        }
        if ids_changed {
            self.0.ids_watchers.wake();
        }
        self.0.frame_watchers.wake();
    }
}

impl State {
    fn members_changed(&mut self) {
        self.ids = self.rows.keys().copied().collect();
        self.ids_changed = true;
    }
}

impl PartialEq for RowStore {
    fn eq(&self, other: &Self) -> bool {
        Rc::ptr_eq(&self.0, &other.0)
    }
}

impl fmt::Debug for RowStore {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "RowStore({} rows)", self.0.state.borrow().rows.len())
    }
}

/// The status of a block that nobody has run.
fn idle(id: DeckId) -> BlockStatus {
    let block = id.stored().unwrap_or(BlockId(0));
    BlockStatus::new(block, &BlockView::default(), None, None)
}

#[cfg(test)]
mod tests;
