//! Runs blocks: one [`Engine`] behind one lock, a task per connection, and a timer.
//!
//! The lock is held for short, synchronous sections only. After each call into the engine its events are carried out
//! under the same lock, so that everybody sees them in the order in which they happened.

mod clock;
mod commands;
mod connect;
mod driver;
mod events;
mod link;
mod timer;
mod trail;

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::hash::{BuildHasher, Hasher, RandomState};
use std::sync::{Arc, Mutex};
use std::time::Duration;

use cipdeck_shared::api::BlockStatus;
use cipdeck_shared::config::{BlockId, Target};
use cipdeck_shared::engine::{BlockView, Engine, Exchange, Instant, LinkId, Originator, TargetView};
use cipdeck_shared::plan::{Finding, MessagePlan};
use cipdeck_shared::sim::Device;
use tokio::runtime::Handle;
use tokio::sync::{Notify, oneshot, watch};
use tokio_util::sync::CancellationToken;
use tokio_util::task::TaskTracker;

pub(crate) use self::clock::Clock;
pub(crate) use self::commands::{Ended, Lane, Refused};
pub(crate) use self::connect::lock;
use self::link::Socket;
use self::trail::Trail;
pub use self::trail::{Direction, Ends};
pub(crate) use self::trail::{Tap, Trace};
use crate::permit::{Gate, Grants, Lists, Policy, Sending};

/// Who hears what blocks do. Called under the runner's lock: must not wait and must not call back.
pub(crate) trait Observer: Send + Sync + 'static {
    /// Whether somebody wants to hear what lies between the beginning of a message and its end.
    fn watches(&self) -> bool;
    /// A block looks different; `view.edges` are the new edges only.
    fn changed(&self, block: BlockId, view: &BlockView);
    /// A message has ended. `trace` says where it went, if it was permitted to go anywhere. Returns the status that
    /// its run is answered with, if anybody wants one: most of it is text, which takes time.
    fn finished(
        &self,
        block: BlockId,
        view: &BlockView,
        exchange: &Exchange,
        trace: Option<Trace>,
    ) -> Option<BlockStatus>;
    /// A target looks different; `None` when no block needs it any more.
    fn target(&self, target: &Target, view: Option<&TargetView>);
}

/// Handle to everything that runs. Clones share it.
#[derive(Clone)]
pub(crate) struct Runner(Arc<Inner>);

/// What stands in front of every message.
#[derive(Clone, Debug)]
pub(crate) struct Guard {
    policy: Arc<Policy>,
    gate: Gate,
}

impl Guard {
    /// The rules of a relay, and who decides by them.
    pub(crate) fn new(policy: Arc<Policy>, gate: Gate) -> Self {
        Self { policy, gate }
    }
}

struct Inner {
    state: Mutex<State>,
    observer: Arc<dyn Observer>,
    /// `None` for a command line that acts for the user of this machine.
    guard: Option<Guard>,
    /// Records everything that goes over the sockets.
    tap: Option<Arc<dyn Tap>>,
    clock: Clock,
    device: Arc<Mutex<Device>>,
    /// When the timer is to wake.
    wake: watch::Sender<Option<Instant>>,
    /// While stopping: something has happened.
    stepped: Notify,
    stop: CancellationToken,
    tasks: TaskTracker,
    runtime: Handle,
}

#[derive(Default)]
struct State {
    engine: Engine,
    grants: Grants,
    sockets: BTreeMap<LinkId, Socket>,
    trails: BTreeMap<LinkId, Arc<Trail>>,
    /// The connection that carries a block's message.
    carried: HashMap<BlockId, Arc<Trail>>,
    runs: HashMap<(BlockId, u64), oneshot::Sender<Ended>>,
    /// The ids of blocks that nobody has stored, counted from the end, and the last one that was given.
    lanes: BTreeSet<u32>,
    last_lane: u32,
    /// When the timer will wake.
    armed: Option<Instant>,
    stopping: bool,
}

/// How long sessions have for their farewell.
const FAREWELL: Duration = Duration::from_secs(1);

impl Runner {
    /// Starts without blocks, behind a guard.
    pub(crate) fn guarded(observer: Arc<dyn Observer>, guard: Guard) -> Self {
        Self::start(observer, Some(guard), None)
    }

    /// Starts without blocks, for the user of this machine; the tap hears every byte.
    pub(crate) fn unguarded(observer: Arc<dyn Observer>, tap: Option<Arc<dyn Tap>>) -> Self {
        Self::start(observer, None, tap)
    }

    fn start(observer: Arc<dyn Observer>, guard: Option<Guard>, tap: Option<Arc<dyn Tap>>) -> Self {
        let inner = Arc::new(Inner {
            state: Mutex::new(State { engine: Engine::with_originator(originator()), ..State::default() }),
            observer,
            guard,
            tap,
            clock: Clock::start(),
            device: connect::built_in_device(),
            wake: watch::Sender::new(None),
            stepped: Notify::new(),
            stop: CancellationToken::new(),
            tasks: TaskTracker::new(),
            runtime: Handle::current(),
        });
        inner.tasks.spawn_on(timer::run(Arc::clone(&inner)), &inner.runtime);
        Self(inner)
    }

