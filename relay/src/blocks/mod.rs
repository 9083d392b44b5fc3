//! Blocks as REST, WebSocket and start-up use them: stored first, then run, then told to viewers.

mod commands;
mod project;

use std::future::Future;
use std::sync::Arc;

use cipdeck_shared::api::{BlockStatus, Checked, ExchangeView, TargetStatus, findings};
use cipdeck_shared::config::{Block, BlockConfig, BlockId, write_hex};
use cipdeck_shared::engine::BlockView;
use cipdeck_shared::plan::{Finding, MessagePlan};
use tokio::sync::Mutex;

use crate::actor::Actor;
use crate::audit::Event;
use crate::capture;
use crate::draft::{Draft, normalised};
use crate::error::ApiError;
use crate::history::Recorder;
use crate::hub::Hub;
use crate::permit::{Order, Policy, record};
use crate::runner::{Guard, Runner};
use crate::store::{Change, Store, StoreError};

/// All blocks. Clones share them.
#[derive(Clone, Debug)]
pub(crate) struct Blocks(Arc<Inner>);

#[derive(Debug)]
struct Inner {
    store: Store,
    runner: Runner,
    policy: Arc<Policy>,
    hub: Arc<Hub>,
    /// Held from the store to the viewers, so that everybody sees changes in the order in which they were stored.
    edit: Mutex<()>,
}

impl Blocks {
    /// Loads what is stored. Every IN is FALSE, except where a read resumes.
    pub(crate) async fn open(
        store: Store,
        policy: Arc<Policy>,
        guard: Guard,
        recorder: Recorder,
    ) -> Result<Self, StoreError> {
        let hub = Arc::new(Hub::recording(recorder));
        let runner = Runner::guarded(Arc::clone(&hub) as Arc<_>, guard);
        let all = store.load().await?;
        for stored in &all {
            let Block { id, revision, config } = &stored.block;
            hub.put(stored.block.clone());
            runner.put(*id, config.name(), *revision, plan(config));
        }
        for stored in all.iter().filter(|stored| stored.input && stored.block.config.resume()) {
            // Without a plan there is nothing to resume; a plan that resumes only reads.
            if plan(&stored.block.config).is_ok_and(|plan| plan.resume())
                && let Err(refused) = runner.set_in(stored.block.id, true, Some(Order::read(Actor::relay())))
            {
                tracing::warn!(block = %stored.block.id, %refused, "not resumed");
            }
        }
        tracing::info!(blocks = all.len(), "loaded");
        Ok(Self(Arc::new(Inner { store, runner, policy, hub, edit: Mutex::new(()) })))
    }

    /// What viewers look at.
    pub(crate) fn hub(&self) -> &Hub {
        &self.0.hub
    }

    /// What sends messages.
    pub(crate) fn runner(&self) -> Runner {
        self.0.runner.clone()
    }

    /// One block.
    pub(crate) fn block(&self, id: BlockId) -> Result<Block, ApiError> {
        self.0.hub.block(id).ok_or_else(|| ApiError::no_block(id))
    }

    /// How a block looks, with all edges of its last message.
    pub(crate) fn status(&self, id: BlockId) -> Result<BlockStatus, ApiError> {
        let view: BlockView = self.0.runner.view(id).ok_or_else(|| ApiError::no_block(id))?;
        self.0.hub.status(id, &view).ok_or_else(|| ApiError::no_block(id))
    }

    /// The last exchanges, the newest last.
    pub(crate) fn exchanges(&self, id: BlockId) -> Result<Vec<ExchangeView>, ApiError> {
        self.0.hub.exchanges(id).ok_or_else(|| ApiError::no_block(id))
    }

    /// The last exchanges as a pcapng file, and what to call it.
    pub(crate) fn capture(&self, id: BlockId) -> Result<(String, Vec<u8>), ApiError> {
        let name = self.block(id)?.config.name().to_owned();
        let frames = self.0.hub.frames(id).ok_or_else(|| ApiError::no_block(id))?;
        let file = capture::of_exchanges(&frames).map_err(|error| ApiError::Internal(error.to_string()))?;
        Ok((capture::file_name(&name, id), file))
    }

    /// All targets that blocks have been triggered for.
    pub(crate) fn targets(&self) -> Vec<TargetStatus> {
        let all = self.0.runner.targets();
        let status = |(target, view, idle_ms): &(_, _, _)| {
            TargetStatus::new(target, view, self.0.hub.target_since(target), *idle_ms)
        };
        all.iter().map(status).collect()
    }

    /// Stores a new block.
    pub(crate) async fn create(&self, actor: &Actor, draft: Draft) -> Result<Block, ApiError> {
        let (config, plan) = accepted(draft.config)?;
        let actor = actor.clone();
        self.edit(|inner| async move {
            let block = inner.store.insert(config).await?;
            inner.hub.put(block.clone());
            inner.runner.put(block.id, block.config.name(), block.revision, Ok(plan));
            inner.note(Event::BlockCreated, &actor, &block);
            tracing::info!(block = %block.id, name = block.config.name(), "created");
            Ok(block)
        })
        .await
    }

