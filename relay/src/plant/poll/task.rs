//! What one device is asked for, message by message.

use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::Duration;

use cipdeck_shared::api::{DeviceStatus, HealthState, Quality};
use cipdeck_shared::config::{DeviceId, GroupId, Profile};
use cipdeck_shared::engine::poll::Poller;
use cipdeck_shared::plan::{MessagePlan, TagWay};
use cipdeck_shared::wire::{MessageRouterRequest, TooLong};

use super::flight::Flight;
use super::{Shared, Work, load, point, way};
use crate::actor::Actor;
use crate::desk::{self, Lost, Why};
use crate::permit::Order;
use crate::plant::health;
use crate::plant::point::Point;
use crate::plant::work::idle;
use crate::runner::{Ended, Lane, Refused};

/// A device is asked how it is so often.
const HEALTH_PERIOD: Duration = Duration::from_secs(30);

/// How long a device that did not answer is left alone, at first and at most.
const FIRST_REST: Duration = Duration::from_millis(250);
const LONGEST_REST: Duration = Duration::from_secs(5);

/// What polling costs is told at most so often.
const STATUS_PAUSE: Duration = Duration::from_millis(250);

/// What is done for one device, and what is known of it.
pub(super) struct Task {
    pub(super) shared: Shared,
    device: DeviceId,
    work: Option<Arc<Work>>,
    /// From when the device is known.
    poller: Option<Poller>,
    profile: Profile,
    lane: Option<Lane>,
    pub(super) flight: Option<Flight>,
    status: DeviceStatus,
    /// The device is asked how it is.
    health_due: tokio::time::Instant,
    /// It is left alone until then.
    rests_until: tokio::time::Instant,
    rest: Duration,
    /// The status was told, and may be told again then.
    told: Option<DeviceStatus>,
    tell: tokio::time::Instant,
}

impl Task {
    pub(super) fn new(shared: Shared, device: DeviceId) -> Self {
        let now = tokio::time::Instant::now();
        Self {
            shared,
            device,
            work: None,
            poller: None,
            profile: Profile::Auto,
            lane: None,
            flight: None,
            status: idle(device),
            health_due: now,
            rests_until: now,
            rest: FIRST_REST,
            told: None,
            tell: now,
        }
    }

    /// Something else is to be done from now on.
    pub(super) fn take(&mut self, work: &Arc<Work>) {
        let before = self.work.replace(Arc::clone(work));
        let is_same_device = before.as_ref().is_some_and(|before| before.plan == work.plan);
        if !is_same_device {
            if before.is_some() {
                self.forget_values("the device was changed, and has not been read since");
            }
            let now = tokio::time::Instant::now();
            (self.poller, self.flight, self.lane, self.rest) = (None, None, None, FIRST_REST);
            (self.health_due, self.rests_until) = (now, now);
            self.status = idle(self.device);
            self.profile = work.plan.as_ref().map_or(Profile::Auto, |plan| plan.profile);
            if let Err(wrong) = &work.plan {
                self.status.errors = vec![wrong.clone()];
            }
            self.start_polling();
        } else if let Some(poller) = &mut self.poller {
            let now = self.shared.clock.now();
            let old: BTreeMap<_, _> =
                before.iter().flat_map(|before| &before.groups).map(|group| (group.id, group)).collect();
            for id in old.keys().filter(|id| work.groups.iter().all(|group| group.id != **id)) {
                poller.remove_group(*id, now);
            }
            for group in work.groups.iter().filter(|group| old.get(&group.id) != Some(group)) {
                poller.put_group(group.clone(), now);
            }
        }
        let items = work.groups.iter().filter(|group| group.on).map(|group| group.items.len()).sum::<usize>();
        self.status.load.items = u32::try_from(items).unwrap_or(u32::MAX);
        if !self.is_on() {
            // Its session may close.
            self.lane = None;
            self.status.health = idle(self.device).health;
            self.health_due = tokio::time::Instant::now();
        } else if self.status.health.state == HealthState::Idle {
            self.status.health.state = HealthState::Asking;
            "it is being asked".clone_into(&mut self.status.health.words);
        }
    }

    /// Whether the device is to be asked at all.
    fn is_on(&self) -> bool {
        let work = self.work.as_ref();
        work.is_some_and(|work| work.plan.is_ok() && work.groups.iter().any(|group| group.on))
    }

    /// From when the kind of device is known.
    fn start_polling(&mut self) {
        let Some(work) = self.work.clone().filter(|_| self.profile != Profile::Auto) else { return };
        let Ok(plan) = &work.plan else { return };
        let mut limits = desk::limits(&way(plan, self.profile));
        // Blocks to the same device get their share of what it takes.
        let shared = self.shared.policy.messages_per_second();
        let share = if shared == 0 { u32::MAX } else { (shared / 4 * 3).max(1) };
        limits.max_requests_per_s = plan.max_requests_per_s.min(share);
        let (mut poller, now) = (Poller::new(limits), self.shared.clock.now());
        for group in &work.groups {
            poller.put_group(group.clone(), now);
        }
        self.profile.word().clone_into(&mut self.status.profile);
        self.poller = Some(poller);
    }

    /// Sends what is due, if nothing is under way.
    pub(super) fn send(&mut self) {
        if self.flight.is_some() || !self.is_on() || tokio::time::Instant::now() < self.rests_until {
            return;
        }
        let Some(work) = self.work.clone() else { return };
        let Ok(plan) = &work.plan else { return };
        if tokio::time::Instant::now() >= self.health_due {
            // Every device takes this unconnected.
            let way = TagWay { connected: false, ..way(plan, self.profile) };
            return self.fly(
                &work.name,
                true,
                desk::identity_request().and_then(|it| MessagePlan::tag(&way, it)),
            );
        }
        let now = self.shared.clock.now();
        let Some(request) = self.poller.as_mut().and_then(|poller| poller.poll_request(now)) else { return };
        let way = way(plan, self.profile);
        let message = MessageRouterRequest::decode(&request.bytes)
            .map_err(|error| error.to_string())
            .and_then(|message| MessagePlan::tag(&way, message).map_err(|error| error.to_string()));
        match message {
            Ok(message) => self.fly(&work.name, false, Ok(message)),
            Err(reason) => self.answer(Err(Lost::silent(reason))),
        }
    }

