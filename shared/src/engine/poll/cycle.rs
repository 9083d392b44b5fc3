//! From due groups to requests.

use alloc::vec::Vec;

use super::assembly::Assembly;
use super::group::Work;
use super::read::{REPLY_HEAD, Read, Retry, Way};
use super::reading::Reason;
use super::{DeviceLimits, PollRequest, Poller};
use crate::engine::time::Instant;
use crate::wire::{ClassCode, Epath, MultipleServicePacket, ServiceCode};

/// A read that is to be asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Job {
    pub(super) group: u32,
    pub(super) edition: u64,
    pub(super) read: usize,
    /// Not in a packet with others.
    pub(super) is_alone: bool,
    /// Packets are made of jobs of one batch.
    pub(super) batch: u32,
}

/// The outstanding request.
#[derive(Debug)]
pub(super) struct Flight {
    pub(super) jobs: Vec<Job>,
    pub(super) is_packet: bool,
    pub(super) service: ServiceCode,
    /// Its length, bytes.
    pub(super) length: usize,
}

/// Isolated reads that are tried again in one cycle of a group.
const MAX_RETRIES: usize = 4;

/// Multiple Service Packet to the Message Router: service, path size, `20 02 24 01`, count.
const PACKET_HEAD: usize = 2 + 4 + 2;

/// Its reply: head, count.
const PACKET_REPLY_HEAD: usize = 4 + 2;

/// For each part.
const OFFSET: usize = 2;

impl Poller {
    /// The request to send now; `None`: nothing is due, the device is not to be asked yet, or a reply is outstanding.
    pub fn poll_request(&mut self, now: Instant) -> Option<PollRequest> {
        self.meter.tick(now);
        self.mark_stale(now);
        self.begin_due(now);
        if self.flight.is_some() {
            return None;
        }
        self.drop_outdated();
        if self.assembly.is_none() && self.queue.is_empty() {
            return None;
        }
        if !self.pace.allows(now) {
            self.meter.limited();
            return None;
        }
        let (bytes, flight) = self.compose(now)?;
        self.flight = Some(flight);
        self.pace.sent(now);
        self.meter.sent(now);
        Some(PollRequest { bytes })
    }

    /// The read of a job, unless its group was planned anew since.
    pub(super) fn read_of(&self, job: Job) -> Option<&Read> {
        let work = self.groups.get(&job.group).filter(|work| work.edition == job.edition)?;
        work.reads.get(job.read)
    }

    /// The same, to change it, with its group.
    pub(super) fn work_of(&mut self, job: Job) -> Option<&mut Work> {
        self.groups.get_mut(&job.group).filter(|work| work.edition == job.edition)
    }

    pub(super) fn next_batch(&mut self) -> u32 {
        self.batches = self.batches.wrapping_add(1).max(1);
        self.batches
    }

    /// Whether all questions of the round are answered.
    pub(super) fn end_cycle(&mut self, now: Instant) {
        self.drop_outdated();
        if self.flight.is_none() && self.assembly.is_none() && self.queue.is_empty() {
            self.meter.end(now);
        }
    }

    fn drop_outdated(&mut self) {
        while let Some(job) = self.queue.front().copied() {
            if self.read_of(job).is_some() {
                break;
            }
            self.queue.pop_front();
        }
    }

    fn mark_stale(&mut self, now: Instant) {
        for (id, work) in &mut self.groups {
            work.mark_stale(*id, now, &mut self.changes);
        }
    }

    /// Queues what is due.
    fn begin_due(&mut self, now: Instant) {
        let Some(origin) = self.origin else { return };
        let is_due = |work: &Work| work.next().is_some_and(|next| next <= now);
        if !self.groups.values().any(is_due) {
            return;
        }
        let due: Vec<u32> = self.groups.iter().filter(|(_, work)| is_due(work)).map(|(id, _)| *id).collect();
        for id in due {
            let taken = self.groups.get_mut(&id).and_then(|work| work.take_due(origin, now));
            let Some(taken) = taken else { continue };
            self.meter.load.skipped_periods += taken.skipped;
            if taken.begins {
                self.meter.begin(now, taken.late_us);
                self.begin(id, now);
            }
        }
        self.end_cycle(now);
    }

