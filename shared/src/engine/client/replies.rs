//! What comes in: a session, a reply, a refusal, or nonsense.

use alloc::vec::Vec;
use core::ops::Range;

use crate::config::Profile;
use crate::engine::block::Input;
use crate::engine::connection::{Opened, Opening};
use crate::engine::failure::Failure;
use crate::engine::session::Received;
use crate::engine::status::{Phase, RefusedBy};
use crate::wire::{
    ConnectionId, DecodeError, DecodeErrorKind, EncapsulationStatus, GeneralStatus, MessageRouterReply,
    RouterRefusal, ServiceCode,
};

use crate::config::BlockId;

use super::{Client, Context, Job, Link, Output, Outstanding, What};

/// A frame, and where the message router reply is in it.
struct Reply {
    frame: Vec<u8>,
    message: Range<usize>,
}

impl Reply {
    fn decode(&self) -> Result<MessageRouterReply<'_>, DecodeError> {
        let message = self.frame.get(self.message.clone()).unwrap_or_default();
        MessageRouterReply::decode(message).map_err(|error| error.shifted(self.message.start))
    }

    const fn at(&self) -> usize {
        self.message.start
    }
}

impl Client {
    pub(super) fn received(&mut self, received: Received, cx: &mut Context<'_>) {
        match received {
            Received::Registered => {
                if let Link::Registering(id, session) = core::mem::take(&mut self.link) {
                    self.link = Link::Ready(id, session);
                }
                self.failures = 0;
                self.retry_at = None;
                self.changed = true;
                for job in &self.queue {
                    cx.out.push_back(Output::Block(job.block, Input::ConnectEnded));
                }
            }
            Received::Refused(status) => {
                self.disconnect(cx);
                self.fail_all(&Failure::SessionRefused(status), cx);
            }
            Received::Identity(item) => {
                self.outstanding.take_if(|outstanding| matches!(outstanding.what, What::Identify));
                let profile =
                    item.map(|item| Profile::of_identity(item.vendor, item.device_type, item.name.bytes()));
                self.identified(profile, cx);
            }
            Received::Reply { frame, message, id } => {
                self.answers();
                self.replied(Reply { frame, message }, id, cx);
            }
            Received::Status { status, frame } => {
                self.answers();
                self.status(status, frame, cx);
            }
            Received::Dropped => self.drop_frame(cx),
            Received::Malformed { error, frame } => self.malformed(error, frame, cx),
        }
    }

    /// The target answers: whatever was wrong with it is over.
    fn answers(&mut self) {
        self.changed |= self.error.take().is_some();
    }

    fn drop_frame(&mut self, cx: &mut Context<'_>) {
        self.dropped += 1;
        match self.outstanding.as_ref().and_then(|outstanding| outstanding.what.block()) {
            Some(block) => cx.out.push_back(Output::Block(block, Input::ReplyDropped)),
            // Without contexts the next reply could not be told from another one like this.
            None if self.session().is_some_and(crate::engine::session::Session::has_no_context) => {
                self.outstanding = None;
                self.disconnect(cx);
            }
            None => {}
        }
    }

    fn malformed(&mut self, error: DecodeError, frame: Vec<u8>, cx: &mut Context<'_>) {
        self.disconnect(cx);
        match self.outstanding.take().map(|outstanding| outstanding.what) {
            Some(What::Message(job, _)) => fail(job.block, Failure::Malformed(error), frame, NO_REPLY, cx),
            Some(What::Open(block, _)) => {
                cx.out.push_back(Output::Read(block, frame, NO_REPLY));
                self.fail_first(block, Failure::Malformed(error), cx);
            }
            Some(What::Close | What::Identify | What::KeepAlive(_)) => {}
            None => self.fail_all(&Failure::Malformed(error), cx),
        }
        self.error = Some(Failure::Malformed(error).cause(Phase::Connecting));
    }

    fn replied(&mut self, reply: Reply, id: Option<ConnectionId>, cx: &mut Context<'_>) {
        let Some(Outstanding { what, .. }) = self.outstanding.take() else { return };
        match what {
            What::Message(job, connection) => {
                self.learn(connection, id, cx);
                self.message_replied(&job, connection, reply, cx);
            }
            What::Open(block, opening) => self.open_replied(block, opening, reply, cx),
            What::KeepAlive(connection) => self.learn(connection, id, cx),
            What::Close | What::Identify => {}
        }
    }

    /// What the connection's replies carry is known from the first one on.
    fn learn(&mut self, serial: Option<u16>, id: Option<ConnectionId>, cx: &Context<'_>) {
        let connection =
            self.connections.iter_mut().find(|connection| Some(connection.triad.serial) == serial);
        if let (Some(connection), Some(id)) = (connection, id) {
            connection.ids.echoed = Some(id);
            connection.last_used = cx.now;
            connection.requests += 1;
            let own = id == connection.ids.o_t && id != connection.ids.t_o;
            self.changed |= own != self.known.own_connection_id;
            self.known.own_connection_id = own;
        }
    }

