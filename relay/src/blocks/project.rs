//! Blocks of a project that was taken in.

use cipdeck_shared::config::{Block, BlockId};
use tokio::sync::MutexGuard;

use super::{Blocks, Inner, plan};
use crate::actor::Actor;
use crate::audit::Event;
use crate::error::ApiError;
use crate::project::Touched;

impl Blocks {
    /// As long as this is held nobody changes a block.
    pub(crate) async fn hold(&self) -> MutexGuard<'_, ()> {
        self.0.edit.lock().await
    }

    /// Whether the IN of a block is TRUE, or its message under way.
    pub(crate) fn is_on(&self, id: BlockId) -> bool {
        self.0.runner.is_on(id)
    }

    /// Blocks are stored, or gone, that nobody has heard of yet. Those that run are stopped: nobody has looked at what they
    /// would go on with.
    pub(crate) async fn take_over(&self, actor: &Actor, touched: &[Touched]) -> Result<(), ApiError> {
        let touched: Vec<BlockId> = touched
            .iter()
            .filter_map(|touched| match touched {
                Touched::Block(id) => Some(*id),
                _ => None,
            })
            .collect();
        if touched.is_empty() {
            return Ok(());
        }
        let mut stored = self.0.store.load().await?;
        stored.retain(|stored| touched.contains(&stored.block.id));
        for id in touched {
            if self.0.runner.halt(id) {
                tracing::info!(block = %id, "stopped: it is another one now");
            }
            match stored.iter().find(|stored| stored.block.id == id) {
                Some(stored) => self.0.put(actor, stored.block.clone()).await?,
                None => self.0.forget(actor, id),
            }
        }
        Ok(())
    }
}

impl Inner {
    async fn put(&self, actor: &Actor, block: Block) -> Result<(), ApiError> {
        let is_new = self.hub.block(block.id).is_none();
        // It has been stopped: nothing resumes at the next start.
        self.store.set_input(block.id, false).await?;
        self.runner.put(block.id, block.config.name(), block.revision, plan(&block.config));
        self.hub.put(block.clone());
        self.note(if is_new { Event::BlockCreated } else { Event::BlockChanged }, actor, &block);
        tracing::info!(block = %block.id, revision = block.revision, "taken over from a project");
        Ok(())
    }

    fn forget(&self, actor: &Actor, id: BlockId) {
        let Some(block) = self.hub.block(id) else { return };
        self.runner.remove(id);
        self.hub.remove(id);
        self.note(Event::BlockDeleted, actor, &block);
        tracing::info!(block = %id, "deleted: it is not in the project any more");
    }
}
