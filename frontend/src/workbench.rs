//! The desk of `MSG_CIPGENERIC` blocks, and where they run: in the relay, or in this browser against the demo device.

use std::rc::Rc;

use cipdeck_shared::{
    api::{Problem, ProblemCode},
    config::{BlockId, Target},
    engine::CommandError,
    plan::MessagePlan,
};
use yew::Callback;

use crate::{
    demo::Demo,
    desk::{Consent, Desk, Local, Runs},
    editor::Draft,
    i18n::tr,
    net::{Relay, rest},
    notice::Notice,
    store::{DeckId, RowStore},
};

/// A handle to the whole application. Clones are the same.
pub type Workbench = Desk<Draft, Demo>;

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

impl Desk<Draft, Demo> {
    /// Where a message would be sent from now.
    pub fn place(&self, target: Option<&Target>) -> Place {
        match target {
            _ if self.relay().is_online() => Place::Relay,
            Some(Target::BuiltIn) => Place::Browser,
            _ => Place::Nowhere,
        }
    }

    fn begin(
        &self,
        id: DeckId,
        consent: Consent,
        command: impl FnOnce(&Relay, BlockId, Option<String>, Callback<Problem>) + 'static,
        demo: impl FnOnce(&Demo, DeckId, MessagePlan, bool) -> Result<(), CommandError>,
    ) {
        self.notices().clear(id);
        let Some((Some(plan), _)) = self.draft(id).map(|draft| draft.check()) else { return };
        match self.place(Some(plan.target())) {
            Place::Relay => self.start(id, move |relay, block, refused| {
                command(relay, block, consent.ticket(), refused);
            }),
            Place::Browser => self.answer(id, demo(self.local(), id, plan, consent != Consent::None)),
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
            DeckId::Stored(block) if self.relay().is_online() => {
                command(self.relay(), block, self.refused(id));
            }
            _ => self.answer(id, demo(self.local(), id)),
        }
    }

    fn answer(&self, id: DeckId, result: Result<(), CommandError>) {
        if let Err(CommandError::Busy) = result {
            let problem = rest::unreachable(tr!("problem.busy").to_string());
            let problem = Problem { code: ProblemCode::Busy, ..problem };
            self.notices().put(id, Notice::Problem(Rc::new(problem)));
        }
    }
}

impl Runs for Desk<Draft, Demo> {
    fn run(&self, id: DeckId, consent: Consent) {
        self.begin(id, consent, Relay::run, Demo::run);
    }

    fn set_in(&self, id: DeckId, input: bool, consent: Consent) {
        if input {
            let command = |relay: &Relay, block, ticket, refused| relay.set_in(block, true, ticket, refused);
            return self.begin(id, consent, command, Demo::start);
        }
        self.end(id, |relay, block, refused| relay.set_in(block, false, None, refused), Demo::stop);
    }

    fn cancel(&self, id: DeckId) {
        self.end(id, Relay::cancel, Demo::cancel);
    }
}

impl Local for Demo {
    fn beside(rows: &RowStore) -> Self {
        Self::new(rows.clone())
    }

    fn remove(&self, id: DeckId) {
        self.remove(id);
    }
}
