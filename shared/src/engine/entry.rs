//! One block inside the engine: its machine, its trigger, and the message that is under way.

use alloc::string::{String, ToString};
use alloc::sync::Arc;
use alloc::vec::Vec;

use crate::config::Channel;
use crate::plan::{Finding, MessagePlan, Severity};

use super::block::{BlockView, Input, MsgBlock};
use super::client::ClientId;
use super::event::Exchange;
use super::failure::Failure;
use super::management::Words;
use super::status::StatusBits;
use super::time::Instant;
use super::trigger::Trigger;

/// Edges that are kept of one message.
const MAX_EDGES: usize = 16;

#[derive(Debug)]
pub(super) struct Entry {
    pub(super) revision: u64,
    pub(super) plan: Result<Arc<MessagePlan>, Invalid>,
    pub(super) block: MsgBlock,
    pub(super) trigger: Trigger,
    pub(super) active: Option<Active>,
    /// IN is TRUE for one message only.
    pub(super) run_once: bool,
    /// When the engine has to look at this block again.
    pub(super) wake: Option<Instant>,
    /// Message router bytes of the newest message.
    pub(super) request: Arc<[u8]>,
    /// Of a SEND_REQ or DATA_EXCH.
    words: Option<Arc<Words>>,
    edges: Vec<(u64, StatusBits)>,
    edges_dropped: u64,
}

/// The message under way, with the configuration that it was triggered with.
#[derive(Debug)]
pub(super) struct Active {
    pub(super) shot: u64,
    pub(super) channel: Channel,
    /// Who sends it, once it holds a buffer.
    pub(super) client: Option<ClientId>,
    pub(super) revision: u64,
    pub(super) plan: Arc<MessagePlan>,
    /// What has gone over the wire so far.
    pub(super) exchange: Exchange,
}

/// A stored configuration that has errors.
#[derive(Clone, Debug)]
pub(super) struct Invalid {
    sub_error_id: u16,
    detail: String,
    /// The communication report, of a block with words.
    report: Option<u8>,
}

impl Invalid {
    pub(super) fn new(findings: &[Finding]) -> Self {
        let error = findings.iter().find(|finding| finding.severity == Severity::Error);
        let sub = error.and_then(Finding::error_ids).and_then(|(_, sub)| sub);
        let detail = error.map(|finding| alloc::format!("{}: {}", finding.field, finding.rule));
        let detail = detail.unwrap_or_else(|| "no plan".to_string());
        let report = findings.iter().find_map(Finding::communication_report);
        Self { sub_error_id: sub.unwrap_or(0), detail, report }
    }

    pub(super) fn failure(&self) -> Failure {
        Failure::Invalid(self.sub_error_id, self.detail.clone())
    }
}

impl Entry {
    pub(super) fn new(revision: u64, plan: Result<Arc<MessagePlan>, Invalid>) -> Self {
        Self {
            revision,
            plan,
            block: MsgBlock::default(),
            trigger: Trigger::default(),
            active: None,
            run_once: false,
            wake: None,
            request: Arc::default(),
            words: None,
            edges: Vec::new(),
            edges_dropped: 0,
        }
    }

    /// Steps the block. Returns what the block asks for, and the new edges if anything is to be seen.
    pub(super) fn step(&mut self, input: Input, now: Instant) -> Step {
        let looks = |block: &MsgBlock| (block.status(), block.phase(), block.input());
        let before = looks(&self.block);
        let triggered = matches!(input, Input::Trigger { .. });
        let effect = self.block.step(input, now);
        if triggered && effect.is_some() {
            self.edges.clear();
            self.edges_dropped = 0;
        }
        let bits = self.block.status().status_bits;
        let mut edge = None;
        if bits != before.0.status_bits || (triggered && effect.is_some()) {
            let new = (now.micros_since(self.block.triggered_at()), bits);
            edge = Some(new);
            if self.edges.len() < MAX_EDGES {
                self.edges.push(new);
            } else {
                self.edges_dropped += 1;
            }
        }
        let changed = looks(&self.block) != before || effect.is_some();
        Step { effect, changed, edge }
    }

    /// How the block looks now, without edges.
    pub(super) fn glance(&self) -> BlockView {
        BlockView { request: Arc::clone(&self.request), words: self.words.clone(), ..self.block.view() }
    }

    /// A message starts, or its start is refused.
    pub(super) fn start_words(&mut self) {
        let before = self.words.as_ref().map_or(0, |words| words.exchange);
        self.words = match &self.plan {
            Ok(plan) => plan.words().map(|plan| Words::started(Arc::clone(plan), before)),
            Err(invalid) => invalid.report.map(|report| Words::refused(report, before)),
        }
        .map(Arc::new);
    }

    /// The message has ended: what the device itself has answered is kept.
    pub(super) fn end_words(&mut self) {
        let (Some(words), Some(active)) = (&self.words, &self.active) else { return };
        // The refusal of a connection is no answer to the message, nor is a reply that makes no sense.
        if self.block.is_answered() {
            let reply = active.exchange.response().unwrap_or_default().to_vec();
            self.words = Some(Arc::new(words.answered(reply)));
        }
    }

    /// The block with all edges of its last message.
    pub(super) fn view(&self) -> BlockView {
        BlockView { edges: self.edges.clone(), edges_dropped: self.edges_dropped, ..self.glance() }
    }

    /// When the engine has to look at this block: its timeout, or its next trigger.
    pub(super) fn due(&self) -> Option<Instant> {
        self.block.deadline().into_iter().chain(self.trigger.next()).min()
    }
}

/// What a step led to.
pub(super) struct Step {
    pub(super) effect: Option<super::block::Effect>,
    /// Whether the block looks different.
    pub(super) changed: bool,
    /// Its new edge, if its bits have changed.
    pub(super) edge: Option<(u64, StatusBits)>,
}
