//! What is known about each block when the question comes up, and the record of what was answered.

use std::collections::{BTreeMap, HashMap};

use cipdeck_shared::config::{BlockId, write_hex};
use cipdeck_shared::engine::{BlockView, Exchange};
use tokio::time::Instant;

use super::policy::{Policy, record};
use super::question::{Denied, Order, Question, Sending};
use crate::audit::{Event, Record};

/// Who has commanded what, block by block.
#[derive(Debug, Default)]
pub(crate) struct Grants {
    blocks: BTreeMap<BlockId, Grant>,
    /// Writes that are under way.
    writing: HashMap<(BlockId, u64), Record>,
}

#[derive(Debug, Default)]
struct Grant {
    name: String,
    /// The newest revision.
    current: u64,
    /// What each revision sends that can still be under way; `None` for one with errors.
    sendings: BTreeMap<u64, Option<Sending>>,
    command: Former,
}

/// A command that holds, or held.
#[derive(Debug, Default)]
pub(crate) struct Former {
    order: Option<Order>,
    /// A run is one message whatever the trigger.
    is_run: bool,
    /// The last message that was permitted for the order.
    earlier: Option<u64>,
}

/// The decision: [`permit`](super::permit()), except in tests that show that they need it.
pub(crate) type Gate = fn(&Policy, &Question<'_>) -> Result<(), Denied>;

impl Grants {
    /// A block is new or has changed. While it is busy its message goes on with the revision that it began with.
    pub(crate) fn put(
        &mut self,
        block: BlockId,
        name: &str,
        revision: u64,
        sending: Option<Sending>,
        busy: bool,
    ) {
        let grant = self.blocks.entry(block).or_default();
        if !busy {
            grant.sendings.clear();
        }
        grant.sendings.insert(revision, sending);
        grant.current = revision;
        name.clone_into(&mut grant.name);
    }

    /// A block is gone.
    pub(crate) fn remove(&mut self, block: BlockId) {
        self.blocks.remove(&block);
    }

    /// Somebody gives a command that sends. It holds until the next one; a refused command changes nothing. Returns the
    /// command that held before.
    pub(crate) fn command(
        &mut self,
        gate: Gate,
        policy: &Policy,
        block: BlockId,
        order: Order,
        is_run: bool,
    ) -> Result<Former, Denied> {
        let grant = self.blocks.get_mut(&block).ok_or(Denied::Unknown)?;
        let asked = Asked { order: &order, is_run, shot: None, earlier: None };
        match grant.ask(gate, policy, grant.current, &asked) {
            // Without a plan nothing is sent: the block itself says what is wrong.
            Ok(()) | Err(Denied::NoPlan) => Ok(std::mem::replace(
                &mut grant.command,
                Former { order: Some(order), is_run, earlier: None },
            )),
            Err(denied) => {
                grant.record_denied(policy, block, grant.current, &order, &denied);
                Err(denied)
            }
        }
    }

    /// A command was not carried out after all.
    pub(crate) fn restore(&mut self, block: BlockId, former: Former) {
        if let Some(grant) = self.blocks.get_mut(&block) {
            grant.command = former;
        }
    }

    /// What somebody would hear who gave a command.
    pub(crate) fn ask(
        &self,
        gate: Gate,
        policy: &Policy,
        block: BlockId,
        order: &Order,
    ) -> Result<(), Denied> {
        let grant = self.blocks.get(&block).ok_or(Denied::Unknown)?;
        let asked = Asked { order, is_run: false, shot: None, earlier: None };
        grant.answer(gate, policy, block, grant.current, &asked)
    }

    /// A message is about to be written. A write is recorded first: without its record it is not sent.
    pub(crate) fn shot(
        &mut self,
        gate: Gate,
        policy: &Policy,
        block: BlockId,
        revision: u64,
        shot: u64,
    ) -> Result<(), Denied> {
        let grant = self.blocks.get_mut(&block).ok_or(Denied::Unknown)?;
        let Former { order, is_run, earlier } = &grant.command;
        let (order, is_run, earlier) = (order.clone().ok_or(Denied::NotConfirmed)?, *is_run, *earlier);
        let asked = Asked { order: &order, is_run, shot: Some(shot), earlier };
        let answer = grant.ask(gate, policy, revision, &asked).and_then(|()| {
            let Some(permitted) = grant.write_record(block, revision, &order) else { return Ok(()) };
            policy.audit.append(&permitted(Event::WritePermitted)).map_err(|_| Denied::NoAudit)?;
            self.writing.insert((block, shot), permitted(Event::WriteEnded));
            Ok(())
        });
        match &answer {
            Ok(()) => grant.command.earlier = Some(shot),
            Err(denied) => grant.record_denied(policy, block, revision, &order, denied),
        }
        answer
    }

    /// A connection is about to be opened for a message that will be asked about itself.
    pub(crate) fn opening(
        &self,
        gate: Gate,
        policy: &Policy,
        block: BlockId,
        revision: u64,
    ) -> Result<(), Denied> {
        let grant = self.blocks.get(&block).ok_or(Denied::Unknown)?;
        let Former { order, is_run, earlier } = &grant.command;
        let order = order.as_ref().ok_or(Denied::NotConfirmed)?;
        let asked = Asked { order, is_run: *is_run, shot: None, earlier: *earlier };
        grant.answer(gate, policy, block, revision, &asked)
    }

    /// Whether a block that was denied a message is to stop: it writes, and would try again.
    pub(crate) fn stops(&self, block: BlockId, revision: u64) -> bool {
        let grant = self.blocks.get(&block);
        grant.and_then(|grant| grant.sending(revision)).is_some_and(|sending| sending.access.may_write())
    }

    /// A message has ended: if it was a write, its end is recorded.
    pub(crate) fn ended(
        &mut self,
        policy: &Policy,
        block: BlockId,
        shot: u64,
        view: &BlockView,
        exchange: &Exchange,
    ) {
        let write = self.writing.remove(&(block, shot));
        policy.metrics.message(write.is_some(), view);
        if let Some(record) = write {
            let status = &view.status;
            let record = record
                .with("error_id", status.error_id)
                .with("sub_error_id", status.sub_error_id)
                .with_some("reply", exchange.response().map(write_hex))
                .with_some("elapsed_us", view.elapsed_us);
            policy.note(&record);
        }
    }
}

struct Asked<'a> {
    order: &'a Order,
    is_run: bool,
    shot: Option<u64>,
    earlier: Option<u64>,
}

