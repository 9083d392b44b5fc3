//! From the data of an answer to the readings of all who wait for it.

use alloc::string::{String, ToString};
use alloc::vec::Vec;

use super::Poller;
use super::cycle::Job;
use super::group::{Tag, Work};
use super::plan;
use super::read::{Part, Read, Retry, Take};
use super::reading::Reason;
use crate::engine::time::Instant;
use crate::tag::{Dialect, Elementary, Form, STRUCTURE, Step, TagData, TagHead, Type, Value};

const BOOL: Type = Type::Elementary(Elementary::Bool);

impl Poller {
    /// The whole answer to a question is there.
    pub(super) fn deliver(&mut self, job: Job, data: TagData<'_>, now: Instant) {
        let dialect = self.limits.dialect;
        let Some(work) = self.work_of(job) else { return };
        let Some(read) = work.reads.get_mut(job.read) else { return };
        read.saw(&data);
        if is_counted_otherwise(read, &data, dialect) {
            work.learn_bools(job.read, data.head);
            return;
        }
        if read.is_packed() && data.head.code != Elementary::Dword.code() {
            // Its element 1 holds no BOOLs 32 to 63.
            let reason = Reason::OtherType(said(&data, dialect));
            return self.fail(job, &reason, true, now);
        }
        let learned = if read.kind.is_none() { Type::of_data(dialect, &data, read.count) } else { None };
        let kind = read.kind.as_ref().or(learned.as_ref());
        match value_of(kind, &data, dialect) {
            Ok(value) => {
                let kind = kind.cloned();
                self.share(job, value, kind.as_ref(), data.head.handle, now);
            }
            Err(reason) => self.fail(job, &reason, true, now),
        }
    }

    /// Gives everybody their part.
    fn share(&mut self, job: Job, value: Value, whole: Option<&Type>, handle: Option<u16>, now: Instant) {
        let Some(work) = self.groups.get_mut(&job.group) else { return };
        let Work { tags, reads, is_outdated, .. } = work;
        let Some(read) = reads.get_mut(job.read) else { return };
        let was_isolated = read.retry.take().is_some();
        let mut value = Some(value);
        let is_only = read.takes.len() == 1;
        for take in &read.takes {
            let Some(tag) = tags.get_mut(take.tag) else { continue };
            match part_of(&mut value, whole, take.part, tag, is_only) {
                Ok((value, kind)) => {
                    if tag.item.kind.is_none()
                        && tag.item.name.bit().is_none()
                        && tag.learned.as_ref() != kind
                    {
                        tag.learned = kind.cloned();
                        *is_outdated = true;
                    }
                    tag.reading.good(value, kind, handle.filter(|_| is_of(whole, kind)), now);
                }
                Err(reason) => {
                    tag.reading.bad(&reason);
                }
            }
            tag.announce(job.group, &mut self.changes);
        }
        if was_isolated {
            // What was wrong may have been wrong with all of them.
            *is_outdated = true;
            for retry in reads.iter_mut().filter_map(|read| read.retry.as_mut()) {
                *retry = retry.again(now);
            }
        }
    }

    /// A question has failed. `isolate`: it is about what was asked for, so those who only took a part of it are asked
    /// for by themselves now, and it is asked for again later.
    pub(super) fn fail(&mut self, job: Job, reason: &Reason, isolate: bool, now: Instant) {
        if isolate {
            self.isolate(job, now);
        }
        self.change(job, |tag| tag.reading.bad(reason));
    }

    fn isolate(&mut self, job: Job, now: Instant) {
        let dialect = self.limits.dialect;
        let Some(work) = self.work_of(job) else { return };
        let Some(read) = work.reads.get_mut(job.read) else { return };
        read.retry = Some(Retry::after(read.retry, now));
        let length = read.name.steps().len();
        let is_own = |take: &Take| match (take.part, work.tags.get(take.tag)) {
            (Part::Inside(_), Some(tag)) => tag.item.name.steps().len() == length,
            _ => true,
        };
        let (own, others): (Vec<Take>, Vec<Take>) = read.takes.iter().partition(|take| is_own(take));
        if own.is_empty() {
            return;
        }
        read.takes = own;
        let mut jobs = Vec::new();
        for take in others {
            let Some((read, part)) = work.tags.get(take.tag).and_then(|tag| plan::alone(tag, dialect)) else {
                continue;
            };
            jobs.push(Job { read: work.reads.len(), is_alone: false, ..job });
            work.reads.push(Read { takes: alloc::vec![Take { part, ..take }], ..read });
            work.open += 1;
        }
        for job in jobs.into_iter().rev() {
            self.queue.push_front(job);
        }
    }

    /// Applies a change to everybody who waits for a read; `change` says whether it was one.
    pub(super) fn change(&mut self, job: Job, mut change: impl FnMut(&mut Tag) -> bool) {
        let work = self.groups.get_mut(&job.group).filter(|work| work.edition == job.edition);
        let Some(work) = work else { return };
        let Some(read) = work.reads.get(job.read) else { return };
        for take in &read.takes {
            let Some(tag) = work.tags.get_mut(take.tag) else { continue };
            if change(tag) {
                tag.announce(job.group, &mut self.changes);
            }
        }
    }

    pub(super) fn change_read(&mut self, job: Job, change: impl FnOnce(&mut Read)) {
        if let Some(read) = self.work_of(job).and_then(|work| work.reads.get_mut(job.read)) {
            change(read);
        }
    }
}

impl Read {
    /// Whether BOOLs are taken from a DWORD of their array.
    fn is_packed(&self) -> bool {
        matches!(self.takes.as_slice(), [Take { part: Part::Packed(_), .. }, ..])
    }

