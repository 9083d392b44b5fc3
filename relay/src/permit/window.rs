//! The time in which writes are possible: opened by a person, seen by everybody, and over at its end, at a button, or
//! when its owner is gone.

use std::sync::Mutex;
use std::time::{Duration, SystemTime};

use cipdeck_shared::api::{ActorKind, Role, WindowView};
use tokio::time::Instant;

use crate::actor::Actor;
use crate::runner::lock;
use crate::wall_clock;

/// At most one window.
#[derive(Debug, Default)]
pub(crate) struct Window(Mutex<State>);

#[derive(Debug, Default)]
struct State {
    open: Option<Open>,
    /// The number of the last window: what was confirmed in one does not hold in the next.
    last: u64,
}

#[derive(Debug)]
struct Open {
    owner: Actor,
    opened_at: SystemTime,
    ends_at: SystemTime,
    ends: Instant,
}

/// Why no window was opened.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub(crate) enum NotOpened {
    /// Tokens, links and roles that do not write.
    #[error("a write window is opened by a person who may write: an operator or an engineer")]
    NotAllowed,
    /// One at a time.
    #[error("{0} has a write window open: close it first")]
    AlreadyOpen(String),
    /// The length.
    #[error("a write window is open for 1 to {MAX_MINUTES} minutes")]
    Minutes,
}

/// Why a window has ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Ending {
    /// Its time is over.
    Time,
    /// Its owner is signed out, locked, or may not write any more.
    Owner,
}

impl Ending {
    /// As the audit says it.
    pub(crate) const fn word(self) -> &'static str {
        match self {
            Self::Time => "time",
            Self::Owner => "owner_gone",
        }
    }
}

/// Minutes when nobody says how many.
const DEFAULT_MINUTES: u32 = 15;

/// Longest window.
const MAX_MINUTES: u32 = 60;

impl Window {
    /// The number of the open window, if its owner is still there.
    pub(super) fn open(&self, now: Instant) -> Option<u64> {
        let state = lock(&self.0);
        state.open.as_ref().is_some_and(|open| open.ending(now).is_none()).then_some(state.last)
    }

    /// Opens one.
    pub(crate) fn begin(&self, owner: &Actor, minutes: Option<u32>) -> Result<(), NotOpened> {
        let minutes = minutes.unwrap_or(DEFAULT_MINUTES);
        if !(1..=MAX_MINUTES).contains(&minutes) {
            return Err(NotOpened::Minutes);
        }
        let is_person = matches!(owner.kind(), ActorKind::Person | ActorKind::Local);
        if !is_person || !owner.is_present() || !owner.role().is_some_and(Role::may_write) {
            return Err(NotOpened::NotAllowed);
        }
        let (length, now) = (Duration::from_mins(minutes.into()), Instant::now());
        let mut state = lock(&self.0);
        if let Some(open) = state.open.as_ref().filter(|open| open.ending(now).is_none()) {
            return Err(NotOpened::AlreadyOpen(open.owner.name().to_owned()));
        }
        let opened_at = SystemTime::now();
        state.last += 1;
        state.open =
            Some(Open { owner: owner.clone(), opened_at, ends_at: opened_at + length, ends: now + length });
        Ok(())
    }

    /// Closes it; whose it was.
    pub(crate) fn close(&self) -> Option<String> {
        lock(&self.0).open.take().map(|open| open.owner.name().to_owned())
    }

    /// Takes away a window that is over: whose it was, and why it ended.
    pub(super) fn review(&self, now: Instant) -> Option<(Actor, Ending)> {
        let mut state = lock(&self.0);
        let ending = state.open.as_ref()?.ending(now)?;
        Some((state.open.take()?.owner, ending))
    }

    /// As everybody sees it.
    pub(super) fn view(&self, now: Instant) -> Option<WindowView> {
        let state = lock(&self.0);
        let open = state.open.as_ref().filter(|open| open.ending(now).is_none())?;
        Some(WindowView {
            owner: open.owner.name().to_owned(),
            opened_at: wall_clock::at(open.opened_at),
            ends_at: wall_clock::at(open.ends_at),
            left_ms: u64::try_from(open.ends.duration_since(now).as_millis()).unwrap_or(u64::MAX),
        })
    }
}

impl Open {
    fn ending(&self, now: Instant) -> Option<Ending> {
        if now >= self.ends {
            Some(Ending::Time)
        } else if !self.owner.is_present() || !self.owner.role().is_some_and(Role::may_write) {
            Some(Ending::Owner)
        } else {
            None
        }
    }
}
