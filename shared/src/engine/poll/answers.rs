//! From replies to readings, and to what was learned.

use alloc::string::{String, ToString};
use alloc::vec::Vec;

use super::assembly::{Assembly, Progress};
use super::cycle::{Flight, Job};
use super::read::{Read, Way};
use super::reading::Reason;
use super::{Failure, Poller};
use crate::engine::time::Instant;
use crate::tag::{Dialect, TagData, refusal};
use crate::wire::{GeneralStatus, MessageRouterReply, MultipleServiceReply};

/// Of what was learned to be too much, so much is tried next: three quarters.
const LESS: (usize, usize) = (3, 4);

/// What became of one question.
#[derive(Clone, Copy, Debug)]
enum Outcome {
    /// It is answered, or has failed for good.
    Done,
    /// It is asked in another way.
    Again(Job),
    /// The long value goes on with its next part.
    GoesOn,
    /// It did not fit beside the others.
    TooLarge(Job),
}

impl Poller {
    /// What came of the outstanding request: a message router reply, also a refusal, or why there is none. Without an
    /// outstanding request nothing happens.
    pub fn handle_reply(&mut self, now: Instant, reply: Result<&[u8], Failure>) {
        let Some(flight) = self.flight.take() else { return };
        match reply.map(MessageRouterReply::decode) {
            Ok(Ok(reply)) if reply.service == flight.service => {
                let words: Vec<u16> = reply.additional.words().collect();
                self.answered(&flight, (reply.status, &words), reply.data, now);
            }
            Ok(Ok(reply)) if reply.status != GeneralStatus::Success => {
                // Somebody on the way.
                self.lost(refusal(reply.status, reply.additional.words().next()), &flight, now);
            }
            Ok(Ok(reply)) => {
                self.lost(alloc::format!("the answer is to service {}", reply.service), &flight, now);
            }
            Ok(Err(error)) => self.malformed(&flight, &error.to_string(), now),
            Err(Failure::Refused { status, words }) => self.answered(&flight, (status, &words), &[], now),
            Err(Failure::Lost { reason }) => self.lost(reason, &flight, now),
            Err(Failure::NotTaken { reason }) => self.malformed(&flight, &reason, now),
        }
        self.end_cycle(now);
    }

    fn answered(&mut self, flight: &Flight, status: (GeneralStatus, &[u16]), data: &[u8], now: Instant) {
        if !flight.is_packet {
            if let Some(job) = flight.jobs.first() {
                let outcome = self.answer(*job, status, data, false, now);
                self.carry_on(outcome, *job, now);
            }
            return;
        }
        match status.0 {
            GeneralStatus::Success | GeneralStatus::EmbeddedServiceError => {
                match MultipleServiceReply::decode(data) {
                    Ok(reply) => self.parts(flight, reply.parts(), now),
                    Err(_) => self.pack_no_more(flight),
                }
            }
            status if is_size(status) => self.cut(flight, status),
            _ if is_passing(status.0, status.1) => {
                let reason = refused(status);
                for job in &flight.jobs {
                    self.fail(*job, &reason, false, now);
                    self.done(*job, now);
                }
            }
            _ => self.pack_no_more(flight),
        }
    }

    /// The parts of a packet's reply.
    fn parts(&mut self, flight: &Flight, parts: &[&[u8]], now: Instant) {
        let mut too_large = Vec::new();
        let mut answered = 0;
        for (job, part) in flight.jobs.iter().zip(parts) {
            let outcome = match MessageRouterReply::decode(part) {
                Ok(reply) => {
                    let words: Vec<u16> = reply.additional.words().collect();
                    self.answer(*job, (reply.status, &words), reply.data, true, now)
                }
                Err(error) => {
                    self.fail(*job, &Reason::Unreadable(error.to_string()), true, now);
                    Outcome::Done
                }
            };
            match outcome {
                Outcome::TooLarge(job) => too_large.push(job),
                other => {
                    answered += 1;
                    self.carry_on(other, *job, now);
                }
            }
        }
        let missing = flight.jobs.get(parts.len().min(flight.jobs.len())..).unwrap_or_default();
        if answered == 0 {
            return if too_large.is_empty() {
                self.pack_no_more(flight);
            } else {
                self.cut(flight, GeneralStatus::ReplyDataTooLarge);
            };
        }
        if !too_large.is_empty() {
            self.learn_size(flight, GeneralStatus::ReplyDataTooLarge);
        }
        // There are fewer of them than before.
        let batch = self.next_batch();
        for job in too_large.iter().chain(missing).rev() {
            self.queue.push_front(Job { batch, ..*job });
        }
    }

