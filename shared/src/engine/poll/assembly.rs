//! A value that is longer than a reply, put together from several.
//!
//! Logix: Read Tag Fragmented, status 0x06 as long as more follows (pycomm3). Omron: simple data segments; each part of a
//! STRING has its own count before it (aphyt n_series.py). Micro800: elements of the array from one index to another;
//! no other way is known.

use alloc::vec::Vec;

use super::cycle::Job;
use super::limits::DeviceLimits;
use super::read::{REPLY_HEAD, Read, Way, expected};
use crate::tag::{Dialect, Elementary, TagData, TagHead, Type, request};
use crate::wire::{MessageRouterRequest, SimpleDataSegment};

/// Our own limit: nothing that is polled is longer.
const MAX_LENGTH: usize = 1 << 20;

/// Bytes before a part of a STRING.
const PART_COUNT: usize = 2;

/// What is there of a long value.
#[derive(Debug)]
pub(super) struct Assembly {
    job: Job,
    head: Option<TagHead>,
    data: Vec<u8>,
    /// How many elements are there, for ranges.
    elements: usize,
    /// The last part was refused, so the next ones are shorter: the end is near.
    tail: Option<u16>,
}

/// Whether a value is complete.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Progress {
    More,
    Done,
    /// The answer brings nothing new.
    Stuck,
}

impl Assembly {
    pub(super) const fn new(job: Job) -> Self {
        Self { job, head: None, data: Vec::new(), elements: 0, tail: None }
    }

    pub(super) const fn job(&self) -> Job {
        self.job
    }

    /// The question for what comes next.
    pub(super) fn request(&self, read: &Read, dialect: Dialect) -> Option<MessageRouterRequest> {
        let offset = u32::try_from(self.data.len()).ok()?;
        match read.way {
            Way::Plain => request::read(read.name.path(), read.count),
            Way::Fragments => request::read_fragment(read.name.path(), read.count, offset),
            Way::Parts { chunk, total } => {
                let left = total.map_or(usize::MAX, |total| total.saturating_sub(self.data.len()));
                let size = u16::try_from(left).unwrap_or(u16::MAX).min(self.tail.unwrap_or(chunk));
                request::read_part(read.name.path(), SimpleDataSegment { offset, size })
            }
            Way::Ranges { elements } => {
                let (indices, left) = place(read.kind.as_ref()?, self.elements, dialect)?;
                let count = u16::try_from(left).unwrap_or(u16::MAX).min(elements);
                request::read(read.name.element(indices).path(), count)
            }
        }
        .ok()
    }

    /// A part has come. `is_last`: the device says that nothing follows.
    pub(super) fn add(
        &mut self,
        read: &Read,
        part: &TagData<'_>,
        is_last: bool,
        dialect: Dialect,
    ) -> Progress {
        let is_text = matches!(read.kind, Some(Type::String(_))) || part.head.code == OMRON_STRING;
        let is_counted = is_text && matches!(read.way, Way::Parts { .. });
        let bytes = if is_counted { part.data.get(PART_COUNT..).unwrap_or_default() } else { part.data };
        let is_other = self.head.is_some_and(|head| head != part.head);
        let length = self.data.len() + bytes.len();
        if is_other || length > MAX_LENGTH || (bytes.is_empty() && !is_last) {
            let is_end =
                matches!(read.way, Way::Parts { total: None, .. }) && !is_other && length <= MAX_LENGTH;
            return if is_end && self.head.is_some() { Progress::Done } else { Progress::Stuck };
        }
        self.head = Some(part.head);
        self.data.extend_from_slice(bytes);
        let done = match read.way {
            Way::Plain => true,
            Way::Fragments => is_last,
            Way::Parts { total: Some(total), .. } => length >= total,
            Way::Parts { chunk, total: None } => bytes.len() < usize::from(self.tail.unwrap_or(chunk)),
            Way::Ranges { .. } => {
                let size = read.kind.as_ref().map_or(0, |kind| kind.element().size(dialect));
                self.elements += bytes.len().checked_div(size).unwrap_or(0);
                let all = read.kind.as_ref().map_or(0, |kind| kind.elements(dialect));
                if self.elements == 0 {
                    return Progress::Stuck;
                }
                self.elements >= all
            }
        };
        if done { Progress::Done } else { Progress::More }
    }

