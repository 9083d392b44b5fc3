//! A controller that is asked about its tags: what it is, and one message after the other.

use cipdeck_shared::config::Profile;
use cipdeck_shared::engine::Millis;
use cipdeck_shared::engine::poll::{DeviceLimits, Failure, Group, Item, Poller, Reading};
use cipdeck_shared::plan::{MessagePlan, TagWay};
use cipdeck_shared::tag::Dialect;
use cipdeck_shared::wire::MessageRouterRequest;

use crate::cli::Exit;
use crate::client::Client;
use crate::plant::health::{self, Lost};
use crate::runner::{Clock, Lane};
use crate::shutdown;

/// An open controller.
pub(super) struct Controller {
    client: Client,
    lane: Lane,
    way: TagWay,
    limits: DeviceLimits,
    clock: Clock,
}

/// Longer than anything that is read once takes: its group is due only once.
const ONCE: Millis = Millis(24 * 3_600_000);

impl Controller {
    /// Runs a command with a controller, and says farewell to it however that ends.
    pub(super) async fn with(way: TagWay, command: impl AsyncFnOnce(&mut Self) -> Exit) -> Exit {
        let client = Client::start();
        let lane = client.lane("tags");
        let limits = DeviceLimits::of(Dialect::default(), way.connected);
        let mut controller = Self { client, lane, way, limits, clock: Clock::start() };
        let exit = tokio::select! {
            exit = async {
                match controller.identify().await {
                    Ok(()) => command(&mut controller).await,
                    Err(exit) => exit,
                }
            } => exit,
            () = shutdown::requested() => Exit::interrupted(&"interrupted; what had been sent may have been carried out"),
        };
        let Self { client, lane, .. } = controller;
        drop(lane);
        client.stop().await;
        exit
    }

    /// How it lays values out.
    pub(super) const fn dialect(&self) -> Dialect {
        self.limits.dialect
    }

    /// What it takes.
    pub(super) const fn limits(&self) -> DeviceLimits {
        self.limits
    }

    /// What it is.
    pub(super) const fn profile(&self) -> Profile {
        self.way.profile
    }

    async fn identify(&mut self) -> Result<(), Exit> {
        if self.way.profile == Profile::Auto {
            let way = TagWay { connected: false, ..self.way.clone() };
            let request = health::request().map_err(|error| Exit::internal(&error))?;
            let reply = self.send(&way, request).await.map_err(|lost| Exit::unanswered(&lost.reason))?;
            // Whoever does not say what it is, is asked as most are.
            self.way.profile = health::identity(&reply).map_or(Profile::Generic, |identity| {
                Profile::of_identity(identity.vendor, identity.device_type, identity.name.bytes())
            });
        }
        self.way.connected |= self.way.profile == Profile::Micro800;
        self.limits = DeviceLimits::of(Dialect::of(self.way.profile), self.way.connected);
        if !self.way.connected && !self.way.path.route.is_empty() {
            // Unconnected_Send around a request: its head, two sizes, a pad, and the route.
            let wrapped = 14 + self.way.path.route.bytes().len();
            self.limits.request_max = self.limits.request_max.saturating_sub(wrapped);
        }
        Ok(())
    }

    /// One message: the message router reply, refusals included.
    pub(super) async fn ask(&mut self, request: MessageRouterRequest) -> Result<Vec<u8>, Lost> {
        let way = self.way.clone();
        self.send(&way, request).await
    }

    async fn send(&mut self, way: &TagWay, request: MessageRouterRequest) -> Result<Vec<u8>, Lost> {
        let lost = |reason: String| Lost { is_denied: false, reason };
        let plan = MessagePlan::tag(way, request).map_err(|error| lost(error.to_string()))?;
        let ended = self.lane.send(plan, None).await;
        health::reply(&ended).map(<[u8]>::to_vec)
    }

    /// Each of them once, in as few messages as it takes.
    pub(super) async fn read(&mut self, items: Vec<Item>) -> Vec<Reading> {
        let ids: Vec<_> = items.iter().map(|item| item.id).collect();
        let mut poller = Poller::new(self.limits);
        poller.put_group(Group { id: 0, period: ONCE, on: true, items }, self.clock.now());
        while let Some(request) = poller.poll_request(self.clock.now()) {
            let reply = match MessageRouterRequest::decode(&request.bytes) {
                Ok(request) => self.ask(request).await,
                Err(error) => Err(Lost { is_denied: false, reason: error.to_string() }),
            };
            let reply = reply.as_deref().map_err(|lost| Failure::Lost { reason: lost.reason.clone() });
            poller.handle_reply(self.clock.now(), reply);
        }
        ids.iter().map(|id| poller.reading(*id).cloned().unwrap_or_default()).collect()
    }
}
