//! All blocks, the buffers of the channels, and one client per target.

mod flow;
mod sessions;

use alloc::collections::{BTreeMap, BTreeSet, VecDeque};
use alloc::sync::Arc;
use alloc::vec::Vec;

use crate::config::{BlockId, Channel, Target};
use crate::plan::{Finding, MessagePlan};

use crate::engine::block::{BlockView, Input};
use crate::engine::channel::Buffers;
use crate::engine::client::{Client, ClientId, Output};
use crate::engine::connection::Originator;
use crate::engine::entry::{Entry, Invalid};
use crate::engine::event::{Event, LinkId, Wants};
use crate::engine::failure::ConnectError;
use crate::engine::target::TargetView;
use crate::engine::time::Instant;

/// Owner of everything that runs. See the module's text for the order of calls.
#[derive(Debug)]
pub struct Engine {
    blocks: BTreeMap<BlockId, Entry>,
    controllers: [Buffers; Channel::CONTROLLERS],
    monitor: Buffers,
    clients: BTreeMap<ClientId, Client>,
    /// Each target has one client.
    names: BTreeMap<Target, ClientId>,
    links: BTreeMap<LinkId, ClientId>,
    /// When blocks have to be looked at; each is here once at most, perhaps too early.
    timers: BTreeSet<(Instant, BlockId)>,
    /// When clients have something to do without a block; each is here once at most, perhaps too early.
    housekeeping: BTreeSet<(Instant, ClientId)>,
    originator: Originator,
    events: VecDeque<Event>,
    /// What a client wants done: kept so that its memory is used again.
    outputs: VecDeque<Output>,
    next_link: u64,
    next_client: u64,
    next_shot: u64,
}

/// Why a command was not carried out.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum CommandError {
    /// There is no such block.
    #[error("there is no such block")]
    UnknownBlock,
    /// The block is busy, or its IN is TRUE.
    #[error("the block is busy or its IN is TRUE")]
    Busy,
}

impl Default for Engine {
    fn default() -> Self {
        Self::new()
    }
}

impl Engine {
    /// Without blocks, for tests and demos: connections have the same names at every start.
    pub const fn new() -> Self {
        Self::with_originator(Originator::new(0))
    }

    /// Without blocks.
    pub const fn with_originator(originator: Originator) -> Self {
        Self {
            blocks: BTreeMap::new(),
            controllers: [const { Buffers::controller() }; Channel::CONTROLLERS],
            monitor: Buffers::monitor(),
            clients: BTreeMap::new(),
            names: BTreeMap::new(),
            links: BTreeMap::new(),
            timers: BTreeSet::new(),
            housekeeping: BTreeSet::new(),
            originator,
            events: VecDeque::new(),
            outputs: VecDeque::new(),
            next_link: 0,
            next_client: 0,
            next_shot: 0,
        }
    }

    /// Adds a block or changes its configuration, which acts at the next trigger. A block whose stored
    /// configuration has errors fails with `ErrorID` 33 when it is triggered.
    pub fn put(
        &mut self,
        block: BlockId,
        revision: u64,
        plan: Result<MessagePlan, Vec<Finding>>,
        now: Instant,
    ) {
        let plan = plan.map(Arc::new).map_err(|findings| Invalid::new(&findings));
        let trigger = plan.as_ref().ok().map(|plan| plan.trigger());
        let Some(entry) = self.blocks.get_mut(&block) else {
            self.blocks.insert(block, Entry::new(revision, plan));
            return;
        };
        entry.revision = revision;
        let former = core::mem::replace(&mut entry.plan, plan);
        // A run's IN is TRUE for its one message only.
        if let Some(kind) = trigger.filter(|_| entry.block.input() && !entry.run_once) {
            entry.trigger.change(kind, entry.block.phase().is_busy(), now);
        }
        self.rearm(block);
        if let Ok(plan) = former {
            self.retire(plan.target(), now);
        }
    }

