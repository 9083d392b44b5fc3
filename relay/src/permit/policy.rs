//! Everything that a decision depends on, and the news about it.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use cipdeck_shared::api::{WriteState, WriteTicket};
use cipdeck_shared::config::{BlockId, write_hex};
use tokio::sync::watch;
use tokio::time::Instant;
use tokio_util::sync::CancellationToken;

use super::denials::Denials;
use super::lists::Lists;
use super::question::Denied;
use super::rate::Rate;
use super::read_only::ReadOnly;
use super::ticket::{Confirmed, GOOD_FOR, Offer, Tickets};
use super::window::{NotOpened, Window};
use crate::actor::Actor;
use crate::audit::{Audit, Event, Record};
use crate::metrics::Metrics;

/// The rules of this relay.
#[derive(Debug)]
pub(crate) struct Policy {
    pub(crate) lists: Lists,
    pub(super) window: Window,
    pub(super) tickets: Tickets,
    pub(crate) read_only: ReadOnly,
    pub(super) rate: Rate,
    pub(super) denials: Denials,
    pub(crate) audit: Audit,
    /// What is counted of all this.
    pub(crate) metrics: Metrics,
    /// The switch as the audit knows it: the file can be made and removed without us.
    recorded_switch: AtomicBool,
    /// Changes whenever [`Self::write_state`] does.
    version: watch::Sender<u64>,
}

/// How often the window's owner and the switch are looked at, beside every message that wants to be sent.
const REVIEW: Duration = Duration::from_millis(250);

impl Policy {
    /// Without anything that is allowed. `limit` is in messages per second and target.
    pub(crate) fn new(folder: Option<&Path>, audit: Audit, limit: u32) -> Self {
        Self {
            lists: Lists::default(),
            window: Window::default(),
            tickets: Tickets::default(),
            recorded_switch: AtomicBool::new(ReadOnly::of(folder).is_on()),
            read_only: ReadOnly::of(folder),
            rate: Rate::new(limit),
            denials: Denials::default(),
            metrics: audit.metrics().clone(),
            audit,
            version: watch::Sender::new(0),
        }
    }

    /// What everybody sees about writing.
    pub(crate) fn write_state(&self) -> WriteState {
        WriteState {
            window: self.window.view(Instant::now()),
            read_only: self.read_only.is_on(),
            stopped: (!self.audit.is_writable()).then(|| Denied::NoAudit.to_string()),
        }
    }

    /// What one target gets at most; 0 = no limit.
    pub(crate) const fn messages_per_second(&self) -> u32 {
        self.rate.limit()
    }

    /// Changes when the write state has changed.
    pub(crate) fn watch(&self) -> watch::Receiver<u64> {
        self.version.subscribe()
    }

    /// Opens a write window.
    pub(crate) fn open_window(&self, owner: &Actor, minutes: Option<u32>) -> Result<(), OpenError> {
        if self.read_only.is_on() {
            return Err(OpenError::Denied(Denied::ReadOnly));
        }
        self.window.begin(owner, minutes)?;
        let ends_at = self.window.view(Instant::now()).map(|window| window.ends_at);
        let record = record(Event::WindowOpened, owner).with_some("ends_at", ends_at);
        if self.audit.append(&record).is_err() {
            self.window.close();
            return Err(OpenError::Denied(Denied::NoAudit));
        }
        self.changed();
        Ok(())
    }

    /// Closes the write window. Everybody may: it is the safe direction.
    pub(crate) fn close_window(&self, actor: &Actor) {
        if let Some(owner) = self.window.close() {
            self.note(&record(Event::WindowClosed, actor).with("owner", owner).with("why", "closed"));
            self.changed();
        }
    }

    /// Turns the switch on. Writing is stopped in any case; an error says that only until the relay ends.
    pub(crate) fn stop_writing(&self, actor: &Actor) -> std::io::Result<()> {
        let kept = self.read_only.turn_on();
        self.note_switch(true, actor.name(), actor.from());
        self.close_window(actor);
        self.changed();
        kept
    }

    /// Turns the switch off: the caller has made sure that it is local access.
    pub(crate) fn write_again(&self, actor: &Actor) -> std::io::Result<()> {
        self.read_only.turn_off()?;
        self.note_switch(false, actor.name(), actor.from());
        self.changed();
        Ok(())
    }