    /// The device refused the last part: perhaps it goes beyond the end, which nobody has told us.
    pub(super) fn shorten(&mut self, read: &Read) -> Progress {
        match read.way {
            Way::Parts { chunk, total: None } if !self.data.is_empty() => {
                let next = self.tail.unwrap_or(chunk) / 2;
                self.tail = Some(next);
                if next == 0 { Progress::Done } else { Progress::More }
            }
            _ => Progress::Stuck,
        }
    }

    /// The value as one reply would have carried it.
    pub(super) fn finish(self, read: &Read) -> Option<(TagHead, Vec<u8>)> {
        let head = self.head?;
        let mut data = self.data;
        if head.code == OMRON_STRING && matches!(read.way, Way::Parts { .. }) {
            let count = u16::try_from(data.len()).unwrap_or(u16::MAX);
            data.splice(0..0, count.to_le_bytes());
        }
        Some((head, data))
    }
}

/// Code of Omron's STRING.
const OMRON_STRING: u8 = 0xD0;

/// The indices of an element, and how many follow in its row, itself included.
fn place(kind: &Type, element: usize, dialect: Dialect) -> Option<(Vec<u32>, usize)> {
    let Type::Array(_, dimensions) = kind else { return None };
    let all = kind.elements(dialect);
    let mut rest = element;
    let mut indices = Vec::new();
    for dimension in dimensions.each().iter().rev() {
        let length = usize::try_from(dimension.length).ok()?;
        indices.push(dimension.first + u32::try_from(rest % length).ok()?);
        rest /= length;
    }
    indices.reverse();
    let row = dimensions.each().last().and_then(|last| usize::try_from(last.length).ok())?;
    Some((indices, (row - element % row).min(all.saturating_sub(element))))
}

impl Read {
    /// How this is read when it is longer than a reply; `None` = no way is known.
    pub(super) fn long_way(&self, limits: &DeviceLimits) -> Option<Way> {
        let room = limits.reply_max.saturating_sub(REPLY_HEAD);
        match limits.dialect {
            Dialect::Logix => Some(Way::Fragments),
            Dialect::Omron => {
                // How long a STRING is at the moment only the device knows.
                let kind = self.kind.as_ref().filter(|kind| !matches!(kind, Type::String(_)));
                let total = kind.map(|kind| kind.size(limits.dialect));
                let chunk = u16::try_from(room.saturating_sub(PART_COUNT)).unwrap_or(u16::MAX);
                (chunk > 0).then_some(Way::Parts { chunk, total })
            }
            Dialect::Micro800 => self.ranges(limits),
        }
    }

    /// Elements from one index to another.
    pub(super) fn ranges(&self, limits: &DeviceLimits) -> Option<Way> {
        let kind = self.kind.as_ref().filter(|kind| matches!(kind, Type::Array(..)))?;
        if *kind.element() == Type::Elementary(Elementary::Bool) && limits.dialect == Dialect::Logix {
            return None;
        }
        let size = expected(kind.element(), limits.dialect).max(1);
        let elements = limits.reply_max.saturating_sub(REPLY_HEAD) / size;
        (elements > 0).then(|| Way::Ranges { elements: u16::try_from(elements).unwrap_or(u16::MAX) })
    }

    /// Shorter parts, after the device has said that they are too long.
    pub(super) fn smaller_way(&self) -> Option<Way> {
        match self.way {
            Way::Parts { chunk, total } if chunk > 2 => Some(Way::Parts { chunk: chunk / 2, total }),
            Way::Ranges { elements } if elements > 1 => Some(Way::Ranges { elements: elements / 2 }),
            _ => None,
        }
    }
}
