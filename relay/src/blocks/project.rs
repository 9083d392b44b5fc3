//! Blocks of a project that was taken in.

use cipdeck_shared::config::BlockId;
use tokio::sync::MutexGuard;

use super::{Blocks, plan};
use crate::actor::Actor;
use crate::audit::Event;
use crate::error::ApiError;
use crate::project::Touched;

impl Blocks {
    /// As long as this is held nobody changes a block.
    pub(crate) async fn hold(&self) -> MutexGuard<'_, ()> {
        self.0.edit.lock().await
    }

    /// Blocks are stored that nobody has heard of yet.
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
        let inner = &self.0;
        for stored in
            inner.store.load().await?.into_iter().filter(|stored| touched.contains(&stored.block.id))
        {
            let block = stored.block;
            let is_new = inner.hub.block(block.id).is_none();
            if block.config.resume() {
                let input = inner.runner.view(block.id).is_some_and(|view| view.input);
                inner.store.set_input(block.id, input).await?;
            }
            inner.runner.put(block.id, block.config.name(), block.revision, plan(&block.config));
            inner.hub.put(block.clone());
            let event = if is_new { Event::BlockCreated } else { Event::BlockChanged };
            inner.note(event, actor, &block);
            tracing::info!(block = %block.id, revision = block.revision, "imported");
        }
        Ok(())
    }
}