    /// What a person would confirm now, were they given a ticket.
    pub(crate) fn hypothetical(&self, revision: u64) -> Option<Confirmed> {
        let now = Instant::now();
        let window = self.window.open(now)?;
        let deadline = now + GOOD_FOR;
        Some(Confirmed { id: String::new(), revision, window, deadline, old: None, new: None })
    }

    /// A ticket for a write that has been looked at. The audit has it before the person.
    pub(crate) fn offer(
        &self,
        actor: &Actor,
        block: BlockId,
        offer: &Offer,
        no_old: Option<String>,
    ) -> Result<WriteTicket, Denied> {
        let window = self.window.open(Instant::now()).ok_or(Denied::NoWindow)?;
        let ticket = self.tickets.give(actor, block, window, offer.clone()).ok_or(Denied::NoTicket)?;
        let record = record(Event::WriteRequested, actor)
            .with("block", block.to_string())
            .with("revision", offer.revision)
            .with("ticket", Tickets::id(&ticket))
            .with("request", write_hex(&offer.request))
            .with_some("old", offer.old.as_ref().map(|old| old.data.clone()))
            .with_some("new", offer.new.as_ref().map(|new| new.data.clone()));
        self.audit.append(&record).map_err(|_| Denied::NoAudit)?;
        Ok(WriteTicket {
            ticket,
            good_for_ms: u64::try_from(GOOD_FOR.as_millis()).unwrap_or(u64::MAX),
            revision: offer.revision,
            request: write_hex(&offer.request),
            old: offer.old.clone(),
            no_old,
            new: offer.new.clone(),
        })
    }

    /// A command comes with a ticket.
    pub(crate) fn redeem(&self, ticket: &str, actor: &Actor, block: BlockId) -> Result<Confirmed, Denied> {
        self.tickets.take(ticket, actor, block)
    }

    /// Records what does not depend on being recorded.
    pub(crate) fn note(&self, record: &Record) {
        if let Err(error) = self.audit.append(record) {
            tracing::error!(%error, "the audit cannot be written");
        }
    }

    /// Closes the window when its time is over or its owner is gone, and tells everybody what has changed.
    pub(crate) async fn keep(self: Arc<Self>, stop: CancellationToken) {
        let mut look = tokio::time::interval(REVIEW);
        look.set_missed_tick_behavior(tokio::time::MissedTickBehavior::Delay);
        let mut last = self.seen();
        while stop.run_until_cancelled(look.tick()).await.is_some() {
            if let Some((owner, ending)) = self.window.review(Instant::now()) {
                self.note(
                    &record(Event::WindowClosed, &owner)
                        .with("owner", owner.name())
                        .with("why", ending.word()),
                );
            }
            let seen = self.seen();
            // With `cipdeck read-only`, or by hand, at the relay's machine.
            self.note_switch(seen.read_only, "local", "");
            // What was confirmed before the switch does not hold when it is off again.
            if seen.read_only
                && let Some(owner) = self.window.close()
            {
                self.note(
                    &Record::new(Event::WindowClosed, "local", "")
                        .with("owner", owner)
                        .with("why", "read_only"),
                );
                self.changed();
            }
            if seen != last {
                last = seen;
                self.changed();
            }
        }
    }

    /// Records the switch, if the audit does not know it yet.
    fn note_switch(&self, is_on: bool, actor: &str, from: &str) {
        if self.recorded_switch.swap(is_on, Ordering::Relaxed) != is_on {
            let event = if is_on { Event::ReadOnlyOn } else { Event::ReadOnlyOff };
            self.note(&Record::new(event, actor, from));
        }
    }

    /// What people see, but for the time that is left.
    fn seen(&self) -> WriteState {
        let mut state = self.write_state();
        if let Some(window) = &mut state.window {
            window.left_ms = 0;
        }
        state
    }

    fn changed(&self) {
        self.version.send_modify(|version| *version += 1);
    }
}

/// Why no window was opened.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub(crate) enum OpenError {
    /// Who asks, how long, or somebody else's.
    #[error(transparent)]
    Window(#[from] NotOpened),
    /// Writes have stopped.
    #[error(transparent)]
    Denied(Denied),
}

/// A record of somebody's doing.
pub(crate) fn record(event: Event, actor: &Actor) -> Record {
    Record::new(event, actor.name(), actor.from())
}