    fn message_replied(&mut self, job: &Job, connection: Option<u16>, reply: Reply, cx: &mut Context<'_>) {
        let asked = job.plan.request().service();
        let routed = connection.is_none() && !job.plan.routed(self.profile_for(&job.plan)).route().is_empty();
        self.last_message = cx.now;
        let input = match reply.decode() {
            Ok(answer) if answer.service == asked && answer.status == GeneralStatus::Success => {
                let additional = u16::try_from(answer.additional.words().len()).unwrap_or(u16::MAX);
                let size = job.plan.res_data_size(additional);
                Ok(Input::Succeeded { data: answer.data.to_vec(), size })
            }
            Ok(answer) if answer.service == asked => {
                let words = answer.additional.words().collect();
                Ok(Input::Failed(Failure::RefusedByDevice(answer.status, words)))
            }
            Ok(answer) if routed && is_of_the_router(&answer) => {
                Ok(Input::Failed(refused_on_the_way(RefusedBy::Router, &answer)))
            }
            Ok(answer) => Err(wrong_service(&answer, reply.at())),
            Err(error) => Err(error),
        };
        match input {
            Ok(input) => {
                self.complete(job, connection, cx);
                cx.out.push_back(Output::Read(job.block, reply.frame, reply.message));
                cx.out.push_back(Output::Block(job.block, input));
            }
            Err(error) => {
                self.disconnect(cx);
                self.error = Some(Failure::Malformed(error).cause(Phase::Connecting));
                fail(job.block, Failure::Malformed(error), reply.frame, reply.message, cx);
            }
        }
    }

    /// The message has been answered: its connection stays for its time, or is closed after the last one of its users.
    fn complete(&mut self, job: &Job, serial: Option<u16>, cx: &mut Context<'_>) {
        let Some(plan) = job.plan.connection() else { return };
        let others = self.connections.len() > 1 || !self.queue.is_empty();
        let connection =
            self.connections.iter_mut().find(|connection| Some(connection.triad.serial) == serial);
        let Some(connection) = connection else { return };
        connection.idle = job.plan.idle_ms().into();
        connection.close_wanted |= plan.close;
        if !connection.close_wanted {
            return;
        }
        let route = connection.route.clone();
        if !self.is_wanted(&route) {
            self.ending |= !others;
            cx.out.push_back(Output::Block(job.block, Input::Closing { session: !others }));
        }
    }

    fn open_replied(&mut self, block: BlockId, opening: Opening, reply: Reply, cx: &mut Context<'_>) {
        let close = opening.close_request();
        let answer = match reply.decode() {
            Ok(answer) if answer.service == opening.service() => answer,
            other => {
                self.lost.extend(close);
                let error = other.map_or_else(|error| error, |answer| wrong_service(&answer, reply.at()));
                return self.malformed_open(block, error, &reply, cx);
            }
        };
        match opening.answered(&answer, cx.originator, cx.now) {
            Opened::Yes(connection) => {
                self.connections.push(connection);
                self.changed = true;
                cx.out.push_back(Output::Block(block, Input::ConnectEnded));
            }
            Opened::Again(opening) => self.open(opening, cx),
            Opened::No if answer.status == GeneralStatus::Success => {
                self.lost.extend(close);
                let kind = DecodeErrorKind::Unexpected { field: "connection in the reply", found: 0 };
                self.malformed_open(block, DecodeError { at: reply.at(), kind }, &reply, cx);
            }
            Opened::No => {
                let failure = refused_on_the_way(RefusedBy::ForwardOpen, &answer);
                cx.out.push_back(Output::Read(block, reply.frame, reply.message));
                self.fail_first(block, failure, cx);
            }
        }
    }

    fn malformed_open(&mut self, block: BlockId, error: DecodeError, reply: &Reply, cx: &mut Context<'_>) {
        self.disconnect(cx);
        self.error = Some(Failure::Malformed(error).cause(Phase::Connecting));
        cx.out.push_back(Output::Read(block, reply.frame.clone(), reply.message.clone()));
        self.fail_first(block, Failure::Malformed(error), cx);
    }

    fn status(&mut self, status: EncapsulationStatus, frame: Vec<u8>, cx: &mut Context<'_>) {
        let Some(Outstanding { what, .. }) = self.outstanding.take() else { return };
        let unknown_session = status == EncapsulationStatus::InvalidSessionHandle;
        match what {
            What::Message(mut job, _) if unknown_session && !job.resent => {
                job.resent = true;
                self.queue.push_front(job);
                self.disconnect(cx);
            }
            What::Message(job, connection) => {
                self.complete(&job, connection, cx);
                fail(job.block, Failure::EncapsulationStatus(status), frame, NO_REPLY, cx);
            }
            What::Open(block, _) => {
                if let Some(job) = self.queue.front_mut().filter(|job| unknown_session && !job.resent) {
                    job.resent = true;
                    return self.disconnect(cx);
                }
                cx.out.push_back(Output::Read(block, frame, NO_REPLY));
                self.fail_first(block, Failure::EncapsulationStatus(status), cx);
            }
            What::KeepAlive(_) if unknown_session => self.disconnect(cx),
            What::Close | What::Identify | What::KeepAlive(_) => {}
        }
    }
}

/// An error that a router on the way gives: the target's own reply would be of the inner service.
fn is_of_the_router(answer: &MessageRouterReply<'_>) -> bool {
    answer.service == ServiceCode::UnconnectedSend && answer.status != GeneralStatus::Success
}

fn refused_on_the_way(by: RefusedBy, answer: &MessageRouterReply<'_>) -> Failure {
    Failure::RefusedOnTheWay {
        by,
        status: answer.status,
        words: answer.additional.words().collect(),
        remaining_path: RouterRefusal::decode(answer.service, answer.data).remaining_path,
    }
}

fn wrong_service(answer: &MessageRouterReply<'_>, at: usize) -> DecodeError {
    let found = answer.service.0.into();
    DecodeError { at, kind: DecodeErrorKind::Unexpected { field: "service of the reply", found } }
}

/// The frame has no message router reply that could be shown.
const NO_REPLY: Range<usize> = 0..0;

fn fail(block: BlockId, failure: Failure, frame: Vec<u8>, message: Range<usize>, cx: &mut Context<'_>) {
    cx.out.push_back(Output::Read(block, frame, message));
    cx.out.push_back(Output::Block(block, Input::Failed(failure)));
}
