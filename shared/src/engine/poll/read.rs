//! One question to the device, and who waits for its answer.

use alloc::boxed::Box;
use alloc::vec::Vec;

use crate::engine::time::{Instant, Millis};
use crate::tag::{Dialect, Dimensions, TagName, Type, request};

/// One question: a whole variable, or neighbouring elements of an array.
#[derive(Clone, Debug)]
pub(super) struct Read {
    /// What is asked for: the variable, or the first element.
    pub(super) name: TagName,
    /// How many elements.
    pub(super) count: u16,
    /// Type of all that is asked for; `None` = as the device says.
    pub(super) kind: Option<Type>,
    /// Read Tag, encoded.
    pub(super) request: Vec<u8>,
    /// Bytes of its reply: what its type makes of it, or the longest that was seen.
    pub(super) reply: usize,
    /// Whether a reply was seen.
    pub(super) is_seen: bool,
    pub(super) way: Way,
    pub(super) takes: Vec<Take>,
    /// Set while it is isolated.
    pub(super) retry: Option<Retry>,
}

/// How it is asked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Way {
    /// In one request, which may travel with others.
    Plain,
    /// Logix: Read Tag Fragmented, as many bytes at a time as the device likes.
    Fragments,
    /// Omron: simple data segments of so many bytes, to the end where it is known.
    Parts { chunk: u16, total: Option<usize> },
    /// Elements from one index to another, so many at a time.
    Ranges { elements: u16 },
}

/// Who gets what of the answer.
#[derive(Clone, Copy, Debug)]
pub(super) struct Take {
    /// Place of the tag in its group.
    pub(super) tag: usize,
    pub(super) part: Part,
}

/// Which part.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Part {
    /// What the tag's steps lead to behind so many of them, and its bit.
    Inside(usize),
    /// One of the neighbouring elements.
    Element(usize),
    /// A BOOL of an array that the device keeps in DWORDs.
    Packed(u8),
}

/// A read that the device refuses is asked by itself, and more and more rarely.
#[derive(Clone, Copy, Debug)]
pub(super) struct Retry {
    /// Not before this.
    pub(super) at: Instant,
    wait: Millis,
    /// Others were isolated with it, and one of them works again: it may travel with others.
    pub(super) together: bool,
}

impl Retry {
    const FIRST: Millis = Millis(5_000);
    const LONGEST: Millis = Millis(60_000);

    /// After a refusal; the wait doubles.
    pub(super) fn after(before: Option<Self>, now: Instant) -> Self {
        let wait = before.map_or(Self::FIRST, |before| Millis((2 * before.wait.0).min(Self::LONGEST.0)));
        Self { at: now + wait, wait, together: false }
    }

    pub(super) const fn again(self, now: Instant) -> Self {
        Self { at: now, together: true, ..self }
    }
}

/// Reply without data: service, reserved, status, size of the additional status; then the type and a handle.
pub(super) const REPLY_HEAD: usize = 4 + 4;

/// Bytes that are expected of a type that nobody knows.
const UNKNOWN: usize = 8;

impl Read {
    /// `None` if the name makes a request that does not exist.
    pub(super) fn new(name: TagName, count: u16, kind: Option<Type>, dialect: Dialect) -> Option<Self> {
        let request = request::read(name.path(), count).ok()?.bytes();
        let data = kind.as_ref().map_or(UNKNOWN, |kind| expected(kind, dialect));
        Some(Self {
            name,
            count,
            kind,
            request,
            reply: REPLY_HEAD + data,
            is_seen: false,
            way: Way::Plain,
            takes: Vec::new(),
            retry: None,
        })
    }

    /// Neighbouring elements from `first` on.
    pub(super) fn run(first: TagName, element: &Type, count: u16, dialect: Dialect) -> Option<Self> {
        let dimensions = Dimensions::of_length(count.into())?;
        let kind = Type::Array(Box::new(element.clone()), dimensions);
        let kind = if count == 1 { element.clone() } else { kind };
        Self::new(first, count, Some(kind), dialect)
    }

    /// The second half of neighbouring elements goes its own way.
    pub(super) fn halve(
        &mut self,
        names: impl Fn(usize) -> Option<TagName>,
        dialect: Dialect,
    ) -> Option<Self> {
        let element = self.kind.as_ref().filter(|_| self.count > 1)?.element().clone();
        let half = usize::from(self.count / 2);
        let (mut first, mut second): (Vec<Take>, Vec<Take>) =
            self.takes.iter().partition(|take| matches!(take.part, Part::Element(index) if index < half));
        let count = |takes: &[Take]| u16::try_from(takes.len()).ok();
        let mut halves = [&mut first, &mut second].map(|takes| {
            let read = Self::run(names(takes.first()?.tag)?, &element, count(takes)?, dialect)?;
            for (index, take) in takes.iter_mut().enumerate() {
                take.part = Part::Element(index);
            }
            Some(Self { takes: core::mem::take(takes), ..read })
        });
        let [first, second] = &mut halves;
        *self = first.take()?;
        second.take()
    }

    /// Whether these are neighbouring elements of which some may be fine.
    pub(super) const fn is_run(&self) -> bool {
        self.count > 1 && matches!(self.takes.as_slice(), [Take { part: Part::Element(_), .. }, ..])
    }
}

/// Bytes of data that a reply with the whole has at most.
pub(super) fn expected(kind: &Type, dialect: Dialect) -> usize {
    let size = kind.size(dialect);
    match (kind, dialect) {
        (Type::String(_), Dialect::Omron) => 2 + size,
        // BOOLs that are asked for by their number are a byte each.
        (Type::Array(element, dimensions), Dialect::Omron | Dialect::Micro800)
            if matches!(**element, Type::Elementary(crate::tag::Elementary::Bool)) =>
        {
            size.max(dimensions.count())
        }
        _ => size,
    }
}
