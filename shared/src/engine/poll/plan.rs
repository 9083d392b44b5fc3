//! Variables → the fewest questions that answer for all of them.
//!
//! In this order: what lies inside of a structure or an array that is read as a whole is taken from there; what is at
//! the same place (bits of one word) is asked for once; neighbouring elements are asked for together. Packing questions
//! into requests comes later, with those of other groups.

use alloc::collections::BTreeMap;
use alloc::vec::Vec;

use crate::tag::{Dialect, Elementary, Step, TagName, Type};

use super::group::Tag;
use super::limits::DeviceLimits;
use super::read::{Part, REPLY_HEAD, Read, Retry, Take};

/// What to ask, and which tags cannot be asked for.
#[derive(Debug)]
pub(super) struct Plan {
    pub(super) reads: Vec<Read>,
    /// Their names do not fit into a request.
    pub(super) too_long: Vec<usize>,
}

/// Plans a group. What is isolated is asked for by itself.
pub(super) fn make(tags: &[Tag], retries: &[Option<Retry>], limits: &DeviceLimits) -> Plan {
    let wholes = wholes(tags, retries);
    let mut plan = Plan { reads: Vec::new(), too_long: Vec::new() };
    // Where the reads of a name are.
    let mut places: BTreeMap<TagName, Vec<usize>> = BTreeMap::new();
    let mut parts = Vec::new();
    for (place, (tag, retry)) in tags.iter().zip(retries).enumerate() {
        match inside(&wholes, tags, (place, tag)) {
            Some(part) => parts.push(part),
            None => plan.add(&mut places, (place, tag), *retry, limits),
        }
    }
    let mut read_of = alloc::vec![None; tags.len()];
    for (read, take) in
        plan.reads.iter().enumerate().flat_map(|(read, its)| its.takes.iter().map(move |it| (read, it)))
    {
        if let Some(place) = read_of.get_mut(take.tag) {
            *place = Some(read);
        }
    }
    for (whole, take) in parts {
        let read = read_of.get(whole).copied().flatten().and_then(|read| plan.reads.get_mut(read));
        match read {
            Some(read) => read.takes.push(take),
            // Its name is longer than the one that is too long.
            None => plan.too_long.push(take.tag),
        }
    }
    plan.reads = join(core::mem::take(&mut plan.reads), tags, limits);
    plan
}

/// A question for one tag alone.
pub(super) fn alone(tag: &Tag, dialect: Dialect) -> Option<(Read, Part)> {
    let (name, part) = target(tag, dialect);
    let kind = match part {
        Part::Packed(_) => Some(Type::Elementary(Elementary::Dword)),
        // A bit's own type is BOOL, whatever it is a bit of.
        _ if tag.item.name.bit().is_some() => None,
        _ => tag.kind().cloned(),
    };
    let elements = kind.as_ref().map_or(1, |kind| elements(kind, dialect));
    Some((Read::new(name, u16::try_from(elements).ok()?, kind, dialect)?, part))
}

/// How many elements a question for the whole names. An Omron gives the whole array where no element is named.
fn elements(kind: &Type, dialect: Dialect) -> usize {
    if dialect == Dialect::Omron { 1 } else { kind.elements(dialect) }
}

/// Variables that are read as a whole, by their steps.
fn wholes<'a>(tags: &'a [Tag], retries: &[Option<Retry>]) -> BTreeMap<&'a [Step], usize> {
    let is_whole = |tag: &Tag| {
        tag.item.name.bit().is_none() && matches!(tag.kind(), Some(Type::Array(..) | Type::Structure(_)))
    };
    let tags = tags.iter().zip(retries).enumerate();
    let tags = tags.filter(|(_, (tag, retry))| is_whole(tag) && retry.is_none());
    tags.map(|(place, (tag, _))| (tag.item.name.steps(), place)).collect()
}

/// Where a tag lies inside of another one that is read as a whole: the outermost.
fn inside(
    wholes: &BTreeMap<&[Step], usize>,
    tags: &[Tag],
    (place, tag): (usize, &Tag),
) -> Option<(usize, Take)> {
    let steps = tag.item.name.steps();
    (1..=steps.len()).find_map(|length| {
        let (outer, inner) = steps.split_at_checked(length)?;
        let whole = *wholes.get(outer)?;
        if whole == place || inner.is_empty() {
            return None;
        }
        tags.get(whole)?.kind()?.step(inner)?;
        Some((whole, Take { tag: place, part: Part::Inside(length) }))
    })
}