    /// A packet is too large: two of half the size.
    fn cut(&mut self, flight: &Flight, status: GeneralStatus) {
        self.learn_size(flight, status);
        let (first, second) = flight.jobs.split_at(flight.jobs.len() / 2);
        for half in [second, first] {
            let batch = self.next_batch();
            for job in half.iter().rev() {
                self.queue.push_front(Job { batch, ..*job });
            }
        }
    }

    /// What is known to be too much is not sent again. As long as lengths are not known, they are to be blamed.
    fn learn_size(&mut self, flight: &Flight, status: GeneralStatus) {
        let (reply, seen) = self.expected_reply(&flight.jobs);
        if status == GeneralStatus::TooMuchData {
            self.request_max = self.request_max.min(flight.length * LESS.0 / LESS.1);
        } else if seen {
            self.reply_max = self.reply_max.min(reply * LESS.0 / LESS.1);
        }
    }

    /// The device does not understand packets.
    fn pack_no_more(&mut self, flight: &Flight) {
        self.packs = false;
        for job in flight.jobs.iter().rev() {
            self.queue.push_front(*job);
        }
    }

    fn malformed(&mut self, flight: &Flight, error: &str, now: Instant) {
        if flight.is_packet {
            return self.pack_no_more(flight);
        }
        for job in &flight.jobs {
            self.fail(*job, &Reason::Unreadable(error.to_string()), true, now);
            self.done(*job, now);
        }
    }

    /// No answer: the rest of the cycle would fare no better.
    fn lost(&mut self, reason: String, flight: &Flight, now: Instant) {
        let reason = Reason::Lost(reason);
        self.assembly = None;
        let jobs: Vec<Job> = flight.jobs.iter().chain(&self.queue).copied().collect();
        self.queue.clear();
        for job in jobs {
            self.change(job, |tag| tag.reading.lost(&reason));
            self.done(job, now);
        }
    }

    /// One answer, of a request or of a part of one.
    fn answer(
        &mut self,
        job: Job,
        status: (GeneralStatus, &[u16]),
        data: &[u8],
        in_packet: bool,
        now: Instant,
    ) -> Outcome {
        let dialect = self.limits.dialect;
        let Some(read) = self.read_of(job) else { return Outcome::Done };
        let carries = status.0 == GeneralStatus::Success
            || (status.0 == GeneralStatus::PartialTransfer && !in_packet && dialect == Dialect::Logix);
        if !carries {
            return self.refused(job, status, in_packet, now);
        }
        let is_last = status.0 == GeneralStatus::Success;
        let part = match TagData::decode(data) {
            Ok(part) => part,
            Err(error) => {
                self.assembly = None;
                self.fail(job, &Reason::Unreadable(error.to_string()), true, now);
                return Outcome::Done;
            }
        };
        if self.assembly.is_none() && is_last {
            self.deliver(job, part, now);
            return Outcome::Done;
        }
        let mut read = read.clone();
        let mut assembly = self.assembly.take().unwrap_or_else(|| Assembly::new(job));
        if read.way == Way::Plain {
            // The beginning has come already.
            read.way = Way::Fragments;
            self.change_read(job, |read| read.way = Way::Fragments);
        }
        let progress = assembly.add(&read, &part, is_last, dialect);
        self.progress(assembly, &read, progress, now)
    }

    fn progress(&mut self, assembly: Assembly, read: &Read, progress: Progress, now: Instant) -> Outcome {
        let job = assembly.job();
        match progress {
            Progress::More => {
                self.assembly = Some(assembly);
                return Outcome::GoesOn;
            }
            Progress::Done => {
                if let Some((head, data)) = assembly.finish(read) {
                    self.deliver(job, TagData { head, data: &data }, now);
                }
            }
            Progress::Stuck => self.fail(job, &Reason::ValueTooLong, true, now),
        }
        Outcome::Done
    }

