//! What a block's page is about: the draft, checked.

use cipdeck_shared::{
    config::{Target, TargetPath},
    plan::{Field, MessagePlan, TriggerType},
};
use yew::AttrValue;

use crate::{
    editor::{Draft, Remark},
    i18n::tr,
    store::DeckId,
    workbench::{Place, Workbench},
};

/// A draft and everything that follows from it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Subject {
    pub(crate) id: DeckId,
    /// The stored revision; 0 if it is not stored.
    pub(crate) revision: u64,
    pub(crate) draft: Draft,
    pub(crate) plan: Option<MessagePlan>,
    pub(crate) remarks: Vec<Remark>,
    pub(crate) unsaved: bool,
    pub(crate) online: bool,
    pub(crate) place: Place,
}

impl Subject {
    pub(crate) fn of(bench: &Workbench, id: DeckId) -> Option<Self> {
        let draft = bench.draft(id)?;
        let revision = bench.rows().row(id)?.revision;
        let (plan, remarks) = draft.check();
        let place = bench.place(plan.as_ref().map(MessagePlan::target));
        let online = bench.relay().is_online();
        Some(Self { id, revision, draft, plan, remarks, unsaved: bench.is_unsaved(id), online, place })
    }

    /// What is said about a field.
    pub(crate) fn remarks_of(&self, field: &Field) -> Vec<Remark> {
        let name = field.to_string();
        self.remarks.iter().filter(|remark| remark.field == name).cloned().collect()
    }

    /// How many findings stop the block.
    pub(crate) fn errors(&self) -> usize {
        self.remarks.iter().filter(|remark| remark.is_error()).count()
    }

    /// Whether running it needs a confirmation.
    pub(crate) fn may_write(&self) -> bool {
        self.plan.as_ref().is_some_and(|plan| plan.access().may_write())
    }

    /// Whether IN sends again and again.
    pub(crate) fn is_cyclic(&self) -> bool {
        self.plan.as_ref().is_some_and(|plan| plan.trigger() != TriggerType::Once)
    }

    /// Why it cannot run now.
    pub(crate) fn obstacle(&self) -> Option<AttrValue> {
        match (&self.plan, self.place) {
            (None, _) if self.errors() == 1 => Some(tr!("run.finding")),
            (None, _) => Some(tr!("run.findings", count = self.errors())),
            (Some(_), Place::Nowhere) => Some(tr!("run.needs_relay")),
            (Some(_), Place::Relay | Place::Browser) => None,
        }
    }
}

/// Where a path leads, in words.
pub(crate) fn target_words(path: &str) -> Option<AttrValue> {
    let path: TargetPath = path.parse().ok()?;
    Some(match path.target {
        Target::BuiltIn => tr!("target.built_in"),
        Target::Network(endpoint) => tr!("target.direct", host = endpoint.host, port = endpoint.port),
    })
}
