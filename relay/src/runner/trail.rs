//! Where and when the bytes of a connection went: kept for the exchanges of blocks, and told to a recorder.

use std::net::SocketAddr;
use std::sync::{Arc, Mutex};
use std::time::SystemTime;

use cipdeck_shared::engine::LinkId;

use super::Inner;
use super::connect::lock;
use super::driver::Machine;

/// The two ends of a TCP connection.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Ends {
    /// Our end.
    pub local: SocketAddr,
    /// The target's end.
    pub peer: SocketAddr,
}

/// Where one message went, and when its last bytes were written and read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Trace {
    /// The connection that carried it.
    pub(crate) ends: Ends,
    /// When the write began; `None` when nothing was written.
    pub(crate) wrote: Option<SystemTime>,
    /// After the read; `None` when nothing was read.
    pub(crate) read: Option<SystemTime>,
}

/// Which way bytes went.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// From here to the target.
    Out,
    /// From the target.
    In,
}

/// Hears everything that goes over the sockets, in order for each connection. Must not block for long.
pub(crate) trait Tap: Send + Sync + 'static {
    /// A connection has been made.
    fn opened(&self, link: LinkId, ends: Ends);
    /// Bytes have been written, or read.
    fn moved(&self, link: LinkId, direction: Direction, bytes: &[u8], at: SystemTime);
    /// The connection is gone; `direction` says who closed it.
    fn closed(&self, link: LinkId, direction: Direction);
}

/// What is known about one connection.
#[derive(Debug)]
pub(super) struct Trail(Mutex<Trace>);

impl Trail {
    pub(super) fn new(ends: Ends) -> Self {
        Self(Mutex::new(Trace { ends, wrote: None, read: None }))
    }

    /// The next message begins.
    pub(super) fn begin(&self) {
        let mut trace = lock(&self.0);
        (trace.wrote, trace.read) = (None, None);
    }

    pub(super) fn trace(&self) -> Trace {
        *lock(&self.0)
    }

    fn moved(&self, direction: Direction, at: SystemTime) {
        let mut trace = lock(&self.0);
        match direction {
            Direction::Out => trace.wrote = Some(at),
            Direction::In => trace.read = Some(at),
        }
    }
}

/// One open connection: the engine behind it, its trail, and the recorder if there is one.
pub(super) struct Carrier {
    link: LinkId,
    inner: Arc<Inner>,
    trail: Arc<Trail>,
    /// Who has closed it, if it was not us.
    closed_by: Mutex<Direction>,
}

impl Carrier {
    /// Tells everybody about a new connection, the engine last: it may write at once.
    pub(super) fn open(link: LinkId, ends: Ends, inner: &Arc<Inner>) -> Self {
        let trail = Arc::new(Trail::new(ends));
        if let Some(tap) = &inner.tap {
            tap.opened(link, ends);
        }
        let carrier = Self {
            link,
            inner: Arc::clone(inner),
            trail: Arc::clone(&trail),
            closed_by: Mutex::new(Direction::Out),
        };
        inner.with(|state, now| {
            state.trails.insert(link, trail);
            state.engine.connected(link, now);
        });
        carrier
    }

    /// The target has closed it.
    pub(super) fn hung_up(&self) {
        *lock(&self.closed_by) = Direction::In;
    }

    fn moved(&self, direction: Direction, bytes: &[u8], at: SystemTime) {
        self.trail.moved(direction, at);
        if let Some(tap) = &self.inner.tap {
            tap.moved(self.link, direction, bytes, at);
        }
    }
}

impl Drop for Carrier {
    fn drop(&mut self) {
        lock(&self.inner.state).trails.remove(&self.link);
        if let Some(tap) = &self.inner.tap {
            tap.closed(self.link, *lock(&self.closed_by));
        }
    }
}

impl Machine for Carrier {
    fn poll_transmit(&self, link: LinkId, out: &mut Vec<u8>) -> bool {
        self.inner.with(|state, now| state.engine.poll_transmit(link, out, now))
    }

    fn written(&self, _: LinkId, bytes: &[u8], at: SystemTime) {
        self.moved(Direction::Out, bytes, at);
    }

    fn handle_input(&self, link: LinkId, bytes: &[u8]) {
        self.moved(Direction::In, bytes, SystemTime::now());
        self.inner.with(|state, now| state.engine.handle_input(link, bytes, now));
    }
}