    /// Replaces a block; it acts at the next trigger.
    pub(crate) async fn replace(&self, actor: &Actor, id: BlockId, draft: Draft) -> Result<Block, ApiError> {
        let Draft { id: claimed, revision, config } = draft;
        if claimed.is_some_and(|claimed| claimed != String::from(id)) {
            return Err(ApiError::Unreadable(format!("the body is about another block than {id}")));
        }
        let revision = revision.ok_or_else(|| ApiError::Unreadable("\"revision\" is missing".to_owned()))?;
        // Whether it exists, and in which revision, is told first: a stale draft need not be repaired.
        let (config, plan) = match accepted(config) {
            Ok(accepted) => accepted,
            Err(refused) => return Err(self.stale(id, revision).unwrap_or(refused)),
        };
        let actor = actor.clone();
        self.edit(|inner| async move {
            let block = done(id, inner.store.replace(id, revision, config).await?)?;
            if block.config.resume() {
                let input = inner.runner.view(id).is_some_and(|view| view.input);
                inner.store.set_input(id, input).await?;
            }
            inner.runner.put(id, block.config.name(), block.revision, Ok(plan));
            inner.hub.put(block.clone());
            inner.note(Event::BlockChanged, &actor, &block);
            tracing::info!(block = %id, revision = block.revision, "changed");
            Ok(block)
        })
        .await
    }

    /// Cancels and deletes a block.
    pub(crate) async fn delete(&self, actor: &Actor, id: BlockId, revision: u64) -> Result<(), ApiError> {
        let actor = actor.clone();
        self.edit(|inner| async move {
            let block = done(id, inner.store.delete(id, revision).await?)?;
            inner.runner.remove(id);
            inner.hub.remove(id);
            inner.note(Event::BlockDeleted, &actor, &block);
            tracing::info!(block = %id, "deleted");
            Ok(())
        })
        .await
    }

    /// The lists have changed.
    pub(crate) fn review(&self) {
        self.0.runner.review();
    }

    /// Ends everything that runs, then closes the database.
    pub(crate) async fn stop(&self) {
        self.0.runner.stop().await;
        self.0.store.close().await;
    }

    /// A change runs to its end even when nobody waits for it any more: the database and the engine must agree.
    async fn edit<T, F>(&self, change: impl FnOnce(Arc<Inner>) -> F) -> Result<T, ApiError>
    where
        T: Send + 'static,
        F: Future<Output = Result<T, ApiError>> + Send + 'static,
    {
        let (inner, change) = (Arc::clone(&self.0), change(Arc::clone(&self.0)));
        let edit = tokio::spawn(async move {
            let _one_at_a_time = inner.edit.lock().await;
            change.await
        });
        edit.await.unwrap_or_else(|error| Err(ApiError::Internal(error.to_string())))
    }

    fn stale(&self, id: BlockId, revision: u64) -> Option<ApiError> {
        match self.block(id) {
            Ok(block) if block.revision == revision => None,
            Ok(block) => Some(ApiError::Stale(Box::new(block))),
            Err(unknown) => Some(unknown),
        }
    }
}

impl Inner {
    /// What may be sent has changed.
    fn note(&self, event: Event, actor: &Actor, block: &Block) {
        let config = &block.config;
        let request = plan(config).map(|plan| write_hex(plan.bytes())).ok();
        let record = record(event, actor)
            .with("block", block.id.to_string())
            .with("name", config.name())
            .with("revision", block.revision)
            .with("target", config.target_text())
            .with_some("request", request);
        self.policy.note(&record);
    }
}

/// All findings about a configuration, and the bytes that it would send.
pub(crate) fn check(config: &BlockConfig) -> Checked {
    let (plan, all) = MessagePlan::check(config);
    let request = plan.map(|plan| write_hex(plan.bytes()));
    Checked { findings: findings(&all), request }
}

fn plan(config: &BlockConfig) -> Result<MessagePlan, Vec<Finding>> {
    let (plan, findings) = MessagePlan::of(config);
    plan.ok_or(findings)
}

/// What can be stored, in its one spelling.
fn accepted(config: BlockConfig) -> Result<(BlockConfig, MessagePlan), ApiError> {
    let config = normalised(config);
    match MessagePlan::check(&config) {
        (Some(plan), _) => Ok((config, plan)),
        (None, all) => Err(ApiError::Findings(findings(&all))),
    }
}

fn done(id: BlockId, change: Change) -> Result<Block, ApiError> {
    match change {
        Change::Done(block) => Ok(block),
        Change::Stale(block) => Err(ApiError::Stale(Box::new(block))),
        Change::Unknown => Err(ApiError::no_block(id)),
    }
}