    fn begin(&mut self, id: u32, now: Instant) {
        let Some(work) = self.groups.get_mut(&id) else { return };
        if work.is_outdated {
            self.editions += 1;
            work.plan(id, self.editions, &self.limits, &mut self.changes);
        }
        let mut retries = 0;
        for (place, read) in work.reads.iter_mut().enumerate() {
            let job = Job { group: id, edition: work.edition, read: place, is_alone: false, batch: 0 };
            let job = match read.retry {
                Some(retry) if retry.at > now => continue,
                Some(Retry { together: false, .. }) if retries == MAX_RETRIES => continue,
                Some(Retry { together: false, .. }) => {
                    retries += 1;
                    Job { is_alone: true, ..job }
                }
                _ => job,
            };
            self.queue.push_back(job);
            work.open += 1;
        }
        if work.open == 0 {
            work.end(now);
        }
    }

    fn compose(&mut self, now: Instant) -> Option<(Vec<u8>, Flight)> {
        loop {
            if let Some(assembly) = &self.assembly {
                let job = assembly.job();
                let read = self.read_of(job);
                if let Some(request) = read.and_then(|read| assembly.request(read, self.limits.dialect)) {
                    let flight = Flight {
                        jobs: alloc::vec![job],
                        is_packet: false,
                        service: request.service(),
                        length: request.bytes().len(),
                    };
                    return Some((request.bytes(), flight));
                }
                self.assembly = None;
                self.fail(job, &Reason::ValueTooLong, true, now);
                self.done(job, now);
            }
            let first = self.queue.pop_front()?;
            match self.read_of(first).map(|read| read.way) {
                Some(Way::Plain) => return self.gather(first),
                Some(_) => self.assembly = Some(Assembly::new(first)),
                None => {}
            }
        }
    }

    /// As many questions as fit, in their order.
    fn gather(&mut self, first: Job) -> Option<(Vec<u8>, Flight)> {
        let read = self.read_of(first)?;
        let mut size = Size::default().with(read);
        let mut jobs = alloc::vec![first];
        while let Some(next) =
            self.queue.front().copied().filter(|next| self.packs && first.packs_with(*next))
        {
            let Some(read) = self.read_of(next) else {
                self.queue.pop_front();
                continue;
            };
            let larger = size.with(read);
            if read.way != Way::Plain || larger.request > self.request_max || larger.reply > self.reply_max {
                break;
            }
            size = larger;
            jobs.push(next);
            self.queue.pop_front();
        }
        let parts: Vec<&[u8]> =
            jobs.iter().filter_map(|job| Some(self.read_of(*job)?.request.as_slice())).collect();
        let is_packet = parts.len() > 1;
        let (bytes, service) = match *parts.as_slice() {
            [] => return None,
            [one] => (one.to_vec(), ServiceCode::ReadTag),
            _ => (packet(parts)?, ServiceCode::MultipleServicePacket),
        };
        let length = bytes.len();
        Some((bytes, Flight { jobs, is_packet, service, length }))
    }

    /// Bytes of the reply that is expected to a packet, and whether all of it was seen before.
    pub(super) fn expected_reply(&self, jobs: &[Job]) -> (usize, bool) {
        let reads = jobs.iter().filter_map(|job| self.read_of(*job));
        reads.fold((PACKET_REPLY_HEAD, true), |(sum, seen), read| {
            (sum + OFFSET + read.reply, seen && read.is_seen)
        })
    }
}

impl Job {
    /// Whether they may travel in one packet.
    fn packs_with(self, other: Self) -> bool {
        !self.is_alone && !other.is_alone && self.batch == other.batch
    }
}

/// Lengths of a packet.
#[derive(Clone, Copy, Debug)]
struct Size {
    request: usize,
    reply: usize,
}

impl Default for Size {
    fn default() -> Self {
        Self { request: PACKET_HEAD, reply: PACKET_REPLY_HEAD }
    }
}

impl Size {
    const fn with(self, read: &Read) -> Self {
        Self { request: self.request + OFFSET + read.request.len(), reply: self.reply + OFFSET + read.reply }
    }
}

fn packet(parts: Vec<&[u8]>) -> Option<Vec<u8>> {
    debug_assert_eq!(Epath::object(ClassCode::MessageRouter.0, 1).bytes().len(), PACKET_HEAD - 4);
    Some(MultipleServicePacket::new(parts)?.request().ok()?.bytes())
}

impl Read {
    /// What cannot come in one reply is read in parts from the beginning.
    pub(super) fn choose_way(&mut self, limits: &DeviceLimits) {
        if self.kind.is_some() && self.reply > limits.reply_max && self.reply > REPLY_HEAD {
            self.way = self.long_way(limits).unwrap_or(Way::Plain);
        }
    }
}
