//! What is done next: connect, find out who it is, open or close a connection, or ask for permission to send.

use alloc::sync::Arc;

use crate::config::Profile;
use crate::plan::MessagePlan;
use crate::wire::{RequestTimeout, UnconnectedMessage};

use crate::engine::block::Input;
use crate::engine::connection::Opening;
use crate::engine::event::{LinkId, Wants};
use crate::engine::matching::Expected;
use crate::engine::session::Session;
use crate::engine::time::Instant;

use super::messages::timeout_s;
use super::{Client, Context, Job, Link, Output, Outstanding, What};

impl Client {
    pub(super) fn advance(&mut self, cx: &mut Context<'_>) {
        if self.outstanding.is_some() || self.asking.is_some() {
            return;
        }
        match &self.link {
            Link::None | Link::Closing(..) if !self.queue.is_empty() => self.connect(cx),
            Link::Ready(..) => self.next(cx),
            _ => {}
        }
    }

    fn connect(&mut self, cx: &mut Context<'_>) {
        self.disconnect(cx);
        *cx.next_link += 1;
        let id = LinkId(*cx.next_link);
        self.link = Link::Connecting(id);
        self.changed = true;
        for job in &self.queue {
            cx.out.push_back(Output::Block(job.block, Input::ConnectStarted));
        }
        cx.out.push_back(Output::Connect(id));
    }

    fn next(&mut self, cx: &mut Context<'_>) {
        if let Some(unwanted) = self.unwanted_connection() {
            return self.close_connection(unwanted, cx);
        }
        let Some(job) = self.queue.front() else {
            if self.ending {
                self.unregister(cx);
            }
            return;
        };
        let (block, plan, may_open) = (job.block, Arc::clone(&job.plan), job.may_open);
        if self.known.identity.is_none() && !self.known.anonymous && needs_identity(&plan) {
            if !may_open {
                return self.ask(true, cx);
            }
            cx.out.push_back(Output::Block(block, Input::ConnectStarted));
            return self.identify(cx);
        }
        if plan.connection().is_some() {
            let profile = self.profile_for(&plan);
            let route = plan.routed(profile).route();
            match self.connections.iter().position(|connection| connection.route == *route) {
                Some(index)
                    if self
                        .connections
                        .get(index)
                        .is_some_and(|open| !open.fits(&plan) || open.is_stale(cx.now)) =>
                {
                    return self.close_connection(index, cx);
                }
                Some(_) => {}
                None if !may_open => return self.ask(true, cx),
                None => {
                    cx.out.push_back(Output::Block(block, Input::ConnectStarted));
                    if self.close_lost(cx) {
                        return;
                    }
                    let opening = Opening::new(&plan, profile, cx.originator);
                    return self.open(opening, cx);
                }
            }
        }
        self.ask(false, cx);
    }

    fn ask(&mut self, opens: bool, cx: &mut Context<'_>) {
        let (Link::Ready(link, _), Some(job)) = (&self.link, self.queue.front()) else { return };
        let Job { block, shot, revision, .. } = *job;
        let wants = Wants { block, shot, revision, link: *link, opens };
        self.asking = Some(wants);
        cx.out.push_back(Output::Wants(wants));
    }

    /// Sends Forward_Open for the first message of the queue.
    pub(super) fn open(&mut self, opening: Opening, cx: &mut Context<'_>) {
        let Some(job) = self.queue.front() else { return };
        let (block, seconds) = (job.block, timeout_s(&job.plan));
        let timeout = RequestTimeout::at_least(job.plan.ucmm_timeout_ms());
        // The size is one that the service can say, and the path is short.
        if let Ok(request) = opening.request(timeout) {
            self.send_own(What::Open(block, opening), &request, seconds, None, cx);
        }
    }

    /// Sends an unconnected request of our own.
    pub(super) fn send_own(
        &mut self,
        what: What,
        request: &[u8],
        timeout_s: u16,
        deadline: Option<Instant>,
        cx: &mut Context<'_>,
    ) {
        let context = self.fresh_context();
        let (Link::Ready(id, session), Ok(message)) = (&self.link, UnconnectedMessage::new(request)) else {
            return;
        };
        session.send_unconnected(message, context, timeout_s, &mut self.transmit);
        let expected = Expected::Unconnected(context);
        self.outstanding = Some(Outstanding { what, expected, written: false, deadline });
        cx.out.push_back(Output::Transmit(*id));
    }

    /// What this plan's target is: what it is said to be, what it says itself, or nothing special.
    pub(super) fn profile_for(&self, plan: &MessagePlan) -> Profile {
        match plan.profile() {
            Profile::Auto => self.known.identity.unwrap_or(Profile::Generic),
            given => given,
        }
    }

    pub(super) const fn session(&self) -> Option<&Session> {
        match &self.link {
            Link::Ready(_, session) => Some(session),
            _ => None,
        }
    }
}

/// Whether it matters what kind of device it is.
fn needs_identity(plan: &MessagePlan) -> bool {
    plan.profile() == Profile::Auto && (plan.connection().is_some() || plan.ways_differ())
}
