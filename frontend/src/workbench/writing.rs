//! A write in the relay, in two halves: first what would happen and the ticket for it, then the command.

use std::rc::Rc;

use super::Workbench;
use crate::{notice::Notice, store::DeckId};

/// What somebody wants to do with a block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Intent {
    /// One message.
    Run,
    /// IN goes TRUE.
    SwitchOn,
}

/// What a person has agreed to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Consent {
    /// Nothing: it only reads.
    None,
    /// The write that they have seen, to the demo device of this browser.
    Seen,
    /// The write that the relay has given this ticket for.
    Ticket(String),
}

impl Consent {
    /// The relay's ticket.
    pub fn ticket(self) -> Option<String> {
        match self {
            Self::Ticket(ticket) => Some(ticket),
            Self::None | Self::Seen => None,
        }
    }
}

impl Workbench {
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

    /// The wish that has waited at this entry.
    pub fn take_wanted(&self, id: DeckId) -> Option<Intent> {
        self.0.wanted.borrow_mut().take_if(|(wanted, _)| *wanted == id).map(|(_, intent)| intent)
    }

    /// Tells what went wrong with a command.
    pub fn tell(&self, id: DeckId, problem: cipdeck_shared::api::Problem) {
        self.0.notices.put(id, Notice::Problem(Rc::new(problem)));
    }
}
