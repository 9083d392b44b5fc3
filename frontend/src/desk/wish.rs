//! What somebody wants to do with a block, and what they have agreed to.

use crate::store::DeckId;

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

/// The commands of a block, wherever it runs.
pub trait Runs {
    /// Runs an entry once: as it is now, so it is stored before.
    fn run(&self, id: DeckId, consent: Consent);

    /// Sets IN, which `SEND_REQ` calls EN; to TRUE as [`Self::run`].
    fn set_in(&self, id: DeckId, input: bool, consent: Consent);

    /// Cancels what is running.
    fn cancel(&self, id: DeckId);
}
