//! What a block's page is about: the draft, checked.

use std::rc::Rc;

use cipdeck_shared::{
    api::Role,
    plan::{MessagePlan, TriggerType},
};
use yew::AttrValue;

use crate::{
    editor::Remark,
    net::session,
    pages::block::{Asks, Commanded},
    store::DeckId,
    words::{desk::Desk, edit::Draft, i18n::tr},
};

/// A draft and everything that follows from it.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Subject {
    pub(super) id: DeckId,
    /// The stored revision; 0 if it is not stored.
    pub(super) revision: u64,
    pub(super) draft: Draft,
    pub(super) plan: Option<Rc<MessagePlan>>,
    pub(super) remarks: Vec<Remark>,
    pub(super) unsaved: bool,
    pub(super) online: bool,
    /// Whether the caller may change blocks.
    pub(super) may_edit: bool,
}

impl Subject {
    pub(super) fn of(desk: &Desk, id: DeckId) -> Option<Self> {
        let draft = desk.draft(id)?;
        let revision = desk.rows().row(id)?.revision;
        let (plan, remarks) = draft.check();
        Some(Self {
            id,
            revision,
            plan: plan.map(Rc::new),
            remarks,
            unsaved: desk.is_unsaved(id),
            online: desk.relay().is_online(),
            may_edit: session::may(Role::may_edit),
            draft,
        })
    }

    /// What is said about a member.
    pub(super) fn remarks_of(&self, name: &str) -> Vec<Remark> {
        self.remarks.iter().filter(|remark| remark.field == name).cloned().collect()
    }

    /// How many findings stop the block.
    pub(super) fn errors(&self) -> usize {
        self.remarks.iter().filter(|remark| remark.is_error()).count()
    }

    /// Whether running it needs a confirmation.
    pub(super) fn may_write(&self) -> bool {
        self.plan.as_ref().is_some_and(|plan| plan.access().may_write())
    }

    /// Whether EN sends again and again.
    pub(super) fn is_cyclic(&self) -> bool {
        self.plan.as_ref().is_some_and(|plan| plan.trigger() != TriggerType::Once)
    }

    /// What its commands have to know.
    pub(super) fn commanded(&self) -> Commanded {
        let words = if self.is_cyclic() { tr!("run.en_cyclic") } else { tr!("run.en_once") };
        Commanded {
            id: self.id,
            stored: self.id.stored().map(|block| (block, self.revision)),
            plan: self.plan.clone(),
            switch: ("EN", words),
            repeats: self.is_cyclic(),
            obstacle: self.obstacle(),
            asks: Asks::of(self.may_write(), self.unsaved),
            may_stop: self.online && session::may(Role::may_send),
            can_save: self.can_save(),
        }
    }

    /// Whether it can be stored now.
    pub(super) fn can_save(&self) -> bool {
        self.no_save().is_none() && self.errors() == 0
    }

    /// Why it cannot be stored now.
    pub(super) fn no_save(&self) -> Option<AttrValue> {
        match (self.unsaved, self.online) {
            (false, _) => Some(tr!("save.nothing")),
            (true, _) if !self.may_edit => Some(tr!("may.not_edit")),
            (true, false) => Some(tr!("save.needs_relay")),
            (true, true) => None,
        }
    }

    /// Why it cannot run now. The relay decides; this only says it before somebody tries.
    pub(super) fn obstacle(&self) -> Option<AttrValue> {
        if !self.online {
            return Some(tr!("block.needs_relay"));
        }
        match (&self.plan, self.errors()) {
            (None, 1) => Some(tr!("run.finding")),
            (None, count) => Some(tr!("run.findings", count = count)),
            (Some(_), _) if !session::may(Role::may_send) => Some(tr!("may.not_send")),
            (Some(_), _) if self.unsaved && !self.may_edit => Some(tr!("may.not_edit_first")),
            (Some(_), _) if self.may_write() && !session::may(Role::may_write) => Some(tr!("may.not_write")),
            (Some(_), _) => None,
        }
    }
}
