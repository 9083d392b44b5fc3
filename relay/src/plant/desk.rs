//! A conversation with a device about one of its variables, in somebody's name.

use cipdeck_shared::config::Profile;
use cipdeck_shared::engine::Millis;
use cipdeck_shared::engine::poll::{DeviceLimits, Failure, Group, Item, Poller, Reading};
use cipdeck_shared::plan::plant::{DevicePlan, VariablePlan};
use cipdeck_shared::plan::{MessagePlan, TagWay};
use cipdeck_shared::tag::{Dialect, TagName, Type};
use cipdeck_shared::wire::MessageRouterRequest;

use super::health::{self, Lost};
use super::limits;
use super::poll::way;
use crate::actor::Actor;
use crate::permit::Order;
use crate::runner::{Clock, Lane, Runner};

/// Who speaks with which device, and how.
#[derive(Debug)]
pub(super) struct Desk {
    pub(super) lane: Lane,
    way: TagWay,
    limits: DeviceLimits,
    clock: Clock,
}

/// Longer than anything that is read once takes: its group is due only once.
const ONCE: Millis = Millis(24 * 3_600_000);

impl Desk {
    /// Begins. A device of which nobody knows what it is, is asked.
    pub(super) async fn open(
        runner: &Runner,
        clock: Clock,
        name: &str,
        plan: &DevicePlan,
        profile: Profile,
        actor: &Actor,
    ) -> Result<Self, Lost> {
        let mut lane = runner.lane(name);
        let mut profile = profile;
        if profile == Profile::Auto {
            let way = TagWay { connected: false, ..way(plan, profile) };
            let request = health::request().map_err(|error| lost(error.to_string()))?;
            let message = MessagePlan::tag(&way, request).map_err(|error| lost(error.to_string()))?;
            let ended = lane.send(message, Some(Order::read(actor.clone()))).await;
            let identity = health::identity(health::reply(&ended)?);
            profile = identity.map_or(Profile::Generic, |identity| {
                Profile::of_identity(identity.vendor, identity.device_type, identity.name.bytes())
            });
        }
        Ok(Self { lane, way: way(plan, profile), limits: limits(plan, profile), clock })
    }

    /// How the device lays values out.
    pub(super) const fn dialect(&self) -> Dialect {
        self.limits.dialect
    }

    /// Reads a variable, in as many messages as it takes.
    pub(super) async fn read(
        &mut self,
        actor: &Actor,
        name: &TagName,
        kind: Option<&Type>,
    ) -> Result<Reading, Lost> {
        let item = Item { id: 0, name: name.clone(), kind: kind.cloned() };
        let mut poller = Poller::new(self.limits);
        poller.put_group(Group { id: 0, period: ONCE, on: true, items: vec![item] }, self.clock.now());
        while let Some(request) = poller.poll_request(self.clock.now()) {
            let reply = match self.ask(actor, &request.bytes).await {
                Err(lost) if lost.is_denied => return Err(lost),
                reply => reply,
            };
            let reply = reply.as_deref().map_err(|lost| Failure::Lost { reason: lost.reason.clone() });
            poller.handle_reply(self.clock.now(), reply);
        }
        Ok(poller.reading(0).cloned().unwrap_or_default())
    }

    /// [`Self::read`], of a variable as it is configured.
    pub(super) async fn variable(&mut self, actor: &Actor, plan: &VariablePlan) -> Result<Reading, Lost> {
        self.read(actor, &plan.name, plan.kind.as_ref()).await
    }

    /// What would be sent, ready to be asked about; its revision.
    pub(super) fn put(&mut self, request: MessageRouterRequest) -> Result<u64, String> {
        let (length, max) = (request.bytes().len(), self.limits.request_max);
        if length > max {
            return Err(format!(
                "the message has {length} bytes, and the device takes {max}: write elements or members one by one"
            ));
        }
        let message = MessagePlan::tag(&self.way, request).map_err(|error| error.to_string())?;
        Ok(self.lane.put(message))
    }

    /// One message that reads: the message router reply, refusals included.
    pub(super) async fn ask(&mut self, actor: &Actor, request: &[u8]) -> Result<Vec<u8>, Lost> {
        let request = MessageRouterRequest::decode(request).map_err(|error| lost(error.to_string()))?;
        let message = MessagePlan::tag(&self.way, request).map_err(|error| lost(error.to_string()))?;
        let ended = self.lane.send(message, Some(Order::read(actor.clone()))).await;
        health::reply(&ended).map(<[u8]>::to_vec)
    }
}

fn lost(reason: String) -> Lost {
    Lost { is_denied: false, reason }
}
