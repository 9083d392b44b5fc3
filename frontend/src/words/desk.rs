//! The desk of `SEND_REQ` and `DATA_EXCH` blocks. They run in the relay only.

use super::edit::Draft;
use crate::{
    desk::{self, Consent, Runs},
    net::Relay,
    store::DeckId,
};

/// A handle to the document's state. Clones are the same.
pub type Desk = desk::Desk<Draft>;

impl Runs for desk::Desk<Draft> {
    fn run(&self, id: DeckId, consent: Consent) {
        self.start(id, move |relay, block, refused| relay.run(block, consent.ticket(), refused));
    }

    fn set_in(&self, id: DeckId, input: bool, consent: Consent) {
        if input {
            let command = move |relay: &Relay, block, refused| {
                relay.set_in(block, true, consent.ticket(), refused);
            };
            self.start(id, command);
        } else if let Some(block) = id.stored() {
            self.relay().set_in(block, false, None, self.refused(id));
        }
    }

    fn cancel(&self, id: DeckId) {
        if let Some(block) = id.stored() {
            self.relay().cancel(block, self.refused(id));
        }
    }
}
