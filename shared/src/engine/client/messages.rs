//! A message comes, is sent once it is permitted, or ends before.

use crate::config::BlockId;
use crate::plan::MessagePlan;
use crate::plan::limits::FOR_EVER;
use crate::wire::UnconnectedMessage;

use crate::engine::block::Input;
use crate::engine::event::Wants;
use crate::engine::failure::Failure;
use crate::engine::matching::Expected;
use crate::engine::status::{Cause, Phase};
use crate::engine::time::Millis;

use super::{Client, Context, Job, Link, Output, Outstanding, What};

impl Client {
    pub(in crate::engine) fn submit(&mut self, job: Job, cx: &mut Context<'_>) {
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
    pub(in crate::engine) fn withdraw(
        &mut self,
        block: BlockId,
        silence: Option<&Cause>,
        cx: &mut Context<'_>,
    ) {
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
        self.asking.take_if(|asking| asking.block == block);
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

    pub(in crate::engine) fn permit(
        &mut self,
        wants: &Wants,
        verdict: Result<(), &str>,
        cx: &mut Context<'_>,
    ) {
        let Link::Ready(id, _) = &self.link else { return };
        if *id != wants.link || self.asking != Some(*wants) {
            return;
        }
        self.asking = None;
        let Some(mut job) = self.queue.pop_front() else { return };
        let Err(why) = verdict else {
            if !wants.opens {
                return self.send(job, cx);
            }
            job.may_open = true;
            self.queue.push_front(job);
            return self.advance(cx);
        };
        let failure = Failure::NotPermitted(why.into());
        cx.out.push_back(Output::Block(job.block, Input::Failed(failure)));
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
            let transmit = &mut self.transmit;
            let expected = session.send_connected(job.plan.bytes(), context, connection, cx.now, transmit);
            (expected, Some(connection.triad.serial))
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

    /// Nothing can be sent: everybody who waits for this endpoint hears why.
    pub(super) fn fail_all(&mut self, failure: &Failure, cx: &mut Context<'_>) {
        self.back_off(cx.now);
        self.error = Some(failure.cause(Phase::Connecting));
        self.changed = true;
        for job in self.queue.drain(..) {
            cx.out.push_back(Output::Block(job.block, Input::Failed(failure.clone())));
        }
    }

    /// The message that is first in the queue cannot be sent.
    pub(super) fn fail_first(&mut self, block: BlockId, failure: Failure, cx: &mut Context<'_>) {
        if self.queue.pop_front_if(|job| job.block == block).is_some() {
            cx.out.push_back(Output::Block(block, Input::Failed(failure)));
        }
    }
}

/// The target's own time limit: ours in whole seconds, rounded up; 0 without one.
pub(super) fn timeout_s(plan: &MessagePlan) -> u16 {
    match plan.ucmm_timeout_ms() {
        // OpENer encap.h: 0 leaves it to CIP.
        FOR_EVER => 0,
        ms => u16::try_from(ms.div_ceil(1_000)).unwrap_or(u16::MAX),
    }
}
