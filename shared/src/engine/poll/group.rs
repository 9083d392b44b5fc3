//! A group: variables that are read together, on a fixed grid of time.

use alloc::collections::{BTreeMap, VecDeque};
use alloc::vec::Vec;

use crate::engine::time::{Instant, Millis};
use crate::tag::{TagName, Type};

use super::limits::DeviceLimits;
use super::plan;
use super::read::{Read, Retry, Way};
use super::reading::{Quality, Reading, Reason};

/// A variable to read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Item {
    /// Unlike that of every other item of the device.
    pub id: u32,
    /// The whole name, or with a bit behind it.
    pub name: TagName,
    /// Its type; `None` = as the device says. With a bit in the name it is not needed.
    pub kind: Option<Type>,
}

/// Variables that are read together.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Group {
    /// Unlike that of every other group of the device.
    pub id: u32,
    /// From start to start; 0 counts as 1 ms.
    pub period: Millis,
    /// Whether it is read at all.
    pub on: bool,
    /// What is read.
    pub items: Vec<Item>,
}

/// An item and what is known of it.
#[derive(Debug)]
pub(super) struct Tag {
    pub(super) item: Item,
    /// The type that the device has said.
    pub(super) learned: Option<Type>,
    /// The device keeps BOOLs of an array one by one, unlike a Logix.
    pub(super) plain_bools: bool,
    pub(super) reading: Reading,
    /// Whether it waits in the queue of changes.
    pub(super) is_queued: bool,
}

impl Tag {
    fn new(item: Item) -> Self {
        Self { item, learned: None, plain_bools: false, reading: Reading::default(), is_queued: false }
    }

    /// Puts it into the queue of changes, once.
    pub(super) fn announce(&mut self, group: u32, changes: &mut VecDeque<(u32, u32)>) {
        if !core::mem::replace(&mut self.is_queued, true) {
            changes.push_back((group, self.item.id));
        }
    }

    /// As given, else as learned.
    pub(super) fn kind(&self) -> Option<&Type> {
        self.item.kind.as_ref().or(self.learned.as_ref())
    }
}

/// A group at work.
#[derive(Debug)]
pub(super) struct Work {
    /// µs
    period: u64,
    pub(super) on: bool,
    pub(super) tags: Vec<Tag>,
    pub(super) reads: Vec<Read>,
    /// Tells reads from those of an earlier plan with the same place.
    pub(super) edition: u64,
    /// Something was learned by which fewer requests would do.
    pub(super) is_outdated: bool,
    /// Reads of the present cycle that are not done.
    pub(super) open: usize,
    next: Option<Instant>,
    begun: Instant,
    cycle_us: u64,
    stale_at: Option<Instant>,
}

impl Work {
    /// The same group as before keeps its values and its place on the grid.
    pub(super) fn new(group: Group, before: Option<Self>, origin: Instant, now: Instant) -> Self {
        let period = group.period.0.max(1).saturating_mul(1_000);
        let mut old = Vec::new();
        let mut work = Self {
            period,
            on: group.on,
            tags: Vec::new(),
            reads: Vec::new(),
            edition: 0,
            is_outdated: true,
            open: 0,
            next: group.on.then_some(now),
            begun: now,
            cycle_us: 0,
            stale_at: None,
        };
        if let Some(before) = before {
            if before.period == period && before.on && before.next.is_some_and(|next| next > now) {
                let grown = group.items.iter().any(|item| before.tags.iter().all(|tag| tag.item != *item));
                // What is new is read at once.
                work.next = if grown { work.next } else { before.next.filter(|_| group.on) };
            }
            work.cycle_us = before.cycle_us;
            old = before.tags;
        }
        old.sort_by_key(|tag| tag.item.id);
        for item in group.items {
            let same = old.binary_search_by_key(&item.id, |tag| tag.item.id).ok();
            let same = same.and_then(|place| old.get_mut(place)).filter(|tag| tag.item == item);
            work.tags.push(same.map_or_else(
                || Tag::new(item.clone()),
                |tag| core::mem::replace(tag, Tag::new(item.clone())),
            ));
        }
        work.align(origin, now);
        work
    }

