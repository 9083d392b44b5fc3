//! What a block's page is about: the draft, checked.

use std::rc::Rc;

use cipdeck_shared::{
    api::Role,
    config::Profile,
    plan::{Field, MessagePlan, TriggerType},
};
use yew::AttrValue;

use super::commands::{Asks, Commanded};
use crate::{
    editor::{Draft, Remark},
    i18n::tr,
    net::session,
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
    pub(crate) plan: Option<Rc<MessagePlan>>,
    /// What the target is, as far as that is known.
    pub(crate) profile: Profile,
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
        let plan = plan.map(Rc::new);
        let known = bench.relay().targets().profile(&draft.config.target_cfg.path);
        let profile = match draft.config.profile {
            Profile::Auto => known.unwrap_or_default(),
            chosen => chosen,
        };
        let place = bench.place(plan.as_ref().map(|plan| plan.target()));
        let online = bench.relay().is_online();
        Some(Self {
            id,
            revision,
            draft,
            plan,
            profile,
            remarks,
            unsaved: bench.is_unsaved(id),
            online,
            place,
        })
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

    /// What its commands have to know.
    pub(crate) fn commanded(&self) -> Commanded {
        let words = if self.is_cyclic() { tr!("run.in_cyclic") } else { tr!("run.in_once") };
        let by_relay = self.place == Place::Relay;
        Commanded {
            id: self.id,
            stored: self.id.stored().filter(|_| by_relay).map(|block| (block, self.revision)),
            plan: self.plan.clone(),
            switch: ("IN", words),
            repeats: self.is_cyclic(),
            obstacle: self.obstacle(),
            asks: Asks::of(self.may_write(), by_relay && self.unsaved),
            // By everybody who may send.
            may_stop: !by_relay || session::may(Role::may_send),
            can_save: self.can_save(),
        }
    }

    /// Whether it can be stored now.
    pub(crate) fn can_save(&self) -> bool {
        self.no_save().is_none() && self.errors() == 0
    }

    /// Why it cannot be stored now.
    pub(crate) fn no_save(&self) -> Option<AttrValue> {
        match (self.unsaved, self.online) {
            (false, _) => Some(tr!("save.nothing")),
            (true, false) => Some(tr!("save.needs_relay")),
            (true, true) if !session::may(Role::may_edit) => Some(tr!("may.not_edit")),
            (true, true) => None,
        }
    }

    /// Why it cannot run now.
    pub(crate) fn obstacle(&self) -> Option<AttrValue> {
        match (&self.plan, self.place) {
            (None, _) if self.errors() == 1 => Some(tr!("run.finding")),
            (None, _) => Some(tr!("run.findings", count = self.errors())),
            (Some(_), Place::Nowhere) => Some(tr!("run.needs_relay")),
            (Some(_), Place::Relay) => self.no_right(),
            (Some(_), Place::Browser) => None,
        }
    }

    /// What the caller's role does not allow. The relay decides; this only says it before somebody tries.
    fn no_right(&self) -> Option<AttrValue> {
        if !session::may(Role::may_send) {
            Some(tr!("may.not_send"))
        } else if self.unsaved && !session::may(Role::may_edit) {
            Some(tr!("may.not_edit_first"))
        } else if self.may_write() && !session::may(Role::may_write) {
            Some(tr!("may.not_write"))
        } else {
            None
        }
    }
}
