//! The task of one device: sends what its [`Poller`](poll::Poller) asks for, asks the device how it is, and tells the hub.

mod flight;
mod task;

use std::sync::Arc;

use cipdeck_shared::api::{DeviceLoad, Quality};
use cipdeck_shared::config::{Connecting, DeviceId, Profile};
use cipdeck_shared::engine::Instant;
use cipdeck_shared::engine::poll::{self, Group, Reading};
use cipdeck_shared::plan::TagWay;
use cipdeck_shared::plan::plant::DevicePlan;
use tokio::sync::watch;
use tokio_util::sync::CancellationToken;

use self::flight::landed;
use self::task::Task;
use super::hub::Hub;
use super::point::Point;
use crate::permit::Policy;
use crate::runner::{Clock, Runner};

/// What a device is asked for.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Work {
    /// Whose.
    pub(super) device: DeviceId,
    /// What people call it.
    pub(super) name: String,
    /// Where it is; in words why it cannot be asked.
    pub(super) plan: Result<DevicePlan, String>,
    /// What is read.
    pub(super) groups: Vec<Group>,
}

/// What the tasks of all devices share.
#[derive(Clone, Debug)]
pub(super) struct Shared {
    pub(super) hub: Arc<Hub>,
    pub(super) runner: Runner,
    pub(super) policy: Arc<Policy>,
    pub(super) clock: Clock,
    pub(super) stop: CancellationToken,
}

/// Runs until the device is forgotten or the relay stops.
pub(super) async fn run(shared: Shared, mut work: watch::Receiver<Arc<Work>>) {
    let first = Arc::clone(&work.borrow_and_update());
    let mut task = Task::new(shared, first.device);
    task.take(&first);
    loop {
        task.publish();
        task.send();
        let wake = task.wake();
        let stop = task.shared.stop.clone();
        tokio::select! {
            biased;
            () = stop.cancelled() => return,
            changed = work.changed() => {
                if changed.is_err() {
                    return;
                }
                let work = Arc::clone(&work.borrow_and_update());
                task.take(&work);
            }
            (lane, ended) = landed(&mut task.flight) => task.land(lane, &ended),
            () = wait(wake) => {}
        }
    }
}

/// How messages about tags get to a device of this kind.
pub(super) fn way(plan: &DevicePlan, profile: Profile) -> TagWay {
    let connected = match (profile, plan.connecting) {
        (Profile::Micro800, _) | (_, Connecting::Connected) => true,
        (_, Connecting::Auto | Connecting::Unconnected) => false,
    };
    TagWay { path: plan.path.clone(), profile, connected, timeout_ms: plan.timeout_ms }
}

async fn wait(until: Option<tokio::time::Instant>) {
    match until {
        Some(until) => tokio::time::sleep_until(until).await,
        None => std::future::pending().await,
    }
}

/// What the hub keeps of a reading.
pub(super) fn point(reading: &Reading, clock: Clock) -> Point {
    let at = |instant: Instant| clock.at(instant);
    Point {
        quality: match reading.quality {
            poll::Quality::Waiting => Quality::Waiting,
            poll::Quality::Good => Quality::Good,
            poll::Quality::Stale => Quality::Stale,
            poll::Quality::Bad => Quality::Bad,
        },
        reason: reading.reason.as_ref().map(poll::Reason::text),
        value: reading.value.clone(),
        kind: reading.kind.clone(),
        at: reading.at.map(at),
    }
}

fn load(load: poll::Load, items: u32, work: Option<&Work>) -> DeviceLoad {
    let periods =
        work.iter().flat_map(|work| &work.groups).filter(|group| group.on).map(|group| group.period);
    let shortest = periods.min().map_or(u64::MAX, |period| period.0.saturating_mul(1_000));
    DeviceLoad {
        requests: load.requests,
        requests_per_s: load.last_second,
        requests_per_cycle: load.requests_per_cycle,
        cycle_us: load.cycle_us,
        lateness_us: load.lateness_us,
        skipped_periods: load.skipped_periods,
        items,
        bad_items: load.bad_items,
        // Requests that are only spread over the period keep nothing waiting.
        is_limited: load.is_limited && load.cycle_us >= shortest,
    }
}
