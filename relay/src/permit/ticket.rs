//! A write is confirmed with a ticket: it says what will happen, is good for one command, and not for long.

use std::collections::HashMap;
use std::sync::{Arc, Mutex};
use std::time::Duration;

use cipdeck_shared::api::ReadValue;
use cipdeck_shared::config::{BlockId, write_hex};
use tokio::time::Instant;

use super::Denied;
use crate::actor::Actor;
use crate::runner::lock;

/// The tickets that are out.
#[derive(Debug, Default)]
pub(crate) struct Tickets(Mutex<HashMap<String, Out>>);

#[derive(Debug)]
struct Out {
    actor: Actor,
    block: BlockId,
    offer: Offer,
    window: u64,
    expires: Instant,
    is_used: bool,
}

/// What somebody has been shown.
#[derive(Clone, Debug)]
pub(crate) struct Offer {
    /// The revision.
    pub(crate) revision: u64,
    /// Message router bytes.
    pub(crate) request: Arc<[u8]>,
    /// What was there.
    pub(crate) old: Option<ReadValue>,
    /// What will be there.
    pub(crate) new: Option<ReadValue>,
}

/// A ticket that has been given with a command.
#[derive(Clone, Debug)]
pub(crate) struct Confirmed {
    /// The ticket's first half, as the audit names it.
    pub(crate) id: String,
    /// The revision that was seen.
    pub(crate) revision: u64,
    /// The write window in which it was confirmed.
    pub(crate) window: u64,
    /// The message must be on its way before.
    pub(crate) deadline: Instant,
    /// What was there.
    pub(crate) old: Option<ReadValue>,
    /// What will be there.
    pub(crate) new: Option<ReadValue>,
}

/// How long a ticket is good.
pub(crate) const GOOD_FOR: Duration = Duration::from_mins(1);

/// Tickets that can be out at once; the oldest go first.
const MAX_TICKETS: usize = 1_024;

impl Tickets {
    /// A new ticket.
    pub(super) fn give(&self, actor: &Actor, block: BlockId, window: u64, offer: Offer) -> Option<String> {
        let mut secret = [0; 16];
        getrandom::fill(&mut secret).ok()?;
        let (ticket, now) = (write_hex(&secret), Instant::now());
        let mut tickets = lock(&self.0);
        tickets.retain(|_, out| now < out.expires);
        if tickets.len() >= MAX_TICKETS {
            let oldest =
                tickets.iter().min_by_key(|(_, out)| out.expires).map(|(ticket, _)| ticket.clone())?;
            tickets.remove(&oldest);
        }
        let actor = actor.clone();
        let out = Out { actor, block, offer, window, expires: now + GOOD_FOR, is_used: false };
        tickets.insert(ticket.clone(), out);
        Some(ticket)
    }

    /// What the audit calls a ticket: not enough of it to use it.
    pub(super) fn id(ticket: &str) -> String {
        ticket.chars().take(8).collect()
    }

    /// A command comes with a ticket: it is used up, whatever becomes of the command.
    pub(crate) fn take(&self, ticket: &str, actor: &Actor, block: BlockId) -> Result<Confirmed, Denied> {
        let mut tickets = lock(&self.0);
        let out = tickets.get_mut(ticket).filter(|out| out.block == block && out.actor.is_same(actor));
        let out = out.ok_or(Denied::NoTicket)?;
        if std::mem::replace(&mut out.is_used, true) {
            return Err(Denied::Used);
        }
        if Instant::now() >= out.expires {
            return Err(Denied::Late);
        }
        let Offer { revision, old, new, .. } = out.offer.clone();
        Ok(Confirmed { id: Self::id(ticket), revision, window: out.window, deadline: out.expires, old, new })
    }
}
