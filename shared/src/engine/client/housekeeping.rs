//! What a client does without a block: closing what is not used, keeping alive, asking who it is.

use alloc::vec::Vec;

use crate::config::Profile;
use crate::wire::{ClassCode, Epath, LogicalKind, MessageRouterRequest, ServiceCode};

use crate::engine::block::Input;
use crate::engine::connection::MAX_KEEP_ALIVE;
use crate::engine::matching::Expected;
use crate::engine::status::{Cause, CauseKind};
use crate::engine::time::{Instant, Millis};

use super::{Client, Context, Link, Output, Outstanding, What};

/// How long the target has for closing the TCP connection after UnRegisterSession.
const CLOSING_TIME: Millis = Millis(500);

/// How long the target has for its answer to Forward_Close.
const CLOSE_TIME: Millis = Millis(500);

/// How long the target has for saying who it is; afterwards it is nothing special.
const IDENTIFY_TIME: Millis = Millis(200);

/// How long the target has for the answer to a read that keeps it alive.
const KEEP_ALIVE_TIME: Millis = Millis(3_000);

/// Connections of earlier sockets that are remembered.
const MAX_LOST: usize = 16;

/// Identity, status: every device has it.
const STATUS_ATTRIBUTE: u32 = 5;

impl Client {
    /// Ends an idle session: its connections first; the target closes the TCP connection.
    pub(in crate::engine) fn close(&mut self, cx: &mut Context<'_>) {
        if !self.is_idle() {
            return;
        }
        match &self.link {
            Link::Ready(..) => {
                self.ending = true;
                self.connections.iter_mut().for_each(|connection| connection.close_wanted = true);
                self.advance(cx);
            }
            Link::Connecting(_) | Link::Registering(..) => self.disconnect(cx),
            Link::None | Link::Closing(..) => {}
        }
    }

    /// When [`Self::handle_timeout`] has something to do.
    pub(in crate::engine) fn poll_timeout(&self) -> Option<Instant> {
        match &self.link {
            Link::Closing(_, until) => Some(*until),
            Link::Ready(..) => match &self.outstanding {
                Some(outstanding) => outstanding.deadline,
                None if self.is_idle() => self.next_idle(),
                None => None,
            },
            Link::None | Link::Connecting(_) | Link::Registering(..) => None,
        }
    }

    /// Time has passed. Too early is harmless.
    pub(in crate::engine) fn handle_timeout(&mut self, cx: &mut Context<'_>) {
        if self.poll_timeout().is_none_or(|at| at > cx.now) {
            return;
        }
        if let Link::Closing(..) = self.link {
            return self.disconnect(cx);
        }
        if let Some(outstanding) = self.outstanding.take() {
            return self.give_up(&outstanding.what, cx);
        }
        if self.keep_alive.is_some() {
            for connection in &mut self.connections {
                // The session was too busy for keeping it alive.
                connection.close_wanted |= connection.is_stale(cx.now);
            }
            return match self.unwanted_connection() {
                Some(_) => self.advance(cx),
                None => self.keep_alive(cx),
            };
        }
        for connection in &mut self.connections {
            connection.close_wanted |= connection.last_used + connection.idle <= cx.now;
        }
        let longest = self.connections.iter().map(|connection| connection.idle).max().unwrap_or_default();
        // 2080-RM001D p. 182: with its last connection the session is closed.
        self.ending |= self.last_message + longest <= cx.now;
        self.advance(cx);
    }

    /// An idle connection is closed after its time; with a keep-alive nothing is closed.
    fn next_idle(&self) -> Option<Instant> {
        match self.keep_alive {
            Some(period) if self.connections.is_empty() => Some(self.last_used + period),
            Some(period) => {
                let silence = period.min(MAX_KEEP_ALIVE);
                self.connections.iter().map(|connection| connection.last_sent + silence).min()
            }
            None => self.connections.iter().map(|connection| connection.last_used + connection.idle).min(),
        }
    }

    fn give_up(&mut self, what: &What, cx: &mut Context<'_>) {
        match what {
            // A late ListIdentity reply answers nothing: no other command has that reply.
            What::Identify => self.identified(None, cx),
            What::KeepAlive(_) => {
                self.error = Some(Cause::new(CauseKind::Timeout));
                self.disconnect(cx);
            }
            _ => self.disconnect(cx),
        }
        self.advance(cx);
    }

    /// A connection that is to be closed and that no message waits for.
    pub(super) fn unwanted_connection(&self) -> Option<usize> {
        self.connections
            .iter()
            .position(|connection| connection.close_wanted && !self.is_wanted(&connection.route))
    }

