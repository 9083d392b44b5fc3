//! One endpoint: its TCP connection, its session, and one request outstanding at a time.

mod replies;

use alloc::collections::VecDeque;
use alloc::string::String;
use alloc::sync::Arc;
use alloc::vec::Vec;

use crate::config::BlockId;
use crate::plan::MessagePlan;
use crate::wire::{SenderContext, UnconnectedMessage};

use crate::engine::block::Input;
use crate::engine::event::{LinkId, Wants};
use crate::engine::failure::{ConnectError, Failure};
use crate::engine::session::Session;
use crate::engine::time::{Instant, Millis};

/// First delay after a failed connect; doubled up to [`MAX_BACK_OFF`].
const MIN_BACK_OFF: Millis = Millis(250);

/// Longest delay between attempts of cyclic messages.
const MAX_BACK_OFF: Millis = Millis(5_000);

/// How long the target has for closing the connection after UnRegisterSession.
const CLOSING_TIME: Millis = Millis(500);

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
    /// The target closes the connection; [`Client::drop_closing`] is due then.
    Closing(LinkId, Instant),
    Transmit(LinkId),
    Wants(Wants),
    Block(BlockId, Input),
    /// Frames for the block's exchange: written, read, and the reply's message router bytes.
    Wrote(BlockId, Vec<u8>),
    Read(BlockId, Vec<u8>, Option<Vec<u8>>),
}

/// What every call needs.
pub(super) struct Context<'a> {
    pub(super) now: Instant,
    pub(super) next_link: &'a mut u64,
    pub(super) out: &'a mut VecDeque<Output>,
}

#[derive(Debug, Default)]
pub(super) struct Client {
    link: Link,
    queue: VecDeque<Job>,
    /// The block and shot whose permission has been asked for.
    asking: Option<(BlockId, u64)>,
    outstanding: Option<Outstanding>,
    /// Bytes for the socket.
    transmit: Vec<u8>,
    next_context: u64,
    failures: u32,
    retry_at: Option<Instant>,
    last_used: Instant,
    /// Whether the controller's limits count this session.
    pub(super) controller: bool,
    dropped: u64,
}

#[derive(Debug, Default)]
enum Link {
    #[default]
    None,
    Connecting(LinkId),
    Registering(LinkId, Session),
    Ready(LinkId, Session),
    Closing(LinkId),
}

#[derive(Debug)]
struct Outstanding {
    job: Job,
    context: SenderContext,
    /// The request's bytes have been handed out: never again for this job.
    written: bool,
}

impl Client {
    pub(super) fn submit(&mut self, job: Job, cx: &mut Context<'_>) {
        self.last_used = cx.now;
        cx.out.push_back(Output::Block(job.block, Input::BufferGranted));
        if matches!(self.link, Link::Connecting(_) | Link::Registering(..)) {
            cx.out.push_back(Output::Block(job.block, Input::ConnectStarted));
        }
        self.queue.push_back(job);
        self.advance(cx);
    }

