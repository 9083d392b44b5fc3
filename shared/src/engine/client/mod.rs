//! One endpoint: its TCP connection, its session, its class 3 connections, and one request outstanding at a time.

mod housekeeping;
mod next;
mod replies;
mod view;

use alloc::collections::VecDeque;
use alloc::string::String;
use alloc::sync::Arc;
use alloc::vec::Vec;
use core::ops::Range;

use crate::config::{BlockId, Profile, Target};
use crate::plan::MessagePlan;
use crate::wire::{ConnectedMessage, SenderContext, UnconnectedMessage};

use crate::engine::block::Input;
use crate::engine::connection::{Connection, Opening, Originator};
use crate::engine::event::{LinkId, Wants};
use crate::engine::failure::{ConnectError, Failure};
use crate::engine::session::{Expected, Session};
use crate::engine::status::{Cause, Phase};
use crate::engine::time::{Instant, Millis};

/// First delay after a failed connect; doubled up to [`MAX_BACK_OFF`].
const MIN_BACK_OFF: Millis = Millis(250);

/// Longest delay between attempts of cyclic messages.
const MAX_BACK_OFF: Millis = Millis(5_000);

/// A message on its way to this endpoint.
#[derive(Clone, Debug)]
pub(super) struct Job {
    pub(super) block: BlockId,
    pub(super) shot: u64,
    pub(super) revision: u64,
    pub(super) plan: Arc<MessagePlan>,
    /// Sent again once after the target did not know the session: it cannot have acted.
    pub(super) resent: bool,
}

/// What the client wants done.
#[derive(Debug)]
pub(super) enum Output {
    Connect(LinkId),
    Disconnect(LinkId),
    Transmit(LinkId),
    Wants(Wants),
    Block(BlockId, Input),
    /// Frames for the block's exchange: written, read, and where the message router reply is in it.
    Wrote(BlockId, Vec<u8>),
    Read(BlockId, Vec<u8>, Range<usize>),
}

/// What every call needs.
pub(super) struct Context<'a> {
    pub(super) now: Instant,
    pub(super) next_link: &'a mut u64,
    pub(super) originator: &'a mut Originator,
    pub(super) out: &'a mut VecDeque<Output>,
}

/// A client's name inside the engine: shorter to compare than its target.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct ClientId(pub(super) u64);

#[derive(Debug)]
pub(super) struct Client {
    target: Target,
    link: Link,
    queue: VecDeque<Job>,
    /// The block and shot whose permission has been asked for.
    asking: Option<(BlockId, u64)>,
    outstanding: Option<Outstanding>,
    connections: Vec<Connection>,
    /// Requests that close what an earlier socket has left open at the target: it may have room for few.
    lost: VecDeque<Vec<u8>>,
    /// Bytes for the socket.
    transmit: Vec<u8>,
    next_context: u64,
    failures: u32,
    retry_at: Option<Instant>,
    last_used: Instant,
    /// When a message last came from a block or was answered.
    last_message: Instant,
    /// Whether the controller's limits count this session.
    pub(super) controller: bool,
    /// The session is closed as soon as nothing is left to do.
    ending: bool,
    keep_alive: Option<Millis>,
    known: Known,
    /// The last time that it did not answer, until it does.
    error: Option<Cause>,
    dropped: u64,
    /// Something that [`Self::view`] shows has changed.
    changed: bool,
    /// When the engine will call [`Self::handle_timeout`].
    pub(super) armed: Option<Instant>,
}

/// What is known of the device.
#[derive(Debug, Default)]
struct Known {
    /// What it has said that it is, on this TCP connection.
    identity: Option<Profile>,
    /// It has been asked once without success: not again.
    anonymous: bool,
    /// The connection id in its replies is that of the requests.
    own_connection_id: bool,
}

#[derive(Debug, Default)]
enum Link {
    #[default]
    None,
    Connecting(LinkId),
    Registering(LinkId, Session),
    Ready(LinkId, Session),
    /// The target has until then to close the connection.
    Closing(LinkId, Instant),
}

