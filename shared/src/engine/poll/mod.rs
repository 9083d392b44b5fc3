//! Reads the variables of one device again and again, in the fewest requests that it takes.
//!
//! Sans-IO: [`Poller::poll_request`] gives the message router request to send now, [`Poller::handle_reply`] takes what
//! came of it, [`Poller::poll_timeout`] says when to ask again. One request is outstanding at a time. The order of use:
//! after every call of `handle_reply`, `put_group` … call `poll_request`; if it gives nothing, wait until
//! `poll_timeout`, or for the reply; then drain [`Poller::poll_change`].
//!
//! * *On a grid.* A group is read from start to start. Periods that are missed are counted and left out: after a stall
//!   nothing is made up for. Groups with the same period are due together and share requests.
//! * *In few requests.* What lies inside of a structure or array that is read as a whole is taken from there,
//!   neighbouring elements are one question, and questions travel together (Multiple Service Packet) as far as request
//!   and reply fit.
//! * *It learns.* A packet that is too large is cut in halves; lengths and types that replies showed are used from then
//!   on; a device that refuses packets gets questions one by one.
//! * *A bad tag is isolated.* The others are read in the same cycle; it is asked for by itself after 5 s, then more and
//!   more rarely, up to 60 s.
//! * *Lost is not bad.* Without an answer the rest of the cycle is dropped, and good values are stale, with the reason.

mod answers;
mod assembly;
mod cycle;
mod deliver;
mod group;
mod limits;
mod load;
mod pace;
mod plan;
mod read;
mod reading;

use alloc::collections::{BTreeMap, VecDeque};
use alloc::string::String;
use alloc::vec::Vec;

use self::assembly::Assembly;
use self::cycle::{Flight, Job};
use self::group::Work;
use self::load::Meter;
use self::pace::Pace;
use super::time::Instant;
use crate::wire::GeneralStatus;

pub use self::group::{Group, Item};
pub use self::limits::DeviceLimits;
pub use self::load::Load;
pub use self::reading::{Quality, Reading, Reason};

/// What to send now.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PollRequest {
    /// A message router request.
    pub bytes: Vec<u8>,
}

/// Why there is no reply to read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Failure {
    /// The message was refused, and only the status is left of the reply.
    Refused {
        /// General status.
        status: GeneralStatus,
        /// Additional status words.
        words: Vec<u16>,
    },
    /// No answer: a timeout, an unreachable device, a router that gave up. In words.
    Lost {
        /// What the transport says.
        reason: String,
    },
    /// The device answered that it takes no such message, without a reply: an encapsulation status. cpppo says so of a
    /// tag that it has not. In words.
    NotTaken {
        /// What the device said.
        reason: String,
    },
}

/// Reads the variables of one device.
#[derive(Debug)]
pub struct Poller {
    limits: DeviceLimits,
    /// What packets were found to carry; at most as in `limits`.
    packs: bool,
    request_max: usize,
    reply_max: usize,
    /// The grid of all groups goes through this.
    origin: Option<Instant>,
    groups: BTreeMap<u32, Work>,
    /// Item → its group and its place there.
    places: BTreeMap<u32, (u32, usize)>,
    queue: VecDeque<Job>,
    flight: Option<Flight>,
    /// A long value that is read in several requests.
    assembly: Option<Assembly>,
    pace: Pace,
    meter: Meter,
    changes: VecDeque<(u32, u32)>,
    editions: u64,
    batches: u32,
}

impl Poller {
    /// A device without groups.
    pub fn new(limits: DeviceLimits) -> Self {
        let mut pace = Pace::default();
        pace.set(limits.max_requests_per_s);
        Self {
            limits,
            packs: limits.packs,
            request_max: limits.request_max,
            reply_max: limits.reply_max,
            origin: None,
            groups: BTreeMap::new(),
            places: BTreeMap::new(),
            queue: VecDeque::new(),
            flight: None,
            assembly: None,
            pace,
            meter: Meter::default(),
            changes: VecDeque::new(),
            editions: 0,
            batches: 0,
        }
    }

