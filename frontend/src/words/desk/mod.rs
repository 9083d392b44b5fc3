//! Everything this document can do with a block: what is stored, what is run, what a person is asked.

mod storing;

use std::{cell::RefCell, fmt, rc::Rc};

use cipdeck_shared::{
    api::{Problem, ProblemCode},
    config::{BlockId, SendReq},
};
use yew::{Callback, platform::spawn_local};

use super::edit::{Draft, Edit};
use crate::{
    editor::DraftStore,
    net::{Relay, rest},
    notice::{Notice, NoticeStore},
    store::{DeckId, RowStore, Shelf},
    workbench::{Gone, Intent},
};

/// A handle to the document's state. Clones are the same.
#[derive(Clone)]
pub struct Desk(Rc<Parts>);

struct Parts {
    rows: RowStore,
    drafts: DraftStore<Draft>,
    relay: Relay,
    notices: NoticeStore,
    gone: RefCell<Shelf<DeckId, Gone>>,
    storing: RefCell<Shelf<DeckId, ()>>,
    wanted: RefCell<Option<(DeckId, Intent)>>,
}

impl Desk {
    /// Puts the parts together. Drafts that are not stored anywhere else become rows.
    pub fn new(rows: RowStore, drafts: DraftStore<Draft>, relay: Relay) -> Self {
        for id in drafts.ids() {
            if let (DeckId::New(_), Some(draft)) = (id, drafts.draft(id)) {
                rows.put_new(id, draft.config.clone().into());
            }
        }
        Self(Rc::new(Parts {
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
    pub fn drafts(&self) -> &DraftStore<Draft> {
        &self.0.drafts
    }

    /// The connection.
    pub fn relay(&self) -> &Relay {
        &self.0.relay
    }

    /// What went wrong lately.
    pub fn notices(&self) -> &NoticeStore {
        &self.0.notices
    }

    /// What this page did to an entry that is not there any more.
    pub fn gone(&self, id: DeckId) -> Option<Gone> {
        self.0.gone.borrow().get(&id).copied()
    }

    /// The blocks that this document is for.
    pub fn ids(&self) -> Vec<DeckId> {
        let is_ours =
            |id: &&DeckId| self.0.rows.row(**id).is_some_and(|row| row.config.as_send_req().is_some());
        self.0.rows.ids().iter().filter(is_ours).copied().collect()
    }

    /// The draft of an entry, or one of what is stored.
    pub fn draft(&self, id: DeckId) -> Option<Draft> {
        let row = self.0.rows.row(id)?;
        let config = row.config.as_send_req()?;
        let stored = || Draft::new(config.clone(), id.stored().map(|_| row.revision));
        Some(self.0.drafts.draft(id).map_or_else(stored, |draft| (*draft).clone()))
    }

    /// Adds a block that is not stored yet; its name is made unique.
    pub fn add(&self, mut config: SendReq) -> DeckId {
        config.name = self.unique_name(&config.name);
        let id = self.0.drafts.next_new();
        self.0.rows.put_new(id, config.clone().into());
        self.0.drafts.put(id, Draft::new(config, None));
        id
    }

    /// Makes a new block of the draft of one that somebody else has deleted.
    pub fn rescue(&self, id: DeckId) -> Option<DeckId> {
        let draft = self.0.drafts.draft(id)?;
        self.0.drafts.discard(id);
        Some(self.add(draft.config.clone()))
    }

    /// Changes a draft.
    pub fn edit(&self, id: DeckId, edit: Edit) {
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
        let differs = row.zip(draft).is_some_and(|(row, draft)| {
            row.config.as_send_req().is_some_and(|stored| draft.differs_from(stored))
        });
        id.stored().is_none() || differs
    }

    /// Runs an entry once: as it is now, so it is stored before.
    pub fn run(&self, id: DeckId, ticket: Option<String>) {
        self.start(id, move |relay, block, refused| relay.run(block, ticket, refused));
    }

    /// Sets EN.
    pub fn set_en(&self, id: DeckId, en: bool, ticket: Option<String>) {
        if en {
            self.start(id, move |relay, block, refused| relay.set_in(block, true, ticket, refused));
        } else if let Some(block) = id.stored() {
            self.0.relay.set_in(block, false, None, self.refused(id));
        }
    }

    /// Cancels what is running.
    pub fn cancel(&self, id: DeckId) {
        if let Some(block) = id.stored() {
            self.0.relay.cancel(block, self.refused(id));
        }
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

    /// The wish that has waited at this entry while it was stored.
    pub fn take_wanted(&self, id: DeckId) -> Option<Intent> {
        self.0.wanted.borrow_mut().take_if(|(wanted, _)| *wanted == id).map(|(_, intent)| intent)
    }

    fn start(&self, id: DeckId, command: impl FnOnce(&Relay, BlockId, Callback<Problem>) + 'static) {
        self.0.notices.clear(id);
        let desk = self.clone();
        spawn_local(async move {
            let Some((block, _)) = desk.store(id).await else { return };
            command(&desk.0.relay, block, desk.refused(DeckId::Stored(block)));
        });
    }

    fn refused(&self, id: DeckId) -> Callback<Problem> {
        let notices = self.0.notices.clone();
        Callback::from(move |problem| notices.put(id, Notice::Problem(Rc::new(problem))))
    }

    fn keep(&self, id: DeckId, draft: Draft) {
        if id.stored().is_none() {
            self.0.rows.put_new(id, draft.config.clone().into());
        }
        self.0.drafts.put(id, draft);
    }

    fn forget(&self, id: DeckId) {
        self.0.notices.clear(id);
        self.0.drafts.discard(id);
        self.0.gone.borrow_mut().insert(id, Gone::Deleted);
        self.0.rows.remove(id);
    }

    fn unique_name(&self, name: &str) -> String {
        let ids = self.0.rows.ids();
        let named = |id: &DeckId| {
            let stored = || self.0.rows.row(*id).map(|row| row.config.name().to_owned());
            self.0.drafts.draft(*id).map(|draft| draft.config.name.clone()).or_else(stored)
        };
        let taken: Vec<_> = ids.iter().filter_map(named).collect();
        let numbered = (2..).map(|number| format!("{name}-{number}"));
        std::iter::once(name.to_owned())
            .chain(numbered)
            .find(|name| !taken.contains(name))
            .unwrap_or_default()
    }
}

impl PartialEq for Desk {
    fn eq(&self, other: &Self) -> bool {
        Rc::ptr_eq(&self.0, &other.0)
    }
}

impl fmt::Debug for Desk {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Desk({:?}, {:?})", self.0.rows, self.0.relay)
    }
}
