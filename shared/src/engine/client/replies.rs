//! What comes in: a session, a reply, a refusal, or nonsense.

use alloc::vec::Vec;

use crate::engine::block::Input;
use crate::engine::failure::Failure;
use crate::engine::session::Received;
use crate::wire::{DecodeError, DecodeErrorKind, EncapsulationStatus, GeneralStatus, MessageRouterReply};

use super::{Client, Context, Job, Link, Output, Outstanding};

impl Client {
    pub(super) fn received(&mut self, received: Received, cx: &mut Context<'_>) {
        match received {
            Received::Registered => {
                if let Link::Registering(id, session) = core::mem::take(&mut self.link) {
                    self.link = Link::Ready(id, session);
                }
                self.failures = 0;
                self.retry_at = None;
                for job in &self.queue {
                    cx.out.push_back(Output::Block(job.block, Input::ConnectEnded));
                }
            }
            Received::Refused(status) => {
                self.disconnect(cx);
                self.fail_all(&Failure::SessionRefused(status), cx);
            }
            Received::Reply { message, at, frame } => self.replied(message, at, frame, cx),
            Received::Status { status, frame } => self.status(status, frame, cx),
            Received::Malformed { error, frame } => {
                self.disconnect(cx);
                match self.outstanding.take() {
                    Some(outstanding) => fail(&outstanding.job, Failure::Malformed(error), frame, None, cx),
                    None => self.fail_all(&Failure::Malformed(error), cx),
                }
            }
        }
    }

    fn replied(&mut self, message: Vec<u8>, at: usize, frame: Vec<u8>, cx: &mut Context<'_>) {
        let Some(Outstanding { job, .. }) = self.outstanding.take() else { return };
        let asked = job.plan.request().service();
        let input = match MessageRouterReply::decode(&message) {
            Ok(reply) if reply.service != asked => {
                let kind = DecodeErrorKind::Unexpected {
                    field: "service of the reply",
                    found: reply.service.0.into(),
                };
                Err(DecodeError { at, kind })
            }
            Ok(reply) if reply.status == GeneralStatus::Success => {
                Ok(Input::Succeeded { data: reply.data.to_vec(), size: job.plan.res_data_size() })
            }
            Ok(reply) => {
                let words = reply.additional.words().collect();
                Ok(Input::Failed(Failure::RefusedByDevice(reply.status, words)))
            }
            Err(error) => Err(error.shifted(at)),
        };
        match input {
            Ok(input) => {
                cx.out.push_back(Output::Read(job.block, frame, Some(message)));
                cx.out.push_back(Output::Block(job.block, input));
            }
            Err(error) => {
                self.disconnect(cx);
                fail(&job, Failure::Malformed(error), frame, Some(message), cx);
            }
        }
    }

    fn status(&mut self, status: EncapsulationStatus, frame: Vec<u8>, cx: &mut Context<'_>) {
        let Some(Outstanding { mut job, .. }) = self.outstanding.take() else { return };
        if status == EncapsulationStatus::InvalidSessionHandle && !job.resent {
            job.resent = true;
            self.queue.push_front(job);
            return self.disconnect(cx);
        }
        fail(&job, Failure::EncapsulationStatus(status), frame, None, cx);
    }
}

fn fail(job: &Job, failure: Failure, frame: Vec<u8>, message: Option<Vec<u8>>, cx: &mut Context<'_>) {
    cx.out.push_back(Output::Read(job.block, frame, message));
    cx.out.push_back(Output::Block(job.block, Input::Failed(failure)));
}
