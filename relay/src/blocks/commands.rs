//! Commands to a block. A write has two halves: the offer, which shows what is there and what will be there, and the
//! command that carries the ticket of the offer.

use std::sync::Arc;

use cipdeck_shared::api::{BlockStatus, ReadValue, WriteTicket, Written, findings};
use cipdeck_shared::config::{Block, BlockConfig, BlockId};
use cipdeck_shared::plan::MessagePlan;

use super::{Blocks, plan};
use crate::actor::Actor;
use crate::audit::Event;
use crate::error::ApiError;
use crate::permit::{Confirmed, Offer, Order, record};
use crate::ritual;
use crate::runner::Refused;

impl Blocks {
    /// The first half of a write: what is there, what will be there, and the ticket for the second half.
    pub(crate) async fn offer(
        &self,
        actor: &Actor,
        id: BlockId,
        revision: u64,
    ) -> Result<WriteTicket, ApiError> {
        let (runner, policy) = (&self.0.runner, &self.0.policy);
        let block = self.block(id)?;
        if block.revision != revision {
            return Err(ApiError::Stale(Box::new(block)));
        }
        let plan = plan(&block.config).map_err(|all| ApiError::Findings(findings(&all)))?;
        if !plan.access().may_write() {
            return Err(ApiError::Unreadable(format!("{id} only reads: it is run without a ticket")));
        }
        let order = Order { actor: actor.clone(), confirmed: policy.hypothetical(revision) };
        runner.ask(id, &order)?;
        let reader = plan.reader();
        let old = match &reader {
            Some(reader) => self.read(actor, &block, reader.clone()).await,
            None => Err("no service reads what this one writes".to_owned()),
        };
        let new = reader.and_then(|reader| ritual::wanted(&reader, &plan, layout(&block.config)));
        let offer = Offer { revision, request: Arc::clone(plan.bytes()), old: old.clone().ok(), new };
        Ok(policy.offer(actor, id, &offer, old.err()).map_err(Refused::from)?)
    }

    /// One message. The status at DN or ER; after a write with what is there then.
    pub(crate) async fn run(
        &self,
        actor: &Actor,
        id: BlockId,
        ticket: Option<&str>,
    ) -> Result<BlockStatus, ApiError> {
        let order = self.order(actor, id, ticket)?;
        let confirmed = order.confirmed.clone();
        let config = self.block(id)?.config;
        let ended = self.0.runner.run(id, Some(order)).await?;
        let has_written = ended.view.q;
        // A block that has been deleted meanwhile has no status.
        let mut status = ended.status.ok_or_else(|| ApiError::no_block(id))?;
        if let Some(confirmed) = confirmed.filter(|_| has_written) {
            status.written = Some(self.read_back(actor, id, &config, confirmed).await);
        }
        Ok(status)
    }

    async fn read_back(
        &self,
        actor: &Actor,
        id: BlockId,
        config: &BlockConfig,
        confirmed: Confirmed,
    ) -> Written {
        let block = Block { id, revision: confirmed.revision, config: config.clone() };
        let read = match plan(config).ok().and_then(|plan| plan.reader()) {
            Some(reader) => self.read(actor, &block, reader).await.ok(),
            None => None,
        };
        let written = ritual::written(confirmed.old, confirmed.new, read);
        let record = record(Event::WriteReadBack, actor)
            .with("block", id.to_string())
            .with("ticket", confirmed.id)
            .with_some("read_back", written.read_back.as_ref().map(|value| value.data.clone()))
            .with_some("is_equal", written.is_equal);
        self.0.policy.note(&record);
        written
    }

    /// A read that belongs to a write.
    async fn read(&self, actor: &Actor, block: &Block, plan: MessagePlan) -> Result<ReadValue, String> {
        let order = Order::read(actor.clone());
        let ended = self.0.runner.pass(block.config.name(), plan, order).await;
        ended
            .map_err(|refused| refused.to_string())
            .and_then(|ended| ritual::found(&ended, layout(&block.config)))
    }

    fn order(&self, actor: &Actor, id: BlockId, ticket: Option<&str>) -> Result<Order, ApiError> {
        let confirmed = ticket.map(|ticket| self.0.policy.redeem(ticket, actor, id)).transpose();
        Ok(Order { actor: actor.clone(), confirmed: confirmed.map_err(Refused::from)? })
    }

    /// Sets IN.
    pub(crate) async fn set_in(
        &self,
        actor: &Actor,
        id: BlockId,
        input: bool,
        ticket: Option<&str>,
    ) -> Result<BlockStatus, ApiError> {
        let resumes = self.block(id)?.config.resume();
        // To stop takes no ticket: one that is not good any more must keep nobody from it.
        let order = Some(self.order(actor, id, ticket.filter(|_| input))?);
        if resumes {
            self.edit(|inner| async move {
                inner.runner.set_in(id, input, order)?;
                Ok(inner.store.set_input(id, input).await?)
            })
            .await?;
        } else {
            self.0.runner.set_in(id, input, order)?;
        }
        self.status(id)
    }

    /// Cancels what is under way.
    pub(crate) fn cancel(&self, id: BlockId) -> Result<BlockStatus, ApiError> {
        self.0.runner.cancel(id)?;
        self.status(id)
    }
}

/// What somebody says about the values that are written. Of a message with start and quantity in front of them it is about
/// these, too: then nothing is said about the values alone.
fn layout(config: &BlockConfig) -> &str {
    let has_values_alone = plan(config).is_ok_and(|plan| plan.written().len() == plan.request().data().len());
    if has_values_alone { config.req_layout() } else { "" }
}
