//! One TCP connection to a simulated device.

use alloc::vec::Vec;

use crate::engine::time::Instant;
use crate::wire::Deframer;

use super::device::Device;
use super::session::Session;

/// The device's end of one TCP connection. Give it what arrives; send what it hands out; close when it says so.
///
/// Memory is bounded: an unfinished frame, one read, and 256 KiB of replies that nobody fetches, after which
/// the connection is given up.
#[derive(Debug, Default)]
pub struct SimConnection {
    deframer: Deframer,
    session: Session,
}

impl SimConnection {
    /// A connection that has just been accepted.
    pub fn new() -> Self {
        Self::default()
    }

    /// Takes what arrived, cut in any way.
    pub fn handle_input(&mut self, device: &mut Device, bytes: &[u8], now: Instant) {
        if self.session.outbox.is_closing() {
            return;
        }
        self.deframer.push(bytes);
        while !self.session.outbox.is_closing() {
            match self.deframer.next_frame() {
                Ok(Some(frame)) => self.session.handle_frame(device, &frame, now),
                Ok(None) => return,
                // The length cannot be trusted, so nothing after it can.
                Err(_) => self.session.outbox.close(now),
            }
        }
    }

    /// Appends the replies that are due; false if there are none. They are in the order of their requests, but for
    /// those that wait for a device behind a router.
    pub fn poll_transmit(&mut self, out: &mut Vec<u8>, now: Instant) -> bool {
        self.session.outbox.poll(out, now)
    }

    /// When [`Self::poll_transmit`] has something next.
    pub fn poll_timeout(&self) -> Option<Instant> {
        self.session.outbox.next_due()
    }

    /// Whether the device closes the socket now: everything it had to say has been handed out.
    pub fn is_closed(&self) -> bool {
        self.session.outbox.is_closed()
    }
}