impl Grant {
    fn sending(&self, revision: u64) -> Option<&Sending> {
        self.sendings.get(&revision)?.as_ref()
    }

    fn ask(&self, gate: Gate, policy: &Policy, revision: u64, asked: &Asked<'_>) -> Result<(), Denied> {
        let sending = self.sendings.get(&revision).ok_or(Denied::Unknown)?.as_ref();
        let question = Question {
            sending,
            revision,
            actor: &asked.order.actor,
            confirmed: asked.order.confirmed.as_ref(),
            shot: asked.shot,
            earlier: asked.earlier,
            repeats: !asked.is_run && sending.is_some_and(|sending| sending.is_cyclic),
            now: Instant::now(),
        };
        gate(policy, &question)
    }

    /// [`Self::ask`], with a record of what is denied.
    fn answer(
        &self,
        gate: Gate,
        policy: &Policy,
        block: BlockId,
        revision: u64,
        asked: &Asked<'_>,
    ) -> Result<(), Denied> {
        self.ask(gate, policy, revision, asked)
            .inspect_err(|denied| self.record_denied(policy, block, revision, asked.order, denied))
    }

    /// A record about a write; `None` for a read.
    fn write_record(
        &self,
        block: BlockId,
        revision: u64,
        order: &Order,
    ) -> Option<impl Fn(Event) -> Record + use<>> {
        let sending = self.sending(revision).filter(|sending| sending.access.may_write())?;
        let (name, path, request) = (self.name.clone(), sending.path(), write_hex(&sending.request));
        let order = order.clone();
        Some(move |event| {
            let confirmed = order.confirmed.as_ref();
            record(event, &order.actor)
                .with("block", block.to_string())
                .with("name", name.clone())
                .with("revision", revision)
                .with("target", path.clone())
                .with("request", request.clone())
                .with_some("ticket", confirmed.map(|confirmed| confirmed.id.clone()))
                .with_some("old", confirmed.and_then(|it| it.old.as_ref()).map(|old| old.data.clone()))
                .with_some("new", confirmed.and_then(|it| it.new.as_ref()).map(|new| new.data.clone()))
        })
    }

    /// A read that is denied is no event; a write that is denied is one.
    fn record_denied(&self, policy: &Policy, block: BlockId, revision: u64, order: &Order, denied: &Denied) {
        policy.metrics.denied(denied);
        if let Some(record) = self.write_record(block, revision, order)
            && let Some(left_out) = policy.denials.take(order.actor.name(), Instant::now())
        {
            let record = record(Event::WriteDenied).with("why", denied.to_string());
            policy.note(&record.with_some("left_out", (left_out > 0).then_some(left_out)));
        }
    }
}