    /// The connection that has been of no use for longest: since when, and its serial number.
    pub(in crate::engine) fn spare_connection(&self) -> Option<(Instant, u16)> {
        let used = self.outstanding.as_ref().and_then(|outstanding| match &outstanding.what {
            What::Message(_, serial) => *serial,
            _ => None,
        });
        let spare = self.connections.iter().filter(|open| {
            !open.close_wanted && Some(open.triad.serial) != used && !self.is_wanted(&open.route)
        });
        spare.map(|open| (open.last_used, open.triad.serial)).min()
    }

    /// Closes a spare connection, because another one needs its place.
    pub(in crate::engine) fn give_up_connection(&mut self, serial: u16, cx: &mut Context<'_>) {
        for connection in &mut self.connections {
            connection.close_wanted |= connection.triad.serial == serial;
        }
        self.ending |= self.is_idle() && self.connections.iter().all(|connection| connection.close_wanted);
        self.advance(cx);
    }

    /// Whether a message in the queue is for this route's connection.
    pub(super) fn is_wanted(&self, route: &Epath) -> bool {
        self.queue.iter().any(|job| {
            job.plan.connection().is_some() && job.plan.routed(self.profile_for(&job.plan)).route() == route
        })
    }

    /// Sends Forward_Close. The connection counts as closed from here on.
    pub(super) fn close_connection(&mut self, index: usize, cx: &mut Context<'_>) {
        let connection = self.connections.swap_remove(index);
        self.changed = true;
        if let Some(request) = connection.close_request() {
            self.send_own(What::Close, &request, 1, Some(cx.now + CLOSE_TIME), cx);
        }
    }

    /// The socket is gone: the target may keep its connections until their watchdog.
    pub(super) fn lose_connections(&mut self) {
        for connection in self.connections.drain(..) {
            self.lost.extend(connection.close_request());
        }
        if let Some(Outstanding { what: What::Open(_, opening), written: true, .. }) = &self.outstanding {
            self.lost.extend(opening.close_request());
        }
        let surplus = self.lost.len().saturating_sub(MAX_LOST);
        self.lost.drain(..surplus);
    }

    /// Closes one connection of an earlier socket, if there is one.
    pub(super) fn close_lost(&mut self, cx: &mut Context<'_>) -> bool {
        let Some(request) = self.lost.pop_front() else { return false };
        self.send_own(What::Close, &request, 1, Some(cx.now + CLOSE_TIME), cx);
        true
    }

    pub(super) fn unregister(&mut self, cx: &mut Context<'_>) {
        let context = self.fresh_context();
        if let Link::Ready(id, session) = &self.link {
            let id = *id;
            session.unregister(context, &mut self.transmit);
            self.link = Link::Closing(id, cx.now + CLOSING_TIME);
            self.changed = true;
            cx.out.push_back(Output::Transmit(id));
        }
    }

    pub(super) fn identify(&mut self, cx: &mut Context<'_>) {
        let context = self.fresh_context();
        if let Link::Ready(id, session) = &self.link {
            session.ask_identity(context, &mut self.transmit);
            let (expected, deadline) = (Expected::Identity(context), Some(cx.now + IDENTIFY_TIME));
            self.outstanding = Some(Outstanding { what: What::Identify, expected, written: false, deadline });
            cx.out.push_back(Output::Transmit(*id));
        }
    }

    pub(super) fn identified(&mut self, profile: Option<Profile>, cx: &mut Context<'_>) {
        self.known.anonymous |= profile.is_none();
        self.known.identity = profile;
        self.changed = true;
        if let Some(job) = self.queue.front() {
            cx.out.push_back(Output::Block(job.block, Input::ConnectEnded));
        }
    }

    /// Reads the device's status over the connection that was used least recently, or without one.
    fn keep_alive(&mut self, cx: &mut Context<'_>) {
        let path = Epath::object(ClassCode::Identity.0, 1).then(LogicalKind::Attribute, STATUS_ATTRIBUTE);
        let request = MessageRouterRequest::new(ServiceCode::GetAttributeSingle, path, Vec::new());
        let Ok(request) = request.map(|request| request.bytes()) else { return };
        let deadline = Some(cx.now + KEEP_ALIVE_TIME);
        let context = self.fresh_context();
        let connection = self.connections.iter_mut().min_by_key(|connection| connection.last_sent);
        let (Some(connection), Link::Ready(id, session)) = (connection, &self.link) else {
            return self.send_own(What::KeepAlive(None), &request, 1, deadline, cx);
        };
        let expected = session.send_connected(&request, context, connection, cx.now, &mut self.transmit);
        let what = What::KeepAlive(Some(connection.triad.serial));
        self.outstanding = Some(Outstanding { what, expected, written: false, deadline });
        cx.out.push_back(Output::Transmit(*id));
    }
}