    /// Cancels a block and forgets it.
    pub fn remove(&mut self, block: BlockId, now: Instant) {
        self.step(block, Input::Cancel, now);
        let Some(entry) = self.blocks.remove(&block) else { return };
        entry.wake.map(|wake| self.timers.remove(&(wake, block)));
        if let Ok(plan) = entry.plan {
            self.retire(plan.target(), now);
        }
    }

    /// One message, whatever `TriggerType`: IN rises now and falls at the end. Returns the shot.
    pub fn run(&mut self, block: BlockId, now: Instant) -> Result<u64, CommandError> {
        let entry = self.blocks.get_mut(&block).ok_or(CommandError::UnknownBlock)?;
        if entry.block.phase().is_busy() || entry.block.input() {
            return Err(CommandError::Busy);
        }
        entry.run_once = true;
        let shot = self.next_shot + 1;
        self.step(block, Input::Rise, now);
        self.trigger(block, now);
        Ok(shot)
    }

    /// Sets IN.
    pub fn set_in(&mut self, block: BlockId, input: bool, now: Instant) -> Result<(), CommandError> {
        let entry = self.blocks.get_mut(&block).ok_or(CommandError::UnknownBlock)?;
        let was = entry.block.input();
        let kind = entry.plan.as_ref().map(|plan| plan.trigger()).ok();
        // A run's IN is TRUE already: setting it keeps it TRUE. That is no rising edge.
        entry.run_once = false;
        match (input, kind) {
            (true, Some(kind)) if !was || entry.trigger.next().is_none() => entry.trigger.start(kind, now),
            (true, _) => {}
            (false, _) => entry.trigger.stop(),
        }
        match (was, input) {
            (false, true) => {
                self.step(block, Input::Rise, now);
                self.trigger(block, now);
            }
            (true, false) => self.step(block, Input::Fall, now),
            _ => {}
        }
        self.rearm(block);
        Ok(())
    }

    /// `CtrlCfg.Cancel`: ends a busy message with ER. Nothing when idle.
    pub fn cancel(&mut self, block: BlockId, now: Instant) -> Result<(), CommandError> {
        if !self.blocks.contains_key(&block) {
            return Err(CommandError::UnknownBlock);
        }
        self.step(block, Input::Cancel, now);
        Ok(())
    }

    /// Ends everything: all INs fall, all messages are cancelled, all sessions are closed.
    pub fn stop(&mut self, now: Instant) {
        let blocks: Vec<_> = self.blocks.keys().copied().collect();
        for block in blocks {
            // The block exists: both calls can only succeed.
            let _ = self.set_in(block, false, now);
            let _ = self.cancel(block, now);
        }
        let clients: Vec<_> = self.clients.keys().copied().collect();
        for id in clients {
            self.client(id, now, Client::close);
        }
    }

    /// The TCP connection is there.
    pub fn connected(&mut self, link: LinkId, now: Instant) {
        self.link(link, now, Client::connected);
    }

    /// There is no TCP connection; `detail` is what the operating system said.
    pub fn connect_failed(&mut self, link: LinkId, error: ConnectError, detail: &str, now: Instant) {
        self.link(link, now, |client, cx| client.connect_failed(error, detail, cx));
        self.links.remove(&link);
    }

    /// The target closed the TCP connection, or it broke.
    pub fn closed(&mut self, link: LinkId, now: Instant) {
        self.link(link, now, Client::closed);
        if let Some(id) = self.links.remove(&link) {
            self.retire_client(id, now);
        }
    }

    /// Bytes from the socket.
    pub fn handle_input(&mut self, link: LinkId, bytes: &[u8], now: Instant) {
        self.link(link, now, |client, cx| client.handle_input(bytes, cx));
    }

    /// Appends bytes for the socket, if there are any. ST rises here: the caller writes them at once.
    pub fn poll_transmit(&mut self, link: LinkId, out: &mut Vec<u8>, now: Instant) -> bool {
        self.link(link, now, |client, cx| client.poll_transmit(out, cx)).unwrap_or(false)
    }

    /// The answer to [`Event::Wants`]: an error says why not, in words for the block's cause.
    pub fn permit(&mut self, wants: &Wants, verdict: Result<(), &str>, now: Instant) {
        self.link(wants.link, now, |client, cx| client.permit(wants, verdict, cx));
    }

