//! From the draft into the relay: save, conflict, refusal.

use std::rc::Rc;

use cipdeck_shared::{
    api::Problem,
    config::{Block, BlockId},
};
use yew::platform::spawn_local;

use super::{Desk, Gone, Intent, Local};
use crate::{
    editor::{Editable, Kind},
    net::rest,
    notice::Notice,
    store::DeckId,
};

impl<D: Editable, L: Local> Desk<D, L> {
    /// Stores an entry.
    pub fn save(&self, id: DeckId) {
        let desk = self.clone();
        spawn_local(async move {
            // A refusal is shown where the entry is.
            let _ = desk.store(id).await;
        });
    }

    /// Stores the draft over whatever the relay has now.
    pub fn save_over(&self, id: DeckId, current: &Block) {
        let Some(mut draft) = self.draft(id) else { return };
        *draft.revision() = Some(current.revision);
        self.0.rows.put_stored(current.clone());
        self.keep(id, draft);
        self.save(id);
    }

    /// Stores an entry that somebody wants to write: the relay writes what is stored. Whether it is still the same entry;
    /// otherwise the wish waits at the new one.
    pub async fn store_to_write(&self, id: DeckId, intent: Intent) -> bool {
        let Some((block, _)) = self.store(id).await else { return false };
        let to = DeckId::Stored(block);
        if to != id {
            self.0.wanted.replace(Some((to, intent)));
        }
        to == id
    }

    /// The wish that has waited at this entry while it was stored.
    pub fn take_wanted(&self, id: DeckId) -> Option<Intent> {
        self.0.wanted.borrow_mut().take_if(|(wanted, _)| *wanted == id).map(|(_, intent)| intent)
    }

    /// Stores an entry if there is something to store: its id and revision in the relay, or `None` and a notice.
    /// While it is being stored a second wish is ignored: two clicks must not make two blocks.
    pub(super) async fn store(&self, id: DeckId) -> Option<(BlockId, u64)> {
        if !self.0.storing.borrow_mut().insert(id, ()) {
            return None;
        }
        let stored = self.store_once(id).await;
        self.0.storing.borrow_mut().remove(&id);
        stored
    }

    async fn store_once(&self, id: DeckId) -> Option<(BlockId, u64)> {
        self.0.notices.clear(id);
        let mut draft = self.draft(id)?;
        let stored = match id {
            DeckId::Stored(block) if !self.is_unsaved(id) => {
                let revision = self.0.rows.row(id)?.revision;
                return Some((block, revision));
            }
            DeckId::Stored(block) => {
                let seen = draft.revision().unwrap_or_default();
                rest::replace(block, &draft.config().clone().with_revision(seen)).await
            }
            DeckId::New(_) => rest::create(draft.config()).await,
        };
        match stored {
            Ok(block) => {
                let place = (block.id, block.revision);
                self.stored(id, block, &draft);
                Some(place)
            }
            Err(problem) => {
                self.not_stored(id, problem);
                None
            }
        }
    }

    fn stored(&self, id: DeckId, block: Block, sent: &D) {
        let to = DeckId::Stored(block.id);
        let revision = block.revision;
        self.0.rows.put_stored(block);
        // Somebody may have typed on while it was being stored.
        let newer = self.0.drafts.draft(id).filter(|draft| **draft != *sent);
        self.0.drafts.discard(id);
        if let Some(newer) = newer {
            let mut newer = (*newer).clone();
            *newer.revision() = Some(revision);
            self.0.drafts.put(to, newer);
        }
        if id != to {
            self.leave(id, Gone::Stored(to));
        }
    }

    fn not_stored(&self, id: DeckId, problem: Problem) {
        if let (Some(findings), Some(mut draft)) = (&problem.findings, self.draft(id)) {
            draft.refuse(findings.clone());
            self.keep(id, draft);
        }
        let notice = match problem.current.clone() {
            Some(current) => Notice::Conflict(Rc::new(current)),
            None => Notice::Problem(Rc::new(problem)),
        };
        self.0.notices.put(id, notice);
    }
}
