//! Everything the page can do with blocks: where a block runs, what is stored, what a person is asked.

mod storing;
mod writing;

use std::{cell::RefCell, fmt, rc::Rc};

use cipdeck_shared::{
    api::{Problem, ProblemCode},
    config::{BlockId, MsgCipGeneric, Target},
    engine::CommandError,
    plan::MessagePlan,
};
use yew::{Callback, platform::spawn_local};

use crate::{
    demo::Demo,
    editor::{Draft, DraftStore, Edit},
    i18n::tr,
    net::{Relay, rest},
    notice::{Notice, NoticeStore},
    store::{DeckId, RowStore, Shelf},
};

pub use self::writing::{Consent, Intent};

/// A handle to the whole application. Clones are the same.
#[derive(Clone)]
pub struct Workbench(Rc<Parts>);

struct Parts {
    rows: RowStore,
    drafts: DraftStore,
    relay: Relay,
    demo: Demo,
    notices: NoticeStore,
    gone: RefCell<Shelf<DeckId, Gone>>,
    storing: RefCell<Shelf<DeckId, ()>>,
    wanted: RefCell<Option<(DeckId, Intent)>>,
}

/// What this page did to an entry that is not there any more.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Gone {
    /// It has been stored, and is there under the relay's id.
    Stored(DeckId),
    /// It has been deleted.
    Deleted,
}

/// Where a block would run now.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// In the relay.
    Relay,
    /// In this browser, against the demo device.
    Browser,
    /// Nowhere: its device can be reached by a relay only, and there is none.
    Nowhere,
}

impl Workbench {
    /// Puts the parts together. Drafts that are not stored anywhere else become rows.
    pub fn new(rows: RowStore, drafts: DraftStore, relay: Relay, notices: NoticeStore) -> Self {
        for id in drafts.ids() {
            if let (DeckId::New(_), Some(draft)) = (id, drafts.draft(id)) {
                rows.put_new(id, draft.config.clone().into());
            }
        }
        let demo = Demo::new(rows.clone());
        Self(Rc::new(Parts {
            rows,
            drafts,
            relay,
            demo,
            notices,
            gone: RefCell::default(),
            storing: RefCell::default(),
            wanted: RefCell::default(),
        }))
    }

    /// The rows.
    pub fn rows(&self) -> &RowStore {
        &self.0.rows
    }

    /// The drafts.
    pub fn drafts(&self) -> &DraftStore {
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

    /// Where a message would be sent from now.
    pub fn place(&self, target: Option<&Target>) -> Place {
        match target {
            _ if self.0.relay.is_online() => Place::Relay,
            Some(Target::BuiltIn) => Place::Browser,
            _ => Place::Nowhere,
        }
    }

    /// The draft of an entry, or one of what is stored. There is none of a block that is edited elsewhere.
    pub fn draft(&self, id: DeckId) -> Option<Draft> {
        let row = self.0.rows.row(id)?;
        let config = row.config.as_msg()?;
        let stored = || Draft::new(config.clone(), id.stored().map(|_| row.revision));
        Some(self.0.drafts.draft(id).map_or_else(stored, |draft| (*draft).clone()))
    }

    /// What an entry is called, in its draft if it has one.
    pub fn name(&self, id: DeckId) -> String {
        let stored = || self.0.rows.row(id).map(|row| row.config.name().to_owned());
        self.draft(id).map(|draft| draft.config.name).or_else(stored).unwrap_or_default()
    }

    /// Adds a block that is not stored yet; its name is made unique.
    pub fn add(&self, mut config: MsgCipGeneric) -> DeckId {
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
        id.stored().is_none()
            || row.zip(draft).is_some_and(|(row, draft)| {
                row.config.as_msg().is_none_or(|stored| draft.differs_from(stored))
            })
    }

    /// Runs an entry once.
    pub fn run(&self, id: DeckId, consent: Consent) {
        self.start(id, consent, Relay::run, Demo::run);
    }

    /// Sets IN.
    pub fn set_in(&self, id: DeckId, input: bool, consent: Consent) {
        if input {
            let command = |relay: &Relay, block, ticket, refused| relay.set_in(block, true, ticket, refused);
            return self.start(id, consent, command, Demo::start);
        }
        self.end(id, |relay, block, refused| relay.set_in(block, false, None, refused), Demo::stop);
    }

    /// Cancels what is running.
    pub fn cancel(&self, id: DeckId) {
        self.end(id, Relay::cancel, Demo::cancel);
    }

    /// Deletes an entry.
    pub fn delete(&self, id: DeckId) {
        let (DeckId::Stored(block), Some(row)) = (id, self.0.rows.row(id)) else { return self.forget(id) };
        let bench = self.clone();
        spawn_local(async move {
            match rest::delete(block, row.revision).await {
                Ok(()) => bench.forget(id),
                Err(problem) if problem.code == ProblemCode::NotFound => bench.forget(id),
                Err(problem) => bench.0.notices.put(id, Notice::Problem(Rc::new(problem))),
            }
        });
    }

    fn start(
        &self,
        id: DeckId,
        consent: Consent,
        command: impl FnOnce(&Relay, BlockId, Option<String>, Callback<Problem>) + 'static,
        demo: impl FnOnce(&Demo, DeckId, MessagePlan, bool) -> Result<(), CommandError>,
    ) {
        self.0.notices.clear(id);
        let Some((Some(plan), _)) = self.draft(id).map(|draft| draft.check()) else { return };
        match self.place(Some(plan.target())) {
            Place::Relay => {
                let bench = self.clone();
                spawn_local(async move {
                    let Some((block, _)) = bench.store(id).await else { return };
                    command(&bench.0.relay, block, consent.ticket(), bench.refused(DeckId::Stored(block)));
                });
            }
            Place::Browser => self.answer(id, demo(&self.0.demo, id, plan, consent != Consent::None)),
            Place::Nowhere => {}
        }
    }

    fn end(
        &self,
        id: DeckId,
        command: impl FnOnce(&Relay, BlockId, Callback<Problem>),
        demo: impl FnOnce(&Demo, DeckId) -> Result<(), CommandError>,
    ) {
        match id {
            DeckId::Stored(block) if self.0.relay.is_online() => {
                command(&self.0.relay, block, self.refused(id));
            }
            _ => self.answer(id, demo(&self.0.demo, id)),
        }
    }

    fn answer(&self, id: DeckId, result: Result<(), CommandError>) {
        if let Err(CommandError::Busy) = result {
            let problem = rest::unreachable(tr!("problem.busy").to_string());
            self.0.notices.put(id, Notice::Problem(Rc::new(Problem { code: ProblemCode::Busy, ..problem })));
        }
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
        self.0.demo.remove(id);
        self.0.drafts.discard(id);
        self.0.gone.borrow_mut().insert(id, Gone::Deleted);
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

impl PartialEq for Workbench {
    fn eq(&self, other: &Self) -> bool {
        Rc::ptr_eq(&self.0, &other.0)
    }
}

impl fmt::Debug for Workbench {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Workbench({:?}, {:?})", self.0.rows, self.0.relay)
    }
}