    /// When to call [`Self::handle_timeout`].
    pub fn poll_timeout(&self) -> Option<Instant> {
        let block = self.timers.first().map(|(at, _)| *at);
        let housekeeping = self.housekeeping.first().map(|(at, _)| *at);
        block.into_iter().chain(housekeeping).min()
    }

    /// Time has passed. Too early is harmless.
    pub fn handle_timeout(&mut self, now: Instant) {
        while self.timers.first().is_some_and(|(at, _)| *at <= now) {
            let Some((_, block)) = self.timers.pop_first() else { break };
            if let Some(entry) = self.blocks.get_mut(&block) {
                entry.wake = None;
            }
            self.step(block, Input::Tick, now);
            self.cycle(block, now);
            self.rearm(block);
        }
        while self.housekeeping.first().is_some_and(|(at, _)| *at <= now) {
            let Some((_, id)) = self.housekeeping.pop_first() else { break };
            if let Some(client) = self.clients.get_mut(&id) {
                client.armed = None;
            }
            self.client(id, now, Client::handle_timeout);
            self.retire_client(id, now);
        }
    }

    /// What is to be done or told, in order.
    pub fn poll_event(&mut self) -> Option<Event> {
        self.events.pop_front()
    }

    /// How a block looks, without edges: for [`Event::Changed`].
    pub fn glance(&self, block: BlockId) -> Option<BlockView> {
        let entry = self.blocks.get(&block)?;
        Some(BlockView { position: self.position(block, entry), ..entry.glance() })
    }

    /// How a block looks, with all edges of its last message.
    pub fn view(&self, block: BlockId) -> Option<BlockView> {
        let entry = self.blocks.get(&block)?;
        Some(BlockView { position: self.position(block, entry), ..entry.view() })
    }

    /// Whether a message of this block is under way.
    pub fn is_busy(&self, block: BlockId) -> bool {
        self.blocks.get(&block).is_some_and(|entry| entry.block.phase().is_busy())
    }

    /// Whether the IN of this block is TRUE, or a message of it under way.
    pub fn is_on(&self, block: BlockId) -> bool {
        self.blocks.get(&block).is_some_and(|entry| entry.block.input() || entry.block.phase().is_busy())
    }

    /// Whether no connection is there or being made: everything has been closed.
    pub fn is_quiet(&self) -> bool {
        self.clients.values().all(|client| client.link_id().is_none())
    }

    /// All targets that blocks have been triggered for, and how they look.
    pub fn targets(&self) -> impl Iterator<Item = (&Target, TargetView)> {
        self.clients.values().map(|client| (client.target(), client.view()))
    }

    /// Frames from a target that answered nothing: late, or not meant for us.
    pub fn dropped_frames(&self, target: &Target) -> u64 {
        self.names.get(target).and_then(|id| self.clients.get(id)).map_or(0, Client::dropped)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::MsgCipGeneric;

    #[test]
    fn a_target_that_no_block_names_any_more_is_forgotten() {
        const A: BlockId = BlockId(1);
        let plan = |path: &str| MessagePlan::parse(&MsgCipGeneric::product_name(path)).0.ok_or_else(Vec::new);
        let mut engine = Engine::new();
        for round in 0..3 {
            engine.put(A, 1, plan("4,10.0.0.1"), Instant(round));
            engine.run(A, Instant(round)).unwrap();
            let link = *engine.links.keys().next().unwrap();
            match round {
                0 => engine.connect_failed(link, ConnectError::Refused, "", Instant(round)),
                1 => engine.connected(link, Instant(round)),
                _ => engine.closed(link, Instant(round)),
            }
            engine.put(A, 2, plan("4,10.0.0.2"), Instant(round));
            engine.cancel(A, Instant(round)).unwrap();
            assert_eq!((engine.clients.len(), engine.links.len()), (0, 0), "round {round}");
        }
        engine.remove(A, Instant(9));
        assert!(engine.timers.is_empty());
    }
}
