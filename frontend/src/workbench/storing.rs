//! From the draft into the relay: save, conflict, refusal.

use std::rc::Rc;

use cipdeck_shared::{
    api::Problem,
    config::{Block, BlockId},
};
use yew::platform::spawn_local;

use super::{Gone, Workbench};
use crate::{editor::Draft, net::rest, notice::Notice, store::DeckId};

impl Workbench {
    /// Stores an entry.
    pub fn save(&self, id: DeckId) {
        let bench = self.clone();
        spawn_local(async move {
            // A refusal is shown where the entry is.
            let _ = bench.store(id).await;
        });
    }

    /// Stores the draft over whatever the relay has now.
    pub fn save_over(&self, id: DeckId, current: &Block) {
        let Some(mut draft) = self.draft(id) else { return };
        draft.revision = Some(current.revision);
        self.0.rows.put_stored(current.clone());
        self.keep(id, draft);
        self.save(id);
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
        let draft = self.draft(id)?;
        let stored = match id {
            DeckId::Stored(block) if !self.is_unsaved(id) => {
                let revision = self.0.rows.row(id)?.revision;
                return Some((block, revision));
            }
            DeckId::Stored(block) => {
                let revision = draft.revision.unwrap_or_default();
                rest::replace(block, revision, draft.config.clone()).await
            }
            DeckId::New(_) => rest::create(&draft.config).await,
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

    fn stored(&self, id: DeckId, block: Block, sent: &Draft) {
        let to = DeckId::Stored(block.id);
        let revision = block.revision;
        self.0.rows.put_stored(block);
        // Somebody may have typed on while it was being stored.
        let newer = self.0.drafts.draft(id).filter(|draft| **draft != *sent);
        self.0.drafts.discard(id);
        if let Some(newer) = newer {
            let mut newer = (*newer).clone();
            newer.revision = Some(revision);
            self.0.drafts.put(to, newer);
        }
        if id != to {
            self.0.gone.borrow_mut().insert(id, Gone::Stored(to));
            self.0.demo.remove(id);
            self.0.rows.remove(id);
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