/// The one request that is under way.
#[derive(Debug)]
struct Outstanding {
    what: What,
    /// What its reply will carry.
    expected: Expected,
    /// Its bytes have been handed out: never again.
    written: bool,
    /// When it is given up; a message and a Forward_Open end with their block.
    deadline: Option<Instant>,
}

#[derive(Debug)]
enum What {
    /// The serial number of its connection, if it is connected.
    Message(Job, Option<u16>),
    /// Forward_Open for the message of this block, which is still first in the queue.
    Open(BlockId, Opening),
    /// Forward_Close.
    Close,
    /// ListIdentity.
    Identify,
    /// A read that keeps session and connection alive.
    KeepAlive(Option<u16>),
}

impl What {
    const fn block(&self) -> Option<BlockId> {
        match self {
            Self::Message(job, _) => Some(job.block),
            Self::Open(block, _) => Some(*block),
            Self::Close | Self::Identify | Self::KeepAlive(_) => None,
        }
    }
}

impl Client {
    /// Without a connection.
    pub(super) fn new(target: Target) -> Self {
        Self {
            target,
            link: Link::None,
            queue: VecDeque::new(),
            asking: None,
            outstanding: None,
            connections: Vec::new(),
            lost: VecDeque::new(),
            transmit: Vec::new(),
            next_context: 0,
            failures: 0,
            retry_at: None,
            last_used: Instant::ZERO,
            last_message: Instant::ZERO,
            controller: false,
            ending: false,
            keep_alive: None,
            known: Known::default(),
            error: None,
            dropped: 0,
            changed: false,
            armed: None,
        }
    }

    /// Where its messages go.
    pub(super) const fn target(&self) -> &Target {
        &self.target
    }

    pub(super) fn submit(&mut self, job: Job, cx: &mut Context<'_>) {
        (self.last_used, self.last_message) = (cx.now, cx.now);
        self.ending = false;
        self.keep_alive = Some(Millis::from(job.plan.keep_alive_ms())).filter(|span| span.0 != 0);
        cx.out.push_back(Output::Block(job.block, Input::BufferGranted));
        if matches!(self.link, Link::Connecting(_) | Link::Registering(..)) {
            cx.out.push_back(Output::Block(job.block, Input::ConnectStarted));
        }
        self.queue.push_back(job);
        self.advance(cx);
    }

    /// The block's message has ended, here or elsewhere: forget it. `silence` says that the target has not answered.
    pub(super) fn withdraw(&mut self, block: BlockId, silence: Option<&Cause>, cx: &mut Context<'_>) {
        let connecting = matches!(self.link, Link::Connecting(_) | Link::Registering(..));
        let own = self.outstanding.take_if(|outstanding| outstanding.what.block() == Some(block));
        if own.is_some() || connecting && self.queue.iter().any(|job| job.block == block) {
            self.note_silence(silence, connecting, cx);
        }
        if let Some(outstanding) = own {
            if outstanding.written {
                // Its answer may still come: it must never meet another request.
                if let What::Open(_, opening) = &outstanding.what {
                    self.lost.extend(opening.close_request());
                }
                self.disconnect(cx);
            } else {
                self.transmit.clear();
            }
        }
        self.queue.retain(|job| job.block != block);
        self.asking.take_if(|(asking, _)| *asking == block);
        if self.queue.is_empty() && matches!(self.link, Link::Connecting(_) | Link::Registering(..)) {
            self.disconnect(cx);
        }
        self.advance(cx);
    }

    fn note_silence(&mut self, silence: Option<&Cause>, connecting: bool, cx: &mut Context<'_>) {
        if let Some(cause) = silence {
            self.error = Some(cause.clone());
            self.changed = true;
            if connecting {
                self.back_off(cx.now);
            }
        }
    }

    pub(super) fn connected(&mut self, cx: &mut Context<'_>) {
        if let Link::Connecting(id) = self.link {
            self.transmit.clear();
            let context = self.fresh_context();
            self.link = Link::Registering(id, Session::register(context, &mut self.transmit));
            self.changed = true;
            cx.out.push_back(Output::Transmit(id));
        }
    }

