//! A client without a relay: for programs that embed it, and for measurements. It is what `cipdeck send` uses.
//!
//! ```no_run
//! # async fn example() -> Result<(), Box<dyn std::error::Error>> {
//! use cipdeck_relay::client::Client;
//! use cipdeck_shared::config::MsgCipGeneric;
//!
//! let client = Client::start();
//! let config = MsgCipGeneric::product_name("4,192.168.1.100");
//! let mut message = client.message(&config.into()).map_err(|findings| format!("{findings:?}"))?;
//! let answer = message.run().await?;
//! println!("{:?} {:02x?}", answer.view.status, answer.exchange.response());
//! client.stop().await;
//! # Ok(())
//! # }
//! ```

use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::SystemTime;

use cipdeck_shared::api::{BlockStatus, LastSuccess, WordsStatus};
use cipdeck_shared::config::{BlockConfig, BlockId, Target};
use cipdeck_shared::engine::{BlockView, Exchange, TargetView};
use cipdeck_shared::plan::{Finding, MessagePlan};

use crate::runner::{Lane, Observer, Refused, Runner, Tap, Trace};
use crate::wall_clock;

/// Sessions and connections that messages share. Clones share them, too.
#[derive(Clone, Debug)]
pub struct Client {
    runner: Runner,
    last: Arc<AtomicU32>,
}

/// One configured block. It is forgotten when it is dropped.
#[derive(Debug)]
pub struct Message {
    runner: Runner,
    block: BlockId,
}

/// How a message ended: with DN or ER.
#[derive(Clone, Debug)]
pub struct Answer {
    block: BlockId,
    at: SystemTime,
    /// The block at that moment, with all edges of the message.
    pub view: Box<BlockView>,
    /// What went over the wire.
    pub exchange: Box<Exchange>,
}

/// Why a message was not started.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NotStarted {
    /// Its last run is still under way: the future that waited for it was dropped.
    #[error("the message is still under way")]
    Busy,
    /// Nothing is started any more.
    #[error("the client has been stopped")]
    Stopped,
}

/// The only revision of a message: its configuration never changes.
const REVISION: u64 = 1;

impl Client {
    /// Starts without messages, on the tokio runtime of the caller.
    ///
    /// # Panics
    /// Outside of a tokio runtime.
    pub fn start() -> Self {
        Self::tapped(None)
    }

    /// Starts without messages; the tap hears every byte.
    pub(crate) fn tapped(tap: Option<Arc<dyn Tap>>) -> Self {
        Self { runner: Runner::unguarded(Arc::new(Nobody), tap), last: Arc::default() }
    }

    /// A message that can be sent, or what is wrong with it; nothing is sent yet.
    pub fn message(&self, config: &BlockConfig) -> Result<Message, Vec<Finding>> {
        let (plan, findings) = MessagePlan::of(config);
        Ok(self.planned(plan.ok_or(findings)?))
    }

    /// A message that has been planned already.
    pub fn planned(&self, plan: MessagePlan) -> Message {
        let block = BlockId(self.last.fetch_add(1, Ordering::Relaxed) + 1);
        self.runner.put(block, "", REVISION, Ok(plan));
        Message { runner: self.runner.clone(), block }
    }

    /// A block of its own for many messages.
    pub(crate) fn lane(&self, name: &str) -> Lane {
        self.runner.lane(name)
    }

    /// Cancels everything, and closes connections and sessions in order.
    pub async fn stop(&self) {
        self.runner.stop().await;
    }
}

impl Message {
    /// Sends it once and waits for its end, which may be a failure. A message goes on when this future is dropped.
    pub async fn run(&mut self) -> Result<Answer, NotStarted> {
        // Whoever wrote the program knows what it sends, and acts from their own machine.
        let ended = self.runner.run(self.block, None).await.map_err(|refused| match refused {
            Refused::Busy => NotStarted::Busy,
            Refused::Unavailable | Refused::UnknownBlock | Refused::NotPermitted(_) => NotStarted::Stopped,
        })?;
        Ok(Answer { block: self.block, at: SystemTime::now(), view: ended.view, exchange: ended.exchange })
    }
}

impl Answer {
    /// As `cipdeck send --json` prints it and the relay answers a run.
    pub fn status(&self) -> BlockStatus {
        let at = wall_clock::at(self.at);
        let mut status = BlockStatus::new(self.block, &self.view, Some(at.clone()), None);
        status.words = WordsStatus::of_started(&self.view);
        status.last = status.q.then(|| LastSuccess::of(&status, at));
        status
    }
}

impl Drop for Message {
    fn drop(&mut self) {
        self.runner.remove(self.block);
    }
}

/// There is no viewer: the end of a run is its only news.
#[derive(Debug)]
pub(crate) struct Nobody;

impl Observer for Nobody {
    fn watches(&self) -> bool {
        false
    }

    fn changed(&self, _: BlockId, _: &BlockView) {}

    fn finished(&self, _: BlockId, _: &BlockView, _: &Exchange, _: Option<Trace>) -> Option<BlockStatus> {
        None
    }

    fn target(&self, _: &Target, _: Option<&TargetView>) {}
}
