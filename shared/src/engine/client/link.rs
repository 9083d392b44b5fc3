//! The TCP connection comes, carries bytes, and goes.

use alloc::string::String;
use alloc::vec::Vec;

use crate::engine::block::Input;
use crate::engine::failure::{ConnectError, Failure};
use crate::engine::session::Session;
use crate::engine::time::{Instant, Millis};

use super::{Client, Context, Link, Output, Outstanding, What};

/// First delay after a failed connect; doubled up to [`MAX_BACK_OFF`].
const MIN_BACK_OFF: Millis = Millis(250);

/// Longest delay between attempts of cyclic messages.
const MAX_BACK_OFF: Millis = Millis(5_000);

impl Client {
    pub(in crate::engine) fn connected(&mut self, cx: &mut Context<'_>) {
        if let Link::Connecting(id) = self.link {
            self.transmit.clear();
            let context = self.fresh_context();
            self.link = Link::Registering(id, Session::register(context, &mut self.transmit));
            self.changed = true;
            cx.out.push_back(Output::Transmit(id));
        }
    }

    pub(in crate::engine) fn connect_failed(
        &mut self,
        error: ConnectError,
        detail: &str,
        cx: &mut Context<'_>,
    ) {
        if matches!(self.link, Link::Connecting(_)) {
            self.link = Link::None;
            self.fail_all(&Failure::NotConnected(error, String::from(detail)), cx);
        }
    }

    pub(in crate::engine) fn closed(&mut self, cx: &mut Context<'_>) {
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

    /// Appends what is to be written. From here on the request counts as sent.
    pub(in crate::engine) fn poll_transmit(&mut self, out: &mut Vec<u8>, cx: &mut Context<'_>) -> bool {
        if self.transmit.is_empty() {
            return false;
        }
        if let Some(outstanding) = self.outstanding.as_mut().filter(|outstanding| !outstanding.written) {
            outstanding.written = true;
            if let Link::Ready(_, session) = &mut self.link {
                session.expect(outstanding.expected);
            }
            if let What::Message(job, _) = &outstanding.what {
                let deadline = job.plan.connection().map(|open| cx.now.deadline(open.timeout_ms));
                cx.out.push_back(Output::Wrote(job.block, self.transmit.clone()));
                cx.out.push_back(Output::Block(job.block, Input::Written { deadline }));
            }
        }
        out.append(&mut self.transmit);
        true
    }

    pub(in crate::engine) fn handle_input(&mut self, bytes: &[u8], cx: &mut Context<'_>) {
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

    pub(super) fn disconnect(&mut self, cx: &mut Context<'_>) {
        if let Some(id) = self.link_id() {
            cx.out.push_back(Output::Disconnect(id));
        }
        self.forget_link();
    }

    /// The socket is gone, and everything that lived on it.
    pub(super) fn forget_link(&mut self) {
        self.changed |= self.link_id().is_some();
        self.link = Link::None;
        self.lose_connections();
        self.controller &= !self.is_idle();
        self.known.identity = None;
        self.transmit.clear();
        self.asking = None;
    }

    pub(super) fn back_off(&mut self, now: Instant) {
        let delay = MIN_BACK_OFF.0 << self.failures.min(5);
        self.failures = self.failures.saturating_add(1);
        self.retry_at = Some(now + Millis(delay.min(MAX_BACK_OFF.0)));
    }
}