    pub(super) fn connect_failed(&mut self, error: ConnectError, detail: &str, cx: &mut Context<'_>) {
        if matches!(self.link, Link::Connecting(_)) {
            self.link = Link::None;
            self.fail_all(&Failure::NotConnected(error, String::from(detail)), cx);
        }
    }

    pub(super) fn closed(&mut self, cx: &mut Context<'_>) {
        let was_registering = matches!(self.link, Link::Registering(..));
        self.forget_link();
        match self.outstanding.take() {
            Some(Outstanding { what: What::Message(job, _), written: true, .. }) => {
                cx.out.push_back(Output::Block(job.block, Input::Failed(Failure::Closed)));
            }
            Some(Outstanding { what: What::Message(job, _), written: false, .. }) => {
                self.queue.push_front(job);
            }
            // A target that hangs up on Forward_Open does it again.
            Some(Outstanding { what: What::Open(block, _), written: true, .. }) => {
                self.fail_first(block, Failure::Closed, cx);
            }
            Some(Outstanding { what: What::Identify, written: true, .. }) => self.known.anonymous = true,
            _ => {}
        }
        if was_registering {
            self.fail_all(&Failure::Closed, cx);
        }
        self.advance(cx);
    }

    pub(super) fn permit(&mut self, wants: &Wants, allowed: bool, cx: &mut Context<'_>) {
        let Link::Ready(id, _) = &self.link else { return };
        if *id != wants.link || self.asking != Some((wants.block, wants.shot)) {
            return;
        }
        self.asking = None;
        let Some(job) = self.queue.pop_front() else { return };
        if allowed {
            return self.send(job, cx);
        }
        cx.out.push_back(Output::Block(job.block, Input::Failed(Failure::NotPermitted)));
        self.advance(cx);
    }

    /// A plan's request fits into a frame: its parts have checked it when they were made.
    fn send(&mut self, job: Job, cx: &mut Context<'_>) {
        let context = self.fresh_context();
        let profile = self.profile_for(&job.plan);
        let routed = job.plan.routed(profile);
        let connected = job.plan.connection().is_some();
        let connection = self.connections.iter_mut().find(|open| connected && open.route == *routed.route());
        if connected && connection.is_none() {
            // Never unconnected instead.
            self.queue.push_front(job);
            return self.advance(cx);
        }
        let Link::Ready(id, session) = &self.link else { return };
        let (expected, serial) = if let Some(connection) = connection {
            let sequence = connection.next_sequence(cx.now);
            if let Ok(message) = ConnectedMessage::new(job.plan.bytes()) {
                let address = (connection.ids.o_t, sequence);
                session.send_connected(message, context, address, &mut self.transmit);
            }
            (Expected::Connected(context, connection.ids, sequence), Some(connection.triad.serial))
        } else {
            if let Ok(message) = UnconnectedMessage::new(routed.message()) {
                session.send_unconnected(message, context, timeout_s(&job.plan), &mut self.transmit);
            }
            (Expected::Unconnected(context), None)
        };
        cx.out.push_back(Output::Transmit(*id));
        let what = What::Message(job, serial);
        self.outstanding = Some(Outstanding { what, expected, written: false, deadline: None });
    }

    /// Appends what is to be written. From here on the request counts as sent.
    pub(super) fn poll_transmit(&mut self, out: &mut Vec<u8>, cx: &mut Context<'_>) -> bool {
        if self.transmit.is_empty() {
            return false;
        }
        if let Some(outstanding) = self.outstanding.as_mut().filter(|outstanding| !outstanding.written) {
            outstanding.written = true;
            if let Link::Ready(_, session) = &mut self.link {
                session.expect(outstanding.expected);
            }
            if let What::Message(job, _) = &outstanding.what {
                let timeout = job.plan.connection().map(|connection| Millis::from(connection.timeout_ms));
                let deadline = timeout.map(|timeout| cx.now + timeout);
                cx.out.push_back(Output::Wrote(job.block, self.transmit.clone()));
                cx.out.push_back(Output::Block(job.block, Input::Written { deadline }));
            }
        }
        out.append(&mut self.transmit);
        true
    }