    /// Adds a block, or changes it from its next trigger on. `name` is what people call it.
    pub(crate) fn put(
        &self,
        block: BlockId,
        name: &str,
        revision: u64,
        plan: Result<MessagePlan, Vec<Finding>>,
    ) {
        self.0.with(|state, now| {
            if self.0.guard.is_some() {
                let busy = state.engine.is_busy(block);
                state.grants.put(block, name, revision, plan.as_ref().ok().map(Sending::from), busy);
            }
            state.engine.put(block, revision, plan, now);
        });
    }

    /// Cancels a block and forgets it.
    pub(crate) fn remove(&self, block: BlockId) {
        self.0.with(|state, now| {
            state.engine.remove(block, now);
            state.grants.remove(block);
        });
    }

    /// Stops a block: IN falls, and what is under way is cancelled. Whether there was anything to stop.
    pub(crate) fn halt(&self, block: BlockId) -> bool {
        self.0.with(|state, now| {
            let was_on = state.engine.is_on(block);
            // A block that is not there has nothing to stop.
            let _ = state.engine.set_in(block, false, now);
            let _ = state.engine.cancel(block, now);
            was_on
        })
    }

    /// Whether a block would have anything to stop.
    pub(crate) fn is_on(&self, block: BlockId) -> bool {
        lock(&self.0.state).engine.is_on(block)
    }

    /// How a block looks, with all edges of its last message.
    pub(crate) fn view(&self, block: BlockId) -> Option<BlockView> {
        lock(&self.0.state).engine.view(block)
    }

    /// The lists have changed: what is no longer allowed is left at once, sessions that are kept alive, too.
    pub(crate) fn review(&self) {
        let Some(lists) = self.0.lists() else { return };
        self.0.with(|state, _| {
            let is_kept = |socket: &Socket| match &socket.target {
                Target::BuiltIn => true,
                Target::Network(endpoint) => lists.allow_endpoint(endpoint).is_ok(),
            };
            // Dropping the handle ends its task, which tells the engine.
            state.sockets.retain(|_, socket| is_kept(socket));
        });
    }

    /// All targets that blocks have been triggered for, and the ms since each was used.
    pub(crate) fn targets(&self) -> Vec<(Target, TargetView, u64)> {
        let now = self.0.clock.now();
        let state = lock(&self.0.state);
        let idle = |view: &TargetView| now.micros_since(view.last_used) / 1_000;
        state.engine.targets().map(|(target, view)| (target.clone(), view.clone(), idle(&view))).collect()
    }

    /// Cancels everything, says farewell on every session, and ends all tasks.
    pub(crate) async fn stop(&self) {
        self.0.with(|state, now| {
            state.stopping = true;
            state.engine.stop(now);
        });
        if tokio::time::timeout(FAREWELL, self.0.quiet()).await.is_err() {
            tracing::warn!("some targets did not close their session in time");
        }
        self.0.stop.cancel();
        self.0.tasks.close();
        self.0.tasks.wait().await;
    }
}

impl Inner {
    /// Ready when no connection is left.
    async fn quiet(&self) {
        while !lock(&self.state).engine.is_quiet() {
            self.stepped.notified().await;
        }
    }

    fn lists(&self) -> Option<&Lists> {
        self.guard.as_ref().map(|guard| &guard.policy.lists)
    }

    /// Calls the engine and carries out what it says.
    fn with<T>(self: &Arc<Self>, call: impl FnOnce(&mut State, Instant) -> T) -> T {
        let mut state = lock(&self.state);
        let now = self.clock.now();
        let value = call(&mut state, now);
        while let Some(event) = state.engine.poll_event() {
            self.carry_out(event, &mut state, now);
        }
        self.arm(&mut state);
        if state.stopping {
            self.stepped.notify_one();
        }
        value
    }

    /// The timer wakes at the earliest time that it has been told. Waking for nothing is cheap and rare; telling it
    /// of every message's limit, and again when the answer is there, is neither.
    fn arm(&self, state: &mut State) {
        let Some(next) = state.engine.poll_timeout() else { return };
        if state.armed.is_none_or(|armed| next < armed) {
            state.armed = Some(next);
            self.wake.send_replace(Some(next));
        }
    }

    /// The timer has woken.
    fn tick(self: &Arc<Self>) {
        self.with(|state, now| {
            state.armed = None;
            self.wake.send_replace(None);
            state.engine.handle_timeout(now);
        });
    }
}

/// Differs from start to start: a target may still know the connections of the relay that was killed.
fn originator() -> Originator {
    Originator::new(RandomState::new().build_hasher().finish())
}

impl std::fmt::Debug for Runner {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Runner").finish_non_exhaustive()
    }
}

#[cfg(test)]
mod tests;