    /// The device has refused it.
    fn refused(
        &mut self,
        job: Job,
        status: (GeneralStatus, &[u16]),
        in_packet: bool,
        now: Instant,
    ) -> Outcome {
        let Some(read) = self.read_of(job).cloned() else { return Outcome::Done };
        // Too much data in a question that is alone is about the question.
        let is_size = is_size(status.0) && (in_packet || status.0 != GeneralStatus::TooMuchData);
        if in_packet && is_size {
            return Outcome::TooLarge(job);
        }
        let assembly = self.assembly.take();
        if is_size {
            if read.is_run() {
                return self.halve(job);
            }
            let way = if read.way == Way::Plain { read.long_way(&self.limits) } else { read.smaller_way() };
            let Some(way) = way else {
                self.fail(job, &Reason::ValueTooLong, true, now);
                return Outcome::Done;
            };
            self.change_read(job, |read| read.way = way);
            return self.again(job, assembly);
        }
        if is_passing(status.0, status.1) {
            self.fail(job, &refused(status), false, now);
            return Outcome::Done;
        }
        if read.way == Way::Fragments
            && status.0 == GeneralStatus::ServiceNotSupported
            && let Some(way) = read.ranges(&self.limits)
        {
            self.change_read(job, |read| read.way = way);
            return Outcome::Again(job);
        }
        if let Some(mut assembly) = assembly {
            let progress = assembly.shorten(&read);
            if progress != Progress::Stuck {
                return self.progress(assembly, &read, progress, now);
            }
        }
        if read.is_run() {
            return self.halve(job);
        }
        self.fail(job, &refused(status), true, now);
        Outcome::Done
    }

    /// With shorter parts; what is there stays.
    fn again(&mut self, job: Job, assembly: Option<Assembly>) -> Outcome {
        match assembly {
            Some(assembly) => {
                self.assembly = Some(assembly);
                Outcome::GoesOn
            }
            None => Outcome::Again(job),
        }
    }

    /// Neighbouring elements of which one at least is the matter.
    fn halve(&mut self, job: Job) -> Outcome {
        let dialect = self.limits.dialect;
        let Some(work) = self.work_of(job) else { return Outcome::Done };
        let (tags, read) = (&work.tags, work.reads.get_mut(job.read));
        let name = |place: usize| tags.get(place).map(|tag| tag.item.name.without_bit());
        let Some(second) = read.and_then(|read| read.halve(name, dialect)) else { return Outcome::Done };
        let other = Job { read: work.reads.len(), ..job };
        work.reads.push(second);
        work.open += 1;
        self.queue.push_front(other);
        Outcome::Again(job)
    }

    fn carry_on(&mut self, outcome: Outcome, job: Job, now: Instant) {
        match outcome {
            Outcome::Again(job) | Outcome::TooLarge(job) => self.queue.push_front(job),
            Outcome::GoesOn => {}
            Outcome::Done => self.done(job, now),
        }
    }

    /// A question is answered; the last one ends the cycle of its group.
    pub(super) fn done(&mut self, job: Job, now: Instant) {
        if let Some(work) = self.work_of(job) {
            work.open = work.open.saturating_sub(1);
            if work.open == 0 {
                work.end(now);
            }
        }
    }
}

fn refused((status, words): (GeneralStatus, &[u16])) -> Reason {
    Reason::Refused { status, words: words.to_vec() }
}

/// A refusal because of the length of the request or of the reply. A Logix says 0x06 for a part of a packet.
const fn is_size(status: GeneralStatus) -> bool {
    matches!(
        status,
        GeneralStatus::ReplyDataTooLarge | GeneralStatus::TooMuchData | GeneralStatus::PartialTransfer
    )
}

/// The state of the device or of the way to it, whatever was asked for: the next period may do better. 0x0C with 0x8010
/// is an Omron that starts or is being downloaded to (W506 8-6).
fn is_passing(status: GeneralStatus, words: &[u16]) -> bool {
    /// Resource unavailable; connection lost; device state conflict. Source: data/general_status.tsv.
    const BUSY: [GeneralStatus; 3] = [GeneralStatus(0x02), GeneralStatus(0x07), GeneralStatus(0x10)];
    BUSY.contains(&status)
        || status == GeneralStatus::ConnectionFailure
        || (status == GeneralStatus::ObjectStateConflict && words.first() == Some(&0x8010))
}