    pub(super) fn handle_input(&mut self, bytes: &[u8], cx: &mut Context<'_>) {
        self.last_used = cx.now;
        if let Link::Registering(_, session) | Link::Ready(_, session) = &mut self.link {
            session.receive(bytes);
        }
        while let Link::Registering(_, session) | Link::Ready(_, session) = &mut self.link {
            let Some(received) = session.poll() else { break };
            self.received(received, cx);
        }
        self.advance(cx);
    }

    /// Cyclic messages wait until then.
    pub(super) fn retry_at(&self, now: Instant) -> Option<Instant> {
        self.retry_at.filter(|at| *at > now)
    }

    pub(super) const fn link_id(&self) -> Option<LinkId> {
        match &self.link {
            Link::None => None,
            Link::Connecting(id) | Link::Registering(id, _) | Link::Ready(id, _) | Link::Closing(id, _) => {
                Some(*id)
            }
        }
    }

    /// Whether a session is there or being made.
    pub(super) const fn holds_session(&self) -> bool {
        matches!(self.link, Link::Connecting(_) | Link::Registering(..) | Link::Ready(..))
    }

    /// Whether this is one of the sessions that the controller's limit counts.
    pub(super) const fn counts_for_controller(&self) -> bool {
        self.controller && self.holds_session() && !self.ending
    }

    /// Whether no message is on its way.
    pub(super) fn is_idle(&self) -> bool {
        let message = self.outstanding.as_ref().and_then(|outstanding| outstanding.what.block());
        self.queue.is_empty() && message.is_none()
    }

    pub(super) const fn last_used(&self) -> Instant {
        self.last_used
    }

    /// Place of a block's message: 1 is next; 0 is not queued here.
    pub(super) fn position(&self, block: BlockId) -> usize {
        self.queue.iter().position(|job| job.block == block).map_or(0, |index| index + 1)
    }

    /// Frames from the target that answered nothing.
    pub(super) const fn dropped(&self) -> u64 {
        self.dropped
    }

    fn disconnect(&mut self, cx: &mut Context<'_>) {
        if let Some(id) = self.link_id() {
            cx.out.push_back(Output::Disconnect(id));
        }
        self.forget_link();
    }

    /// The socket is gone, and everything that lived on it.
    fn forget_link(&mut self) {
        self.changed |= self.link_id().is_some();
        self.link = Link::None;
        self.lose_connections();
        self.controller &= !self.is_idle();
        self.known.identity = None;
        self.transmit.clear();
        self.asking = None;
    }

    /// Nothing can be sent: everybody who waits for this endpoint hears why.
    fn fail_all(&mut self, failure: &Failure, cx: &mut Context<'_>) {
        self.back_off(cx.now);
        self.error = Some(failure.cause(Phase::Connecting));
        self.changed = true;
        for job in self.queue.drain(..) {
            cx.out.push_back(Output::Block(job.block, Input::Failed(failure.clone())));
        }
    }

    /// The message that is first in the queue cannot be sent.
    fn fail_first(&mut self, block: BlockId, failure: Failure, cx: &mut Context<'_>) {
        if self.queue.pop_front_if(|job| job.block == block).is_some() {
            cx.out.push_back(Output::Block(block, Input::Failed(failure)));
        }
    }

    fn back_off(&mut self, now: Instant) {
        let delay = MIN_BACK_OFF.0 << self.failures.min(5);
        self.failures = self.failures.saturating_add(1);
        self.retry_at = Some(now + Millis(delay.min(MAX_BACK_OFF.0)));
    }

    const fn fresh_context(&mut self) -> SenderContext {
        self.next_context += 1;
        SenderContext(self.next_context.to_le_bytes())
    }
}

/// The target's own time limit: ours in whole seconds, rounded up.
fn timeout_s(plan: &MessagePlan) -> u16 {
    u16::try_from(plan.ucmm_timeout_ms().div_ceil(1_000)).unwrap_or(u16::MAX)
}