/// What is asked for to get a tag. A Logix keeps the BOOLs of an array in DWORDs and counts those (pycomm3, pylogix).
fn target(tag: &Tag, dialect: Dialect) -> (TagName, Part) {
    let name = tag.item.name.without_bit();
    let length = name.steps().len();
    let is_bool = tag.kind() == Some(&Type::Elementary(Elementary::Bool)) && tag.item.name.bit().is_none();
    if dialect == Dialect::Logix
        && is_bool
        && !tag.plain_bools
        && let Some(Step::Index(indices)) = name.steps().last()
        && let [index] = **indices
        && let Ok(bit) = u8::try_from(index % 32)
        && let Some(array) = name.parent()
    {
        return (array.element(alloc::vec![index / 32]), Part::Packed(bit));
    }
    (name, Part::Inside(length))
}

impl Plan {
    fn add(
        &mut self,
        places: &mut BTreeMap<TagName, Vec<usize>>,
        (place, tag): (usize, &Tag),
        retry: Option<Retry>,
        limits: &DeviceLimits,
    ) {
        let fits = |read: &Read| read.request.len() <= limits.request_max;
        let Some((read, part)) = alone(tag, limits.dialect).filter(|(read, _)| fits(read)) else {
            self.too_long.push(place);
            return;
        };
        let take = Take { tag: place, part };
        let same = places.entry(read.name.clone()).or_default();
        for other in same.iter() {
            let Some(other) = self.reads.get_mut(*other) else { continue };
            let packed = |part| matches!(part, Part::Packed(_));
            let alike = other.takes.iter().all(|other| packed(other.part) == packed(part));
            let agrees = other.kind == read.kind || other.kind.is_none() || read.kind.is_none();
            if alike && agrees && other.retry.is_some() == retry.is_some() {
                if other.kind.is_none() && read.kind.is_some() {
                    *other = Read { takes: core::mem::take(&mut other.takes), retry: other.retry, ..read };
                }
                other.takes.push(take);
                return;
            }
        }
        same.push(self.reads.len());
        self.reads.push(Read { takes: alloc::vec![take], retry, ..read });
    }
}

/// Neighbouring elements become one question.
fn join(reads: Vec<Read>, tags: &[Tag], limits: &DeviceLimits) -> Vec<Read> {
    let (mut elements, mut reads): (Vec<Read>, Vec<Read>) =
        reads.into_iter().partition(|read| element_of(read, tags).is_some());
    elements.sort_by(|one, other| one.name.cmp(&other.name));
    let mut elements = elements.into_iter().peekable();
    while let Some(first) = elements.next() {
        let mut run = alloc::vec![first];
        while let (Some(last), Some(next)) = (run.last(), elements.peek())
            && follows(last, next)
            && fits(next, run.len() + 1, limits)
        {
            run.extend(elements.next());
        }
        reads.extend(joined(run, limits.dialect));
    }
    reads
}

/// The type of an element that others may lie beside: numbers and structures of which the bytes are the same alone and
/// among others.
fn element_of<'a>(read: &'a Read, tags: &[Tag]) -> Option<&'a Type> {
    let kind = read.kind.as_ref()?;
    let has_neighbours = match kind {
        Type::Elementary(elementary) => *elementary != Elementary::Bool,
        Type::Structure(_) => true,
        Type::String(_) | Type::Array(..) => false,
    };
    let is_element = matches!(read.name.steps().last(), Some(Step::Index(_)));
    let [take] = read.takes.as_slice() else { return None };
    let is_plain = tags.get(take.tag)?.item.name.bit().is_none() && matches!(take.part, Part::Inside(_));
    (has_neighbours && is_element && is_plain && read.retry.is_none()).then_some(kind)
}

fn follows(last: &Read, next: &Read) -> bool {
    let [one, other] = [last, next].map(|read| read.name.steps().split_last());
    let (Some((Step::Index(one), before)), Some((Step::Index(other), behind))) = (one, other) else {
        return false;
    };
    let (Some((one, row)), Some((other, other_row))) = (one.split_last(), other.split_last()) else {
        return false;
    };
    before == behind && row == other_row && one.checked_add(1) == Some(*other) && last.kind == next.kind
}

fn fits(element: &Read, count: usize, limits: &DeviceLimits) -> bool {
    let size = element.kind.as_ref().map_or(0, |kind| kind.size(limits.dialect));
    REPLY_HEAD + count.saturating_mul(size) <= limits.reply_max && u16::try_from(count).is_ok()
}

fn joined(run: Vec<Read>, dialect: Dialect) -> Vec<Read> {
    let joined = match run.as_slice() {
        [first, _, ..] => u16::try_from(run.len()).ok().zip(first.kind.as_ref()).and_then(|(count, kind)| {
            let takes = run.iter().flat_map(|read| &read.takes).enumerate();
            let takes = takes.map(|(index, take)| Take { part: Part::Element(index), ..*take }).collect();
            Some(Read { takes, ..Read::run(first.name.clone(), kind, count, dialect)? })
        }),
        _ => None,
    };
    joined.map_or(run, |joined| alloc::vec![joined])
}
