//! The class 3 connections that are open.

use alloc::vec::Vec;

use crate::engine::time::Instant;
use crate::wire::{ConnectionId, ConnectionTriad, SessionHandle};

use super::request::Answer;

/// One open connection.
#[derive(Clone, Debug)]
pub(super) struct Connection {
    pub(super) triad: ConnectionTriad,
    /// What requests carry.
    pub(super) o_t_id: ConnectionId,
    /// What replies carry.
    pub(super) t_o_id: ConnectionId,
    /// Longest request, with its sequence count.
    pub(super) o_t_size: u16,
    /// Longest reply, with its sequence count.
    pub(super) t_o_size: u16,
    /// The session that opened it.
    pub(super) session: SessionHandle,
    /// Index of the module at its end.
    pub(super) module: usize,
    /// How long it may be silent, us.
    pub(super) watchdog_us: u64,
    /// When it has been silent for too long.
    pub(super) expires: Instant,
    /// Sequence count and reply of the last request.
    pub(super) last: Option<(u16, Answer)>,
}

impl Connection {
    /// A request has come in.
    pub(super) const fn touch(&mut self, now: Instant) {
        self.expires = Instant(now.0.saturating_add(self.watchdog_us));
    }
}

/// All of them; the limit is kept by whoever inserts.
#[derive(Clone, Debug, Default)]
pub(super) struct Connections {
    open: Vec<Connection>,
    last_id: u32,
}

/// Far from session handles and from what originators pick, so that a mix-up is noticed.
const FIRST_ID: u32 = 0x4000_0001;

impl Connections {
    pub(super) const fn len(&self) -> usize {
        self.open.len()
    }

    pub(super) fn by_triad(&self, triad: ConnectionTriad) -> Option<&Connection> {
        self.open.iter().find(|connection| connection.triad == triad)
    }

    /// A session cannot speak on somebody else's connection.
    pub(super) fn by_id(&mut self, session: SessionHandle, id: ConnectionId) -> Option<&mut Connection> {
        self.open.iter_mut().find(|connection| connection.o_t_id == id && connection.session == session)
    }

    pub(super) fn insert(&mut self, connection: Connection) {
        self.open.push(connection);
    }

    /// An id that no open connection has. Never 0.
    pub(super) fn free_id(&mut self) -> ConnectionId {
        loop {
            self.last_id = self.last_id.checked_add(1).map_or(FIRST_ID, |id| id.max(FIRST_ID));
            let id = ConnectionId(self.last_id);
            if self.open.iter().all(|connection| connection.o_t_id != id) {
                return id;
            }
        }
    }

    pub(super) fn close(&mut self, triad: ConnectionTriad) {
        self.open.retain(|connection| connection.triad != triad);
    }

    /// Closes what a session has opened; how many those were.
    pub(super) fn close_session(&mut self, session: SessionHandle) -> usize {
        let before = self.open.len();
        self.open.retain(|connection| connection.session != session);
        before - self.open.len()
    }

    /// Takes out what has been silent for too long.
    pub(super) fn expire(&mut self, now: Instant) -> impl Iterator<Item = Connection> + '_ {
        self.open.extract_if(.., move |connection| connection.expires <= now)
    }

    /// When the next connection has been silent for too long.
    pub(super) fn next_expiry(&self) -> Option<Instant> {
        self.open.iter().map(|connection| connection.expires).min()
    }
}
