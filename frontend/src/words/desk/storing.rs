//! From the draft into the relay: save, conflict, refusal.

use std::rc::Rc;

use cipdeck_shared::{
    api::Problem,
    config::{Block, BlockId, SendReq},
};
use gloo_net::http::Method;
use yew::platform::spawn_local;

use super::Desk;
use crate::{
    net::rest::{self, Answered},
    notice::Notice,
    store::DeckId,
    words::edit::Draft,
    workbench::{Gone, Intent},
};

impl Desk {
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
        draft.revision = Some(current.revision);
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
                replace(block, draft.revision.unwrap_or_default(), draft.config.clone()).await
            }
            DeckId::New(_) => create(&draft.config).await,
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

async fn create(config: &SendReq) -> Answered<Block> {
    rest::parse(&rest::ask(Method::POST, "blocks", Some(rest::json(config)?)).await?)
}

async fn replace(id: BlockId, revision: u64, mut config: SendReq) -> Answered<Block> {
    config.extra.insert("revision".to_owned(), revision.into());
    rest::parse(&rest::ask(Method::PUT, &format!("blocks/{id}"), Some(rest::json(&config)?)).await?)
}
