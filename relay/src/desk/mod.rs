//! A conversation with a device about its tags, in somebody's name: one message after the other.

mod message;
mod reply;

use cipdeck_shared::config::Profile;
use cipdeck_shared::engine::Millis;
use cipdeck_shared::engine::poll::{DeviceLimits, Group, Item, Poller, Reading};
use cipdeck_shared::plan::{MessagePlan, TagWay};
use cipdeck_shared::tag::{Dialect, TagName, Type};
use cipdeck_shared::wire::MessageRouterRequest;

pub(crate) use self::message::{one_bit, refused, whole};
pub(crate) use self::reply::{Lost, Why, identity, identity_request, reply};
use crate::permit::Order;
use crate::runner::{Clock, Lane};

/// Who speaks with which device, and how.
#[derive(Debug)]
pub(crate) struct Desk {
    pub(crate) lane: Lane,
    way: TagWay,
    limits: DeviceLimits,
    clock: Clock,
    /// In whose name; none for whoever types on this machine.
    order: Option<Order>,
}

/// Longer than anything that is read once takes: its group is due only once.
const ONCE: Millis = Millis(24 * 3_600_000);

/// What a device takes on this way.
pub(crate) fn limits(way: &TagWay) -> DeviceLimits {
    let mut limits = DeviceLimits::of(Dialect::of(way.profile), way.connected);
    if !way.connected && !way.path.route.is_empty() {
        // Around a request that goes on along a route: Unconnected_Send with its path, two sizes, and a pad.
        let wrapping = 14 + way.path.route.bytes().len();
        limits.request_max = limits.request_max.saturating_sub(wrapping);
    }
    limits
}

impl Desk {
    /// Begins. A device of which nobody knows what it is, is asked; one that does not say it is taken for a usual one.
    pub(crate) async fn open(
        lane: Lane,
        clock: Clock,
        way: TagWay,
        order: Option<Order>,
    ) -> Result<Self, Lost> {
        let mut desk = Self { lane, limits: limits(&way), way, clock, order };
        if desk.way.profile == Profile::Auto {
            let way = TagWay { connected: false, ..desk.way.clone() };
            let request = identity_request().map_err(|error| Lost::silent(error.to_string()))?;
            let reply = desk.send(&way, request).await?;
            desk.way.profile = identity(&reply).map_or(Profile::Generic, |identity| {
                Profile::of_identity(identity.vendor, identity.device_type, identity.name.bytes())
            });
        }
        desk.way.connected |= desk.way.profile == Profile::Micro800;
        desk.limits = limits(&desk.way);
        Ok(desk)
    }

    /// What the device is.
    pub(crate) const fn profile(&self) -> Profile {
        self.way.profile
    }

    /// How it lays values out.
    pub(crate) const fn dialect(&self) -> Dialect {
        self.limits.dialect
    }

    /// Reads tags, in as few messages as it takes; in their order.
    pub(crate) async fn read_all(&mut self, items: Vec<Item>) -> Result<Vec<Reading>, Lost> {
        let ids: Vec<_> = items.iter().map(|item| item.id).collect();
        let mut poller = Poller::new(self.limits);
        poller.put_group(Group { id: 0, period: ONCE, on: true, items }, self.clock.now());
        while let Some(request) = poller.poll_request(self.clock.now()) {
            let reply = match self.ask(&request.bytes).await {
                Err(lost) if lost.why == Why::Denied => return Err(lost),
                reply => reply,
            };
            poller.handle_reply(self.clock.now(), reply.as_deref().map_err(Lost::failure));
        }
        Ok(ids.iter().map(|id| poller.reading(*id).cloned().unwrap_or_default()).collect())
    }

    /// Reads a tag, in as many messages as it takes.
    pub(crate) async fn read(&mut self, name: &TagName, kind: Option<&Type>) -> Result<Reading, Lost> {
        let item = Item { id: 0, name: name.clone(), kind: kind.cloned() };
        Ok(self.read_all(vec![item]).await?.pop().unwrap_or_default())
    }

    /// What would be sent, ready to be asked about; its revision.
    pub(crate) fn put(&mut self, request: MessageRouterRequest) -> Result<u64, String> {
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
    pub(crate) async fn ask(&mut self, request: &[u8]) -> Result<Vec<u8>, Lost> {
        let request =
            MessageRouterRequest::decode(request).map_err(|error| Lost::silent(error.to_string()))?;
        let way = self.way.clone();
        self.send(&way, request).await
    }

    async fn send(&mut self, way: &TagWay, request: MessageRouterRequest) -> Result<Vec<u8>, Lost> {
        let message = MessagePlan::tag(way, request).map_err(|error| Lost::silent(error.to_string()))?;
        let ended = self.lane.send(message, self.order.clone()).await;
        reply(&ended).map(<[u8]>::to_vec)
    }
}