    /// The block's message has ended, here or elsewhere: forget it.
    pub(super) fn withdraw(&mut self, block: BlockId, cx: &mut Context<'_>) {
        if let Some(outstanding) = self.outstanding.take_if(|outstanding| outstanding.job.block == block) {
            if outstanding.written {
                // Its answer may still come: it must never meet another request.
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

    pub(super) fn connected(&mut self, cx: &mut Context<'_>) {
        if let Link::Connecting(id) = self.link {
            self.transmit.clear();
            let context = self.fresh_context();
            self.link = Link::Registering(id, Session::register(context, &mut self.transmit));
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
        self.link = Link::None;
        self.transmit.clear();
        self.asking = None;
        match self.outstanding.take() {
            Some(Outstanding { job, written: true, .. }) => {
                cx.out.push_back(Output::Block(job.block, Input::Failed(Failure::Closed)));
            }
            Some(Outstanding { job, written: false, .. }) => self.queue.push_front(job),
            None => {}
        }
        if was_registering {
            self.fail_all(&Failure::Closed, cx);
        }
        self.advance(cx);
    }

    pub(super) fn permit(&mut self, wants: &Wants, allowed: bool, cx: &mut Context<'_>) {
        let Link::Ready(id, session) = &self.link else { return };
        if *id != wants.link || self.asking != Some((wants.block, wants.shot)) {
            return;
        }
        self.asking = None;
        let Some(job) = self.queue.pop_front() else { return };
        if !allowed {
            cx.out.push_back(Output::Block(job.block, Input::Failed(Failure::NotPermitted)));
            return self.advance(cx);
        }
        let request = job.plan.request().bytes();
        // A plan's request fits into a message: `MessageRouterRequest::new` has checked it.
        if let Ok(message) = UnconnectedMessage::new(&request) {
            self.next_context += 1;
            let context = SenderContext::from(self.next_context);
            session.send(message, context, timeout_s(&job.plan), &mut self.transmit);
            self.outstanding = Some(Outstanding { job, context, written: false });
            cx.out.push_back(Output::Transmit(*id));
        }
    }

    /// Appends what is to be written. From here on the request counts as sent.
    pub(super) fn poll_transmit(&mut self, out: &mut Vec<u8>, cx: &mut Context<'_>) -> bool {
        if self.transmit.is_empty() {
            return false;
        }
        if let Some(outstanding) = self.outstanding.as_mut().filter(|outstanding| !outstanding.written) {
            outstanding.written = true;
            if let Link::Ready(_, session) = &mut self.link {
                session.expect(outstanding.context);
            }
            let block = outstanding.job.block;
            cx.out.push_back(Output::Wrote(block, self.transmit.clone()));
            cx.out.push_back(Output::Block(block, Input::Written));
        }
        out.append(&mut self.transmit);
        true
    }

    pub(super) fn handle_input(&mut self, bytes: &[u8], cx: &mut Context<'_>) {
        self.last_used = cx.now;
        if let Link::Registering(_, session) | Link::Ready(_, session) = &mut self.link {
            session.receive(bytes);
            self.dropped += session.take_dropped();
        }
        while let Link::Registering(_, session) | Link::Ready(_, session) = &mut self.link {
            let Some(received) = session.poll() else { break };
            self.received(received, cx);
        }
        self.advance(cx);
    }

    /// Ends an idle session; the target closes the connection.
    pub(super) fn close(&mut self, cx: &mut Context<'_>) {
        if !self.is_idle() {
            return;
        }
        let context = self.fresh_context();
        match core::mem::take(&mut self.link) {
            Link::Ready(id, session) => {
                session.unregister(context, &mut self.transmit);
                self.link = Link::Closing(id);
                cx.out.push_back(Output::Transmit(id));
                cx.out.push_back(Output::Closing(id, cx.now + CLOSING_TIME));
            }
            Link::Connecting(id) | Link::Registering(id, _) => cx.out.push_back(Output::Disconnect(id)),
            link => self.link = link,
        }
    }

    /// The target has not closed the connection in its time.
    pub(super) fn drop_closing(&mut self, cx: &mut Context<'_>) {
        if let Link::Closing(_) = self.link {
            self.disconnect(cx);
        }
    }

    /// Cyclic messages wait until then.
    pub(super) fn retry_at(&self, now: Instant) -> Option<Instant> {
        self.retry_at.filter(|at| *at > now)
    }

    pub(super) const fn link_id(&self) -> Option<LinkId> {
        match &self.link {
            Link::None => None,
            Link::Connecting(id) | Link::Registering(id, _) | Link::Ready(id, _) | Link::Closing(id) => {
                Some(*id)
            }
        }
    }

    /// Whether a session is there or being made.
    pub(super) const fn holds_session(&self) -> bool {
        matches!(self.link, Link::Connecting(_) | Link::Registering(..) | Link::Ready(..))
    }

    pub(super) fn is_idle(&self) -> bool {
        self.queue.is_empty() && self.outstanding.is_none()
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

    fn advance(&mut self, cx: &mut Context<'_>) {
        let Some(job) = self.queue.front() else { return };
        match &self.link {
            Link::None | Link::Closing(_) => {
                self.disconnect(cx);
                *cx.next_link += 1;
                let id = LinkId(*cx.next_link);
                self.link = Link::Connecting(id);
                for job in &self.queue {
                    cx.out.push_back(Output::Block(job.block, Input::ConnectStarted));
                }
                cx.out.push_back(Output::Connect(id));
            }
            Link::Ready(link, _) if self.outstanding.is_none() && self.asking.is_none() => {
                let wants = Wants { block: job.block, shot: job.shot, revision: job.revision, link: *link };
                self.asking = Some((job.block, job.shot));
                cx.out.push_back(Output::Wants(wants));
            }
            _ => {}
        }
    }

    fn disconnect(&mut self, cx: &mut Context<'_>) {
        if let Some(id) = self.link_id() {
            cx.out.push_back(Output::Disconnect(id));
        }
        self.link = Link::None;
        self.transmit.clear();
        self.asking = None;
    }

    /// Nothing can be sent: everybody who waits for this endpoint hears why.
    fn fail_all(&mut self, failure: &Failure, cx: &mut Context<'_>) {
        let delay = MIN_BACK_OFF.0 << self.failures.min(5);
        self.failures = self.failures.saturating_add(1);
        self.retry_at = Some(cx.now + Millis(delay.min(MAX_BACK_OFF.0)));
        for job in self.queue.drain(..) {
            cx.out.push_back(Output::Block(job.block, Input::Failed(failure.clone())));
        }
    }

    fn fresh_context(&mut self) -> SenderContext {
        self.next_context += 1;
        SenderContext::from(self.next_context)
    }
}

/// The target's own time limit: ours in whole seconds, rounded up.
fn timeout_s(plan: &MessagePlan) -> u16 {
    u16::try_from(plan.ucmm_timeout_ms().div_ceil(1_000)).unwrap_or(u16::MAX)
}
