//! What people command: run, IN, cancel. Each command names who gives it.

use std::sync::Arc;

use cipdeck_shared::api::BlockStatus;
use cipdeck_shared::config::BlockId;
use cipdeck_shared::engine::{BlockView, CommandError, Exchange, Instant};
use cipdeck_shared::plan::MessagePlan;
use tokio::sync::oneshot;

use super::connect::lock;
use super::{Inner, Runner, State};
use crate::permit::{Denied, Former, Order};

/// How a run ended: with DN or ER.
#[derive(Clone, Debug)]
pub(crate) struct Ended {
    /// The block at that moment, with all edges of the message: its IN is still TRUE.
    pub(crate) view: Box<BlockView>,
    /// What went over the wire.
    pub(crate) exchange: Box<Exchange>,
    /// What the observer answers with.
    pub(crate) status: Option<BlockStatus>,
}

/// Why a command was not carried out.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub(crate) enum Refused {
    /// No such block.
    #[error("there is no such block")]
    UnknownBlock,
    /// A message is under way, or IN is TRUE.
    #[error("the block is busy or its IN is TRUE")]
    Busy,
    /// Who commands it may not, or not now.
    #[error("{0}")]
    NotPermitted(Denied),
    /// Nothing is started any more.
    #[error("the relay is stopping")]
    Unavailable,
}

/// Ids of lanes, round and round: more than can be open at once.
const MAX_LANES: u32 = 1 << 20;

impl Runner {
    /// One message, whatever `TriggerType`. The message goes on when nobody waits for its end any more.
    pub(crate) async fn run(&self, block: BlockId, order: Option<Order>) -> Result<Ended, Refused> {
        let (sender, ended) = oneshot::channel();
        self.0.command(|state, now| {
            let former = self.0.permit(state, block, order, true)?;
            let shot = state.engine.run(block, now).map_err(|error| state.take_back(block, former, error))?;
            state.runs.insert((block, shot), sender);
            Ok(())
        })?;
        ended.await.map_err(|_| Refused::Unavailable)
    }

    /// Sets IN.
    pub(crate) fn set_in(&self, block: BlockId, input: bool, order: Option<Order>) -> Result<(), Refused> {
        self.0.command(|state, now| {
            let former = if input { self.0.permit(state, block, order, false)? } else { None };
            state.engine.set_in(block, input, now).map_err(|error| state.take_back(block, former, error))
        })
    }

    /// Cancels what is under way; nothing when idle.
    pub(crate) fn cancel(&self, block: BlockId) -> Result<(), Refused> {
        self.0.command(|state, now| state.engine.cancel(block, now).map_err(Refused::from))
    }

    /// What somebody would hear who commanded a block.
    pub(crate) fn ask(&self, block: BlockId, order: &Order) -> Result<(), Refused> {
        let Some(guard) = &self.0.guard else { return Ok(()) };
        let state = lock(&self.0.state);
        state.grants.ask(guard.gate, &guard.policy, block, order).map_err(Refused::from)
    }

    /// One message of a block that is forgotten afterwards: a read that belongs to a write.
    pub(crate) async fn pass(&self, name: &str, plan: MessagePlan, order: Order) -> Result<Ended, Refused> {
        self.lane(name).send(plan, Some(order)).await
    }

    /// A block that nobody has stored, for messages of one purpose, one after the other.
    pub(crate) fn lane(&self, name: &str) -> Lane {
        let number = self.0.with(|state, _| state.open_lane());
        // From the end of the ids, which no database gets near.
        let block = BlockId(u32::MAX - number);
        Lane { runner: self.clone(), name: name.to_owned(), block, revision: 0 }
    }
}

/// A block for messages that nobody has stored. However its future ends, the block goes with it.
#[derive(Debug)]
pub(crate) struct Lane {
    runner: Runner,
    name: String,
    block: BlockId,
    revision: u64,
}

impl Lane {
    /// Under which id messages are asked about.
    pub(crate) const fn block(&self) -> BlockId {
        self.block
    }

    /// What the next message will be, without sending it: somebody is asked first. Returns its revision.
    pub(crate) fn put(&mut self, plan: MessagePlan) -> u64 {
        self.revision += 1;
        self.runner.put(self.block, &self.name, self.revision, Ok(plan));
        self.revision
    }

    /// Sends what was put.
    pub(crate) async fn run(&self, order: Option<Order>) -> Result<Ended, Refused> {
        self.runner.run(self.block, order).await
    }

    /// One message.
    pub(crate) async fn send(&mut self, plan: MessagePlan, order: Option<Order>) -> Result<Ended, Refused> {
        self.put(plan);
        self.run(order).await
    }
}

impl Drop for Lane {
    fn drop(&mut self) {
        self.runner.remove(self.block);
        self.runner.0.with(|state, _| state.lanes.remove(&(u32::MAX - self.block.0)));
    }
}

impl Inner {
    /// A command of a person: refused while stopping.
    fn command<T>(
        self: &Arc<Self>,
        call: impl FnOnce(&mut State, Instant) -> Result<T, Refused>,
    ) -> Result<T, Refused> {
        self.with(|state, now| if state.stopping { Err(Refused::Unavailable) } else { call(state, now) })
    }

    /// Asks for a command; the one that it replaces.
    fn permit(
        &self,
        state: &mut State,
        block: BlockId,
        order: Option<Order>,
        is_run: bool,
    ) -> Result<Option<Former>, Refused> {
        let Some(guard) = &self.guard else { return Ok(None) };
        // Behind a guard nobody commands without a name.
        let order = order.ok_or(Refused::NotPermitted(Denied::Gone))?;
        Ok(Some(state.grants.command(guard.gate, &guard.policy, block, order, is_run)?))
    }
}

impl State {
    /// A number that no open lane has.
    fn open_lane(&mut self) -> u32 {
        loop {
            self.last_lane = (self.last_lane + 1) % MAX_LANES;
            if self.lanes.insert(self.last_lane) {
                return self.last_lane;
            }
        }
    }

    /// A command that the engine refuses leaves everything as it was.
    fn take_back(&mut self, block: BlockId, former: Option<Former>, error: CommandError) -> Refused {
        if let Some(former) = former {
            self.grants.restore(block, former);
        }
        error.into()
    }
}

impl From<Denied> for Refused {
    fn from(denied: Denied) -> Self {
        match denied {
            Denied::Unknown => Self::UnknownBlock,
            denied => Self::NotPermitted(denied),
        }
    }
}

impl From<CommandError> for Refused {
    fn from(error: CommandError) -> Self {
        match error {
            CommandError::UnknownBlock => Self::UnknownBlock,
            CommandError::Busy => Self::Busy,
        }
    }
}