    /// Other limits: what was learned about packets is forgotten.
    pub fn set_limits(&mut self, limits: DeviceLimits) {
        self.limits = limits;
        (self.packs, self.request_max, self.reply_max) = (limits.packs, limits.request_max, limits.reply_max);
        self.pace.set(limits.max_requests_per_s);
        for work in self.groups.values_mut() {
            work.is_outdated = true;
        }
    }

    /// The limits that were set.
    pub const fn limits(&self) -> &DeviceLimits {
        &self.limits
    }

    /// A new group, or another version of one. Items that are the same keep their values; new ones are read at once.
    pub fn put_group(&mut self, group: Group, now: Instant) {
        let id = group.id;
        let origin = *self.origin.get_or_insert(now);
        let before = self.drop_group(id);
        let work = Work::new(group, before, origin, now);
        for (place, tag) in work.tags.iter().enumerate() {
            self.places.insert(tag.item.id, (id, place));
        }
        self.groups.insert(id, work);
        if let Some(work) = self.groups.get_mut(&id).filter(|work| !work.on) {
            for tag in &mut work.tags {
                if tag.reading.quality == Quality::Good && tag.reading.lost(&Reason::Off) {
                    tag.announce(id, &mut self.changes);
                }
            }
        }
    }

    /// Its items are not read any more, and forgotten.
    pub fn remove_group(&mut self, id: u32, now: Instant) {
        self.drop_group(id);
        self.end_cycle(now);
    }

    /// The next item of which something has changed, with its group: its quality, its reason, its value, or only the
    /// time of its value ([`Reading::changed`] tells). Each waits once, however often it changed.
    pub fn poll_change(&mut self) -> Option<(u32, u32)> {
        loop {
            let (group, item) = self.changes.pop_front()?;
            let place = self.places.get(&item).filter(|(its, _)| *its == group);
            let Some((_, place)) = place else { continue };
            let Some(tag) = self.groups.get_mut(&group).and_then(|work| work.tags.get_mut(*place)) else {
                continue;
            };
            if core::mem::take(&mut tag.is_queued) {
                return Some((group, tag.item.id));
            }
        }
    }

    /// What is known of an item.
    pub fn reading(&self, item: u32) -> Option<&Reading> {
        let (group, place) = self.places.get(&item)?;
        self.groups.get(group)?.tags.get(*place).map(|tag| &tag.reading)
    }

    /// When to call [`Self::poll_request`] again, if nothing happens before. It may be over already.
    pub fn poll_timeout(&self) -> Option<Instant> {
        let stale = self.groups.values().filter_map(Work::stale_at).min();
        if self.flight.is_some() {
            return stale;
        }
        let waiting = self.assembly.is_some() || !self.queue.is_empty();
        let send = waiting.then(|| self.pace.next());
        let due = self.groups.values().filter_map(Work::next).min();
        [stale, send, due].into_iter().flatten().min()
    }

    /// Whether a request is outstanding.
    pub const fn is_waiting(&self) -> bool {
        self.flight.is_some()
    }

    /// What polling costs.
    pub fn load(&self) -> Load {
        let tags = self.groups.values().flat_map(|work| &work.tags);
        let bad = tags.filter(|tag| tag.reading.quality == Quality::Bad).count();
        Load { bad_items: u32::try_from(bad).unwrap_or(u32::MAX), ..self.meter.load }
    }

    fn drop_group(&mut self, id: u32) -> Option<Work> {
        let work = self.groups.remove(&id)?;
        for tag in &work.tags {
            self.places.remove(&tag.item.id);
        }
        self.queue.retain(|job| job.group != id);
        if self.assembly.as_ref().is_some_and(|assembly| assembly.job().group == id) {
            self.assembly = None;
        }
        Some(work)
    }
}
