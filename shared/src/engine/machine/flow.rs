//! From a trigger to DN or ER: one step of one block, and everything that follows from it.

use alloc::boxed::Box;
use alloc::collections::BTreeSet;
use alloc::sync::Arc;
use alloc::vec::Vec;

use crate::config::{BlockId, Channel};
use crate::engine::block::{Effect, Input};
use crate::engine::channel::Buffers;
use crate::engine::client::Job;
use crate::engine::entry::{Active, Entry};
use crate::engine::event::{Event, Exchange};
use crate::engine::failure::Failure;
use crate::engine::status::CauseKind;
use crate::engine::time::Instant;

use super::Engine;

/// Changes of the place in the queue are told to this many waiting blocks.
const ANNOUNCED_POSITIONS: usize = 16;

impl Engine {
    pub(super) fn trigger(&mut self, block: BlockId, now: Instant) {
        let Some(entry) = self.blocks.get_mut(&block) else { return };
        // A block without a usable plan fails at once.
        let deadline = entry.plan.as_ref().map_or(now, |plan| now.deadline(plan.ucmm_timeout_ms()));
        if !entry.block.phase().is_busy() {
            entry.request =
                entry.plan.as_ref().map_or_else(|_| Arc::default(), |plan| Arc::clone(plan.bytes()));
            entry.start_words();
        }
        self.step(block, Input::Trigger { deadline }, now);
    }

    /// A period has elapsed while IN is TRUE.
    pub(super) fn cycle(&mut self, block: BlockId, now: Instant) {
        let Some(entry) = self.blocks.get_mut(&block) else { return };
        let target = entry.plan.as_ref().ok().map(|plan| plan.target());
        let client = target.and_then(|target| self.names.get(target)).and_then(|id| self.clients.get(id));
        if let Some(until) = client.and_then(|client| client.retry_at(now)) {
            entry.trigger.hold_back(until);
        }
        if entry.trigger.take(now) {
            self.trigger(block, now);
        }
    }

    /// One step of one block, and everything that follows from it.
    pub(super) fn step(&mut self, block: BlockId, input: Input, now: Instant) {
        let Some(entry) = self.blocks.get_mut(&block) else { return };
        let step = entry.step(input, now);
        arm(&mut self.timers, block, entry);
        if step.changed {
            self.events.push_back(Event::Changed { block, edge: step.edge });
        }
        match step.effect {
            Some(Effect::Enqueue) => self.enqueue(block, now),
            Some(Effect::Release) => self.release(block, now),
            None => {}
        }
    }

    fn enqueue(&mut self, block: BlockId, now: Instant) {
        let Some(entry) = self.blocks.get_mut(&block) else { return };
        self.next_shot += 1;
        let plan = match &entry.plan {
            Ok(plan) => Arc::clone(plan),
            Err(invalid) => {
                let failure = invalid.failure();
                return self.step(block, Input::Failed(failure), now);
            }
        };
        let channel = plan.channel();
        entry.active = Some(Active {
            shot: self.next_shot,
            channel,
            client: None,
            revision: entry.revision,
            plan,
            exchange: Exchange { request: Arc::clone(&entry.request), ..Exchange::default() },
        });
        self.buffers(channel).enqueue(block);
        self.grant(channel, now);
        if self.buffers(channel).position(block) > 0 {
            // Its trigger was announced before it stood in the queue.
            self.announce_position(block);
        }
    }

