//! Replies on their way out.

use alloc::collections::VecDeque;
use alloc::vec::Vec;

use crate::engine::time::{Instant, Millis};

/// The replies of one TCP connection, sorted by when they are due.
#[derive(Debug, Default)]
pub(super) struct Outbox {
    replies: VecDeque<Reply>,
    /// Bytes in `replies`.
    waiting: usize,
    /// When the device is done with the last request: the next one cannot overtake it.
    busy_until: Instant,
    closing: bool,
    /// After half a frame nothing else is sent.
    mute: bool,
}

#[derive(Debug)]
struct Reply {
    due: Instant,
    bytes: Vec<u8>,
}

const MAX_WAITING: usize = 256 * 1024;

impl Outbox {
    /// Works on a request for so long.
    pub(super) fn work(&mut self, delay: Millis, now: Instant) {
        self.busy_until = self.busy_until.max(now) + delay;
    }

    /// Sends when the work is done, and after a wait that holds up nothing else: later replies may overtake.
    pub(super) fn send(&mut self, bytes: Vec<u8>, wait: Millis, now: Instant) {
        if self.mute || self.closing {
            return;
        }
        self.busy_until = self.busy_until.max(now);
        let due = self.busy_until + wait;
        self.waiting += bytes.len();
        let place = self.replies.partition_point(|reply| reply.due <= due);
        self.replies.insert(place, Reply { due, bytes });
        if self.waiting > MAX_WAITING {
            self.close(now);
        }
    }

    /// Sends this, and nothing after it.
    pub(super) fn send_last(&mut self, bytes: Vec<u8>, now: Instant) {
        self.forget_waiting(now);
        self.send(bytes, Millis(0), now);
        self.mute = true;
    }

    /// Sends what is done, then closes.
    pub(super) fn close(&mut self, now: Instant) {
        self.forget_waiting(now);
        self.closing = true;
    }

    /// Forgets what only waits.
    fn forget_waiting(&mut self, now: Instant) {
        let done = self.busy_until.max(now);
        self.replies.truncate(self.replies.partition_point(|reply| reply.due <= done));
        self.waiting = self.replies.iter().map(|reply| reply.bytes.len()).sum();
    }

    /// Appends what is due; false if that is nothing.
    pub(super) fn poll(&mut self, out: &mut Vec<u8>, now: Instant) -> bool {
        let before = out.len();
        while let Some(reply) = self.replies.pop_front_if(|reply| reply.due <= now) {
            self.waiting -= reply.bytes.len();
            out.extend_from_slice(&reply.bytes);
        }
        out.len() > before
    }

    /// When something is due next.
    pub(super) fn next_due(&self) -> Option<Instant> {
        self.replies.front().map(|reply| reply.due)
    }

    pub(super) const fn is_closing(&self) -> bool {
        self.closing
    }

    /// Closing, and nothing is left to say.
    pub(super) fn is_closed(&self) -> bool {
        self.closing && self.replies.is_empty()
    }
}