    fn fly(&mut self, name: &str, is_health: bool, message: Result<MessagePlan, TooLong>) {
        let Ok(message) = message else { return };
        let lane = self.lane.take().unwrap_or_else(|| self.shared.runner.lane(name));
        if !is_health {
            self.shared.policy.metrics.poll();
        }
        let message = async move {
            let mut lane = lane;
            let ended = lane.send(message, Some(Order::read(Actor::relay()))).await;
            (lane, ended)
        };
        self.flight = Some(Flight { is_health, message: Box::pin(message) });
    }

    /// A message has ended.
    pub(super) fn land(&mut self, lane: Lane, ended: &Result<Ended, Refused>) {
        let is_health = self.flight.take().is_some_and(|flight| flight.is_health);
        self.lane = self.is_on().then_some(lane);
        let reply = desk::reply(ended);
        if let Err(lost) = &reply
            && lost.why != Why::NotTaken
        {
            self.rests_until = tokio::time::Instant::now() + self.rest;
            self.rest = (self.rest * 2).min(LONGEST_REST);
            if is_health {
                // Where it is known how, values are asked for next: each says that it is lost.
                let wait = if self.poller.is_some() { HEALTH_PERIOD } else { Duration::ZERO };
                self.health_due = self.rests_until + wait;
            }
            if self.is_on() {
                self.status.health = health::lost(&self.status.health, lost);
            }
        } else {
            self.rest = FIRST_REST;
            if matches!(self.status.health.state, HealthState::Lost | HealthState::Denied) {
                // It is back: how is it?
                self.health_due = tokio::time::Instant::now();
            }
        }
        match (is_health, reply) {
            (false, reply) => self.answer(reply),
            (true, Ok(reply)) => self.identified(reply),
            (true, Err(lost)) => self.nothing_is_read(&lost.reason),
        }
    }

    fn answer(&mut self, reply: Result<&[u8], Lost>) {
        let now = self.shared.clock.now();
        if let Some(poller) = &mut self.poller {
            poller.handle_reply(now, reply.map_err(|lost| lost.failure()));
        }
    }

    /// The device has said what it is, or has refused to.
    fn identified(&mut self, reply: &[u8]) {
        self.health_due = tokio::time::Instant::now() + HEALTH_PERIOD;
        match desk::identity(reply) {
            Ok(identity) => {
                self.status.health = health::good(&identity);
                if self.profile == Profile::Auto {
                    let (vendor, kind) = (identity.vendor, identity.device_type);
                    self.profile = Profile::of_identity(vendor, kind, identity.name.bytes());
                    self.start_polling();
                }
            }
            Err(why) => {
                self.status.health.state = HealthState::Good;
                self.status.health.words = format!("it answers, and {why}");
                if self.profile == Profile::Auto {
                    self.profile = Profile::Generic;
                    self.start_polling();
                }
            }
        }
    }

    /// Nobody knows yet how this device is asked for values: it has not said what it is.
    fn nothing_is_read(&self, reason: &str) {
        if self.poller.is_none() {
            self.forget_values(reason);
        }
    }

    /// What is there is no longer what the device has.
    fn forget_values(&self, reason: &str) {
        let groups = self.work.iter().flat_map(|work| &work.groups);
        for group in groups.filter(|group| group.on) {
            self.shared.hub.put_all_points(GroupId(group.id), |point| Point {
                quality: if point.value.is_some() { Quality::Stale } else { Quality::Bad },
                reason: Some(reason.to_owned()),
                ..point.clone()
            });
        }
    }

    /// When something is to be done, if nothing happens before.
    pub(super) fn wake(&self) -> Option<tokio::time::Instant> {
        let tell = (self.told.as_ref() != Some(&self.status)).then_some(self.tell);
        if !self.is_on() {
            return tell;
        }
        let due = self.poller.as_ref().and_then(Poller::poll_timeout).map(|due| self.shared.clock.at(due));
        let send =
            [Some(self.health_due), due].into_iter().flatten().min().map(|due| due.max(self.rests_until));
        let send = send.filter(|_| self.flight.is_none());
        [tell, send].into_iter().flatten().min()
    }

    /// Tells what has changed.
    pub(super) fn publish(&mut self) {
        let clock = self.shared.clock;
        if let Some(poller) = &mut self.poller {
            let mut points = Vec::new();
            while let Some((group, item)) = poller.poll_change() {
                if let Some(reading) = poller.reading(item) {
                    points.push((GroupId(group), item, point(reading, clock)));
                }
            }
            if !points.is_empty() {
                self.shared.policy.metrics.values(points.len());
                self.shared.hub.put_points(points);
            }
        }
        let now = tokio::time::Instant::now();
        let told = self.told.as_ref();
        let is_urgent = told.is_none_or(|told| told.health.state != self.status.health.state);
        if !is_urgent && now < self.tell {
            return;
        }
        if let Some(poller) = &self.poller {
            self.status.load = load(poller.load(), self.status.load.items, self.work.as_deref());
        }
        if self.told.as_ref() != Some(&self.status) {
            self.shared.hub.put_status(self.status.clone());
            self.told = Some(self.status.clone());
            self.tell = now + STATUS_PAUSE;
        }
    }
}
