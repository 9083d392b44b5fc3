//! What the engine says to its owner.

use alloc::boxed::Box;
use alloc::sync::Arc;
use alloc::vec::Vec;
use core::ops::Range;

use crate::config::{BlockId, Target};

use super::block::BlockView;
use super::status::StatusBits;
use super::target::TargetView;

/// One TCP connection or the attempt at one. Never used again, so that nothing stale can be taken for new.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct LinkId(pub u64);

/// A message that is about to be written, or for which a connection is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Wants {
    /// Whose message.
    pub block: BlockId,
    /// Which of its messages.
    pub shot: u64,
    /// The revision of the configuration that is about to be sent.
    pub revision: u64,
    /// Where it will be written.
    pub link: LinkId,
    /// Only a connection is opened for it, or its device asked what it is. The message itself is asked for afterwards.
    pub opens: bool,
}

/// What the owner has to do, or may tell others.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Event {
    /// Open a TCP connection; answer with `connected` or `connect_failed`.
    Connect {
        /// The name of the attempt.
        link: LinkId,
        /// Where to.
        target: Target,
    },
    /// Drop the socket now, or give up the attempt. No answer.
    Disconnect {
        /// Which.
        link: LinkId,
    },
    /// `poll_transmit` has bytes.
    Transmit {
        /// For which socket.
        link: LinkId,
    },
    /// May this be sent? Answer with `permit`.
    Wants(Wants),
    /// A block looks different: [`Engine::glance`](super::Engine::glance) shows how.
    Changed {
        /// Which.
        block: BlockId,
        /// The new edge, if its bits have changed: µs since the trigger, and the bits from then on.
        edge: Option<(u64, StatusBits)>,
    },
    /// A target looks different.
    Target {
        /// Which.
        target: Target,
        /// How it looks now; `None` when no block needs it any more.
        view: Option<Box<TargetView>>,
    },
    /// A message has ended with DN or ER; a run's IN is still TRUE in `view`.
    Finished {
        /// Whose.
        block: BlockId,
        /// Which of its messages.
        shot: u64,
        /// How the block looks; its edges are all of this message.
        view: Box<BlockView>,
        /// What went over the wire.
        exchange: Box<Exchange>,
    },
}

/// What went over the wire for one message.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Exchange {
    /// Message router request, as planned.
    pub request: Arc<[u8]>,
    /// The frame that was written, if it was.
    pub request_frame: Option<Vec<u8>>,
    /// The frame that was read, if one was.
    pub response_frame: Option<Vec<u8>>,
    /// Where the message router reply is in `response_frame`.
    pub response_at: Range<usize>,
}

impl Exchange {
    /// Message router reply, if one came.
    pub fn response(&self) -> Option<&[u8]> {
        let reply = self.response_frame.as_ref()?.get(self.response_at.clone())?;
        (!reply.is_empty()).then_some(reply)
    }
}
