//! One endpoint: its TCP connection, its session, its class 3 connections, and one request outstanding at a time.

mod housekeeping;
mod link;
mod messages;
mod next;
mod replies;
mod view;

use alloc::collections::VecDeque;
use alloc::sync::Arc;
use alloc::vec::Vec;
use core::ops::Range;

use crate::config::{BlockId, Profile, Target};
use crate::plan::MessagePlan;
use crate::wire::SenderContext;

use crate::engine::block::Input;
use crate::engine::connection::{Connection, Opening, Originator};
use crate::engine::event::{LinkId, Wants};
use crate::engine::matching::Expected;
use crate::engine::session::Session;
use crate::engine::status::Cause;
use crate::engine::time::{Instant, Millis};

/// A message on its way to this endpoint.
#[derive(Clone, Debug)]
pub(super) struct Job {
    pub(super) block: BlockId,
    pub(super) shot: u64,
    pub(super) revision: u64,
    pub(super) plan: Arc<MessagePlan>,
    /// Sent again once after the target did not know the session: it cannot have acted.
    pub(super) resent: bool,
    /// A connection may be opened for it.
    pub(super) may_open: bool,
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
    /// What permission has been asked for.
    asking: Option<Wants>,
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

    const fn fresh_context(&mut self) -> SenderContext {
        self.next_context += 1;
        SenderContext(self.next_context.to_le_bytes())
    }
}