    /// From now on this length is expected.
    fn saw(&mut self, data: &TagData<'_>) {
        let head = 6 + 2 * usize::from(data.head.handle.is_some());
        let length = head + data.data.len();
        self.reply = if self.is_seen { self.reply.max(length) } else { length };
        self.is_seen = true;
    }
}

impl Work {
    /// A Logix counts the elements of a BOOL array in DWORDs; others do not. Those who asked in the other way do better
    /// next time.
    fn learn_bools(&mut self, read: usize, head: TagHead) {
        let plain = head.code == Elementary::Bool.code();
        for take in self.reads.get(read).iter().flat_map(|read| &read.takes) {
            if let Some(tag) = self.tags.get_mut(take.tag) {
                tag.plain_bools = plain;
                tag.learned = Some(BOOL);
            }
        }
        self.is_outdated = true;
    }
}

/// Whether an element of a BOOL array was asked for in the way of another family.
fn is_counted_otherwise(read: &Read, data: &TagData<'_>, dialect: Dialect) -> bool {
    if dialect != Dialect::Logix {
        return false;
    }
    if read.is_packed() {
        return data.head.code == Elementary::Bool.code();
    }
    let is_element = matches!(read.name.steps().last(), Some(Step::Index(indices)) if indices.len() == 1);
    let is_open = read.kind.is_none() || read.kind == Some(BOOL);
    is_element && is_open && data.head.code == Elementary::Dword.code()
}

/// The value, if the device's type is the one that is expected.
fn value_of(kind: Option<&Type>, data: &TagData<'_>, dialect: Dialect) -> Result<Value, Reason> {
    let Some(kind) = kind else { return Ok(Value::Raw(data.data.to_vec())) };
    if !is_kind(kind, data.head, dialect) {
        return Err(Reason::OtherType(said(data, dialect)));
    }
    kind.decode(dialect, data.data).map_err(|error| Reason::Unreadable(error.to_string()))
}

/// What a reply says of its type, in words.
fn said(data: &TagData<'_>, dialect: Dialect) -> String {
    match (Type::of_data(dialect, data, 1), data.head.handle) {
        (Some(kind), _) => kind.element().to_string(),
        (None, Some(handle)) => alloc::format!("a structure with the handle {handle:#06x}"),
        (None, None) => alloc::format!("the type {:#04x}", data.head.code),
    }
}

/// Whether bytes with this head are read as this type: whole numbers of one length are each other's.
fn is_kind(kind: &Type, head: TagHead, dialect: Dialect) -> bool {
    match (kind.head(dialect), kind.element()) {
        // Strings of another length have another handle; the length of the data tells.
        (_, Type::String(_)) if dialect == Dialect::Logix => head.code == STRUCTURE,
        (None, _) => head.code == STRUCTURE,
        (Some(expected), Type::Elementary(element)) => {
            let found = Elementary::of_code(dialect, head.code).filter(|_| head.handle.is_none());
            expected == head || found.is_some_and(|found| are_alike(*element, found, dialect))
        }
        (Some(expected), _) => expected == head,
    }
}

fn are_alike(one: Elementary, other: Elementary, dialect: Dialect) -> bool {
    let whole = |kind: Elementary| matches!(kind.form(), Form::Signed | Form::Unsigned | Form::Bits);
    one == other || (whole(one) && whole(other) && one.size(dialect) == other.size(dialect))
}

/// The part of a value that a tag takes, and its type.
fn part_of<'a>(
    value: &mut Option<Value>,
    kind: Option<&'a Type>,
    part: Part,
    tag: &Tag,
    is_only: bool,
) -> Result<(Value, Option<&'a Type>), Reason> {
    const BIT: &Type = &BOOL;
    let missing = || Reason::Unreadable("the value has no such part".to_string());
    let whole = value.as_ref().ok_or_else(missing)?;
    let bit =
        |value: &Value, bit: u8| value.bit(bit).map(|bit| (Value::Bool(bit), Some(BIT))).ok_or_else(missing);
    match part {
        Part::Packed(place) => bit(whole, place),
        Part::Element(index) => match (whole, kind) {
            (Value::List(elements), Some(kind)) => {
                let element = elements.get(index).cloned().ok_or_else(missing)?;
                Ok((element, Some(kind.element())))
            }
            // A run of one.
            _ => Ok((whole.clone(), kind)),
        },
        Part::Inside(skip) => {
            let steps = tag.item.name.steps().get(skip..).unwrap_or_default();
            if steps.is_empty() && tag.item.name.bit().is_none() {
                let whole = if is_only { value.take() } else { value.clone() };
                return Ok((whole.ok_or_else(missing)?, kind));
            }
            let (inner, its) = match kind {
                Some(kind) => (whole.step(kind, steps).ok_or_else(missing)?, kind.step(steps)),
                None => (whole, None),
            };
            if let Some(place) = tag.item.name.bit() {
                return bit(inner, place);
            }
            match (&tag.item.kind, its) {
                (Some(given), Some(its)) if !agree(given, its) => Err(Reason::OtherType(its.to_string())),
                _ => Ok((inner.clone(), its)),
            }
        }
    }
}

/// Whether the handle of a whole is that of a part: it is the whole, or an element of it.
fn is_of(whole: Option<&Type>, part: Option<&Type>) -> bool {
    let same = |whole: &Type, part: &Type| core::ptr::eq(whole, part) || core::ptr::eq(whole.element(), part);
    whole.zip(part).is_some_and(|(whole, part)| same(whole, part))
}

/// Whether what was given for a member is what its whole says: lengths of texts and names of structures aside.
fn agree(given: &Type, its: &Type) -> bool {
    match (given, its) {
        (Type::String(_), Type::String(_)) | (Type::Structure(_), Type::Structure(_)) => true,
        (given, its) => given == its,
    }
}
