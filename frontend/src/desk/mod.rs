//! The blocks of a document: what is stored of them, what is being typed, and what a person does with them. The workbench
//! is one, the blocks of words are another: they differ in the kind of block that they edit, and in where it can run.

mod storing;
mod wish;

use std::{cell::RefCell, fmt, rc::Rc};

use cipdeck_shared::{
    api::{Problem, ProblemCode},
    config::BlockId,
};
use yew::{Callback, platform::spawn_local};

pub use self::wish::{Consent, Intent, Runs};
use crate::{
    address, browser,
    editor::{DraftStore, Editable, Kind},
    frame_stats::FrameStats,
    net::{Relay, rest, session},
    notice::{Notice, NoticeStore},
    store::{DeckId, Row, RowStore, Shelf},
};

/// A handle to a document's blocks: those that `D` is a draft of can be edited. Clones are the same.
pub struct Desk<D, L = ()>(Rc<Parts<D, L>>);

struct Parts<D, L> {
    rows: RowStore,
    drafts: DraftStore<D>,
    relay: Relay,
    local: L,
    notices: NoticeStore,
    gone: RefCell<Shelf<DeckId, Gone>>,
    storing: RefCell<Shelf<DeckId, ()>>,
    wanted: RefCell<Option<(DeckId, Intent)>>,
}

/// What runs blocks in this browser, if anything does.
pub trait Local: 'static {
    /// What happens to blocks goes to the rows.
    fn beside(rows: &RowStore) -> Self;

    /// The entry is not there any more.
    fn remove(&self, id: DeckId);
}

/// Nothing does.
impl Local for () {
    fn beside(_: &RowStore) -> Self {}

    fn remove(&self, _: DeckId) {}
}

/// What this page did to an entry that is not there any more.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Gone {
    /// It has been stored, and is there under the relay's id.
    Stored(DeckId),
    /// It has been deleted.
    Deleted,
}

impl<D: Editable, L: Local> Desk<D, L> {
    /// Opens the desk of this browser, whose drafts are kept in its local storage under this key, and starts to connect.
    pub fn open(key: &'static str) -> Self {
        let stats = FrameStats::default();
        stats.offer();
        let rows = RowStore::new(stats.ask_for_frame());
        let drafts = DraftStore::new(browser::kept(key).as_deref(), Rc::new(|text| browser::keep(key, text)));
        let relay = Relay::new(rows.clone(), Callback::from(move |ms| stats.spend(ms)));
        relay.connect();
        session::watch_activity();
        address::listen();
        Self::new(rows, drafts, relay)
    }

    /// Puts the parts together. Drafts that are not stored anywhere else become rows.
    pub fn new(rows: RowStore, drafts: DraftStore<D>, relay: Relay) -> Self {
        for id in drafts.ids() {
            if let (DeckId::New(_), Some(draft)) = (id, drafts.draft(id)) {
                rows.put_new(id, draft.config().clone().into());
            }
        }
        Self(Rc::new(Parts {
            local: L::beside(&rows),
            rows,
            drafts,
            relay,
            notices: NoticeStore::default(),
            gone: RefCell::default(),
            storing: RefCell::default(),
            wanted: RefCell::default(),
        }))
    }

    /// The rows: of all kinds of blocks.
    pub fn rows(&self) -> &RowStore {
        &self.0.rows
    }

    /// The drafts.
    pub fn drafts(&self) -> &DraftStore<D> {
        &self.0.drafts
    }

    /// The connection.
    pub fn relay(&self) -> &Relay {
        &self.0.relay
    }

    /// What runs blocks in this browser.
    pub(crate) fn local(&self) -> &L {
        &self.0.local
    }

    /// What went wrong lately.
    pub fn notices(&self) -> &NoticeStore {
        &self.0.notices
    }

    /// What this page did to an entry that is not there any more.
    pub fn gone(&self, id: DeckId) -> Option<Gone> {
        self.0.gone.borrow().get(&id).copied()
    }

    /// The blocks that can be edited here.
    pub fn ids(&self) -> Vec<DeckId> {
        let is_ours = |id: &&DeckId| {
            self.0.rows.row(**id).is_some_and(|row| D::Config::of_block(&row.config).is_some())
        };
        self.0.rows.ids().iter().filter(is_ours).copied().collect()
    }

    /// The draft of an entry, or one of what is stored. There is none of a block that is edited elsewhere.
    pub fn draft(&self, id: DeckId) -> Option<D> {
        let row = self.0.rows.row(id)?;
        let config = D::Config::of_block(&row.config)?;
        let stored = || D::new(config.clone(), id.stored().map(|_| row.revision));
        Some(self.0.drafts.draft(id).map_or_else(stored, |draft| (*draft).clone()))
    }