    /// A message has ended: its buffer is free, its client forgets it, and its owner hears of it.
    fn release(&mut self, block: BlockId, now: Instant) {
        let Some(entry) = self.blocks.get_mut(&block) else { return };
        entry.trigger.ended(now);
        arm(&mut self.timers, block, entry);
        entry.end_words();
        let view = Box::new(entry.view());
        let silence = view.cause.clone().filter(|cause| cause.what == CauseKind::Timeout);
        let run_once = core::mem::take(&mut entry.run_once);
        let mut active = entry.active.take();
        let planned = entry.plan.as_ref().ok().map(|plan| plan.target());
        let changed_target = active.as_ref().is_some_and(|active| planned != Some(active.plan.target()));
        let shot = active.as_ref().map_or(self.next_shot, |active| active.shot);
        let exchange =
            Box::new(active.as_mut().map(|active| core::mem::take(&mut active.exchange)).unwrap_or_default());
        self.events.push_back(Event::Finished { block, shot, view, exchange });
        if run_once {
            self.step(block, Input::Fall, now);
        }
        if let Some(active) = active {
            self.buffers(active.channel).release(block);
            if let Some(id) = active.client {
                self.client(id, now, |client, cx| client.withdraw(block, silence.as_ref(), cx));
            }
            self.grant(active.channel, now);
            if changed_target {
                self.retire(active.plan.target(), now);
            }
        }
    }

    fn grant(&mut self, channel: Channel, now: Instant) {
        if core::mem::replace(&mut self.buffers(channel).granting, true) {
            return;
        }
        let mut granted = false;
        while let Some(block) = self.buffers(channel).poll_grant() {
            granted = true;
            self.submit(block, now);
        }
        self.buffers(channel).granting = false;
        if granted {
            self.announce_positions(channel);
        }
    }

    fn submit(&mut self, block: BlockId, now: Instant) {
        let Some(active) = self.blocks.get(&block).and_then(|entry| entry.active.as_ref()) else { return };
        let (plan, channel) = (Arc::clone(&active.plan), active.channel);
        let id = self.client_of(plan.target());
        let Some(active) = self.blocks.get_mut(&block).and_then(|entry| entry.active.as_mut()) else {
            return;
        };
        active.client = Some(id);
        let job = Job {
            block,
            shot: active.shot,
            revision: active.revision,
            plan: Arc::clone(&plan),
            resent: false,
            may_open: false,
        };
        if channel != Channel::Monitor
            && !(self.session_for_controller(id, now) && self.connection_for_controller(id, &plan, now))
        {
            self.step(block, Input::BufferGranted, now);
            return self.step(block, Input::Failed(Failure::Limit), now);
        }
        self.client(id, now, |client, cx| {
            client.controller |= channel != Channel::Monitor;
            client.submit(job, cx);
        });
    }

    fn announce_positions(&mut self, channel: Channel) {
        let waiting: Vec<_> = self.buffers(channel).waiting().take(ANNOUNCED_POSITIONS).collect();
        for block in waiting {
            self.announce_position(block);
        }
    }

    /// Its place has changed.
    fn announce_position(&mut self, block: BlockId) {
        self.events.push_back(Event::Changed { block, edge: None });
    }

    pub(super) fn position(&self, block: BlockId, entry: &Entry) -> usize {
        match &entry.active {
            Some(Active { client: Some(id), .. }) => {
                self.clients.get(id).map_or(0, |client| client.position(block))
            }
            Some(active) => {
                let index = active.channel.of_controller();
                let buffers = index.and_then(|index| self.controllers.get(index)).unwrap_or(&self.monitor);
                buffers.position(block)
            }
            None => 0,
        }
    }

    pub(super) fn buffers(&mut self, channel: Channel) -> &mut Buffers {
        let index = channel.of_controller();
        index.and_then(|index| self.controllers.get_mut(index)).unwrap_or(&mut self.monitor)
    }

    pub(super) fn rearm(&mut self, block: BlockId) {
        if let Some(entry) = self.blocks.get_mut(&block) {
            arm(&mut self.timers, block, entry);
        }
    }
}

/// Sets the block's timer. One that is too early does no harm: most messages end long before their time.
fn arm(timers: &mut BTreeSet<(Instant, BlockId)>, block: BlockId, entry: &mut Entry) {
    let due = entry.due().filter(|due| entry.wake.is_none_or(|wake| *due < wake));
    if let Some(due) = due {
        entry.wake.replace(due).map(|old| timers.remove(&(old, block)));
        timers.insert((due, block));
    }
}