    /// All groups with the same period are due together, so that they share requests.
    fn align(&mut self, origin: Instant, now: Instant) {
        if let Some(next) = self.next.filter(|next| *next > now) {
            let steps = next.micros_since(origin).div_ceil(self.period);
            self.next = Some(Instant(origin.0.saturating_add(steps.saturating_mul(self.period))));
        }
    }

    /// Whether a period begins: how late it is, µs, and how many were left out.
    pub(super) fn take_due(&mut self, origin: Instant, now: Instant) -> Option<Due> {
        let due = self.next.filter(|next| *next <= now)?;
        let late_us = now.micros_since(due);
        let steps = now.micros_since(origin) / self.period + 1;
        self.next = Some(Instant(origin.0.saturating_add(steps.saturating_mul(self.period))));
        let missed = late_us / self.period;
        if self.open > 0 {
            return Some(Due { late_us, skipped: missed + 1, begins: false });
        }
        self.begun = now;
        Some(Due { late_us, skipped: missed, begins: true })
    }

    pub(super) const fn next(&self) -> Option<Instant> {
        self.next
    }

    pub(super) const fn stale_at(&self) -> Option<Instant> {
        self.stale_at
    }

    /// The cycle is done.
    pub(super) fn end(&mut self, now: Instant) {
        self.open = 0;
        self.cycle_us = now.micros_since(self.begun);
        self.watch();
    }

    /// Values that missed two periods are stale.
    pub(super) fn mark_stale(&mut self, id: u32, now: Instant, changes: &mut VecDeque<(u32, u32)>) {
        if self.stale_at.is_none_or(|at| at > now) {
            return;
        }
        let patience = self.patience();
        for tag in &mut self.tags {
            let old = tag.reading.at.is_none_or(|at| now.micros_since(at) >= patience);
            if tag.reading.quality == Quality::Good && old {
                tag.reading.lost(&Reason::Late);
                tag.announce(id, changes);
            }
        }
        self.watch();
    }

    /// Nothing is stale before this.
    fn watch(&mut self) {
        let patience = self.patience();
        let good = self.tags.iter().filter(|tag| tag.reading.quality == Quality::Good);
        let oldest = good.filter_map(|tag| tag.reading.at).min();
        self.stale_at = oldest.filter(|_| self.on).map(|at| Instant(at.0.saturating_add(patience)));
    }

    /// The age at which a value has missed two periods, µs. A group that cannot keep its period is measured by what
    /// it does keep.
    fn patience(&self) -> u64 {
        self.period.max(self.cycle_us).saturating_mul(3)
    }

    /// Plans the reads anew. What is isolated stays so, and what was learned of a read is kept.
    pub(super) fn plan(
        &mut self,
        id: u32,
        edition: u64,
        limits: &DeviceLimits,
        changes: &mut VecDeque<(u32, u32)>,
    ) {
        let plan = plan::make(&self.tags, &self.retries(), limits);
        let before = core::mem::replace(&mut self.reads, plan.reads);
        let before: BTreeMap<_, _> = before.iter().map(|read| ((&read.name, read.count), read)).collect();
        for read in &mut self.reads {
            let Some(before) = before.get(&(&read.name, read.count)).filter(|before| before.is_seen) else {
                read.choose_way(limits);
                continue;
            };
            (read.reply, read.is_seen) = (before.reply, true);
            if before.kind == read.kind {
                read.way = before.way;
            } else if before.way != Way::Plain {
                read.choose_way(limits);
            }
        }
        for place in plan.too_long {
            let tag = self.tags.get_mut(place);
            if let Some(tag) = tag
                && tag.reading.bad(&Reason::NameTooLong)
            {
                tag.announce(id, changes);
            }
        }
        self.edition = edition;
        self.is_outdated = false;
    }

    /// For each tag, whether it is isolated.
    fn retries(&self) -> Vec<Option<Retry>> {
        let mut retries = alloc::vec![None; self.tags.len()];
        for read in &self.reads {
            for take in &read.takes {
                if let Some(retry) = retries.get_mut(take.tag) {
                    *retry = read.retry;
                }
            }
        }
        retries
    }
}

/// A period that begins, or cannot.
#[derive(Debug)]
pub(super) struct Due {
    pub(super) late_us: u64,
    pub(super) skipped: u64,
    /// Whether the reads are to be asked for: not while those of the last period are.
    pub(super) begins: bool,
}