    /// What an entry is called, in its draft if it has one.
    pub fn name(&self, id: DeckId) -> String {
        let Some(row) = self.0.rows.row(id) else { return String::new() };
        let draft = D::Config::of_block(&row.config).and_then(|_| self.0.drafts.draft(id));
        draft.map_or_else(|| row.config.name().to_owned(), |draft| draft.config().name().to_owned())
    }

    /// Adds a block that is not stored yet; its name is made unique.
    pub fn add(&self, mut config: D::Config) -> DeckId {
        config.set_name(self.unique_name(config.name()));
        let id = self.0.drafts.next_new();
        self.0.rows.put_new(id, config.clone().into());
        self.0.drafts.put(id, D::new(config, None));
        id
    }

    /// Makes a new block of the draft of one that somebody else has deleted.
    pub fn rescue(&self, id: DeckId) -> Option<DeckId> {
        let draft = self.0.drafts.draft(id)?;
        self.0.drafts.discard(id);
        Some(self.add(draft.config().clone()))
    }

    /// Changes a draft.
    pub fn edit(&self, id: DeckId, edit: D::Edit) {
        let Some(mut draft) = self.draft(id) else { return };
        draft.edit(edit);
        self.keep(id, draft);
    }

    /// Gives up what was changed.
    pub fn revert(&self, id: DeckId) {
        self.0.notices.clear(id);
        self.0.drafts.discard(id);
    }

    /// Whether an entry holds something that is not stored.
    pub fn is_unsaved(&self, id: DeckId) -> bool {
        let (row, draft) = (self.0.rows.row(id), self.0.drafts.draft(id));
        let differs = |(row, draft): (Rc<Row>, Rc<D>)| {
            D::Config::of_block(&row.config).is_none_or(|stored| draft.differs_from(stored))
        };
        id.stored().is_none() || row.zip(draft).is_some_and(differs)
    }

    /// Deletes an entry.
    pub fn delete(&self, id: DeckId) {
        let (DeckId::Stored(block), Some(row)) = (id, self.0.rows.row(id)) else { return self.forget(id) };
        let desk = self.clone();
        spawn_local(async move {
            match rest::delete(block, row.revision).await {
                Ok(()) => desk.forget(id),
                Err(problem) if problem.code == ProblemCode::NotFound => desk.forget(id),
                Err(problem) => desk.0.notices.put(id, Notice::Problem(Rc::new(problem))),
            }
        });
    }

    /// Gives the relay a command for an entry as it is now, so it is stored before.
    pub(crate) fn start(
        &self,
        id: DeckId,
        command: impl FnOnce(&Relay, BlockId, Callback<Problem>) + 'static,
    ) {
        self.0.notices.clear(id);
        let desk = self.clone();
        spawn_local(async move {
            let Some((block, _)) = desk.store(id).await else { return };
            command(&desk.0.relay, block, desk.refused(DeckId::Stored(block)));
        });
    }

    /// Tells what a command has come to.
    pub(crate) fn refused(&self, id: DeckId) -> Callback<Problem> {
        let notices = self.0.notices.clone();
        Callback::from(move |problem| notices.put(id, Notice::Problem(Rc::new(problem))))
    }

    fn keep(&self, id: DeckId, draft: D) {
        if id.stored().is_none() {
            self.0.rows.put_new(id, draft.config().clone().into());
        }
        self.0.drafts.put(id, draft);
    }

    fn forget(&self, id: DeckId) {
        self.0.notices.clear(id);
        self.0.drafts.discard(id);
        self.leave(id, Gone::Deleted);
    }

    /// An entry is not there any more.
    fn leave(&self, id: DeckId, gone: Gone) {
        self.0.gone.borrow_mut().insert(id, gone);
        self.0.local.remove(id);
        self.0.rows.remove(id);
    }

    fn unique_name(&self, name: &str) -> String {
        let ids = self.0.rows.ids();
        let taken: Vec<_> = ids.iter().map(|id| self.name(*id)).collect();
        let numbered = (2..).map(|number| format!("{name}-{number}"));
        std::iter::once(name.to_owned())
            .chain(numbered)
            .find(|name| !taken.contains(name))
            .unwrap_or_default()
    }
}

impl<D, L> Clone for Desk<D, L> {
    fn clone(&self) -> Self {
        Self(self.0.clone())
    }
}

impl<D, L> PartialEq for Desk<D, L> {
    fn eq(&self, other: &Self) -> bool {
        Rc::ptr_eq(&self.0, &other.0)
    }
}

impl<D, L> fmt::Debug for Desk<D, L> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Desk({:?}, {:?})", self.0.rows, self.0.relay)
    }
}
