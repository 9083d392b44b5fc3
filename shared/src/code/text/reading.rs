//! The values of one message's variables, with a remark for each that is not as it should be.

use alloc::collections::{BTreeMap, BTreeSet};
use alloc::string::String;
use alloc::vec::Vec;
use core::ops::Range;

use super::memory::{Cell, Memory};
use super::script::{Item, Script};
use super::syntax::{Call, Expression, Reference};
use super::token::Place;
use crate::code::remark::{Remark, RemarkKind};
use crate::plan::Severity;

/// The values at one call.
pub(in crate::code) struct Reading<'r, 's, 'a> {
    script: &'s Script<'a>,
    memory: &'r Memory<'s, 'a>,
    lines: Range<usize>,
    place: Place,
    excerpt: &'a str,
    /// What is to be said so far.
    pub(in crate::code) remarks: Vec<Remark>,
}

impl<'r, 's, 'a> Reading<'r, 's, 'a> {
    /// At the call that is this item.
    pub(in crate::code) fn new(script: &'s Script<'a>, memory: &'r Memory<'s, 'a>, item: &Item<'a>) -> Self {
        Self {
            script,
            memory,
            lines: item.place.line..item.last_line + 1,
            place: item.place,
            excerpt: script.source(item),
            remarks: Vec::new(),
        }
    }

    /// From the first line that was used to the last one of the call.
    pub(in crate::code) fn lines(&self) -> Range<usize> {
        self.lines.clone()
    }

    /// Something about the call as a whole.
    pub(in crate::code) fn say(&mut self, severity: Severity, what: RemarkKind) {
        let (line, column) = (self.place.line, self.place.column);
        self.remarks.push(Remark { severity, ..Remark::error(line, column, self.excerpt, what) });
    }

    fn at(&mut self, severity: Severity, cell: &Cell<'s, 'a>, what: RemarkKind) {
        let place = cell.value.place();
        let excerpt = self.script.items.get(cell.item).map_or("", |item| self.script.source(item));
        self.remarks.push(Remark { severity, ..Remark::error(place.line, place.column, excerpt, what) });
    }

    /// The value of a variable, and that it was used.
    fn cell(&mut self, key: &str, member: &str) -> Option<Cell<'s, 'a>> {
        let cell = *self.memory.cell(key)?;
        if let Some(item) = self.script.items.get(cell.item) {
            self.lines.start = self.lines.start.min(item.place.line);
        }
        if cell.again {
            self.at(Severity::Warning, &cell, RemarkKind::Twice(member.into()));
        }
        Some(cell)
    }

    /// A whole number; `None`: nobody sets it, or it depends on the program, which is told.
    pub(in crate::code) fn integer(&mut self, key: &str, member: &str, low: i64, high: i64) -> Option<i64> {
        let cell = self.cell(key, member)?;
        let Some(value) = cell.value.integer_in(self.memory) else {
            self.at(Severity::Error, &cell, RemarkKind::NotConstant(member.into()));
            return None;
        };
        let value = i64::try_from(value).ok();
        if value.is_none_or(|value| !(low..=high).contains(&value)) {
            let severity = if value.is_some() { Severity::Warning } else { Severity::Error };
            self.at(severity, &cell, RemarkKind::OutOfRange { member: member.into(), low, high });
        }
        value
    }

    /// TRUE or FALSE.
    pub(in crate::code) fn truth(&mut self, key: &str, member: &str) -> Option<bool> {
        let cell = self.cell(key, member)?;
        let value = cell.value.truth_in(self.memory);
        if value.is_none() {
            self.at(Severity::Error, &cell, RemarkKind::NotConstant(member.into()));
        }
        value
    }

    /// A text; a variable that holds one will do.
    pub(in crate::code) fn text(&mut self, key: &str, member: &str) -> Option<&'s str> {
        let cell = self.cell(key, member)?;
        let mut value = cell.value;
        for _ in 0..8 {
            if let Some(text) = value.text() {
                return Some(text);
            }
            let next = value.reference().and_then(Reference::key);
            match next.and_then(|key| self.memory.value(&key)) {
                Some(next) => value = next,
                None => break,
            }
        }
        self.at(Severity::Error, &cell, RemarkKind::NotConstant(member.into()));
        None
    }

    /// [`Self::text`]; that nobody sets it is told, too.
    pub(in crate::code) fn text_or_told(&mut self, key: &str, member: &str) -> Option<&'s str> {
        if !self.has(key) {
            self.say(Severity::Error, RemarkKind::NotConstant(member.into()));
        }
        self.text(key, member)
    }

    /// Whether anybody sets a variable.
    pub(in crate::code) fn has(&self, key: &str) -> bool {
        self.memory.cell(key).is_some()
    }

    /// A word that stands for a value, such as `Type#Value`.
    pub(in crate::code) fn word(&mut self, key: &str) -> Option<&'a str> {
        let cell = self.cell(key, key)?;
        cell.value.reference().map(|reference| reference.root).or(Some(""))
    }

    /// The message begins at this item at the latest.
    pub(in crate::code) fn begins(&mut self, item: &Item<'a>) {
        self.lines.start = self.lines.start.min(item.place.line);
    }

    /// An argument of the call, or the member of the instance that stands for it: `fb(Timeout := 5)`,
    /// `fb.Timeout := 5`. The key under which it is found.
    pub(in crate::code) fn key(call: &Call<'a>, position: usize, name: &str) -> Option<String> {
        match call.argument(position, name).and_then(|argument| argument.value.as_ref()) {
            Some(Expression::Reference(reference)) => reference.key(),
            Some(_) => None,
            None => Some(alloc::format!("{}.{}", call.name.key()?, name.to_ascii_lowercase())),
        }
    }

    /// A whole number that is given to the call, itself or as a variable.
    pub(in crate::code) fn integer_of(
        &mut self,
        call: &'s Call<'a>,
        position: usize,
        name: &str,
        low: i64,
        high: i64,
    ) -> Option<i64> {
        let Some(key) = Self::key(call, position, name) else {
            let value = call.argument(position, name)?.value.as_ref()?;
            let given = Cell { value, item: usize::MAX, assigned: true, again: false };
            let number = value.integer_in(self.memory).and_then(|value| i64::try_from(value).ok());
            match number {
                None => self.at(Severity::Error, &given, RemarkKind::NotConstant(name.into())),
                Some(number) if !(low..=high).contains(&number) => {
                    self.at(
                        Severity::Warning,
                        &given,
                        RemarkKind::OutOfRange { member: name.into(), low, high },
                    );
                }
                Some(_) => {}
            }
            return number;
        };
        if self.memory.cell(&key).is_none() && call.argument(position, name).is_some() {
            self.say(Severity::Error, RemarkKind::NotConstant(name.into()));
        }
        self.integer(&key, name, low, high)
    }

    /// Members that are set and that nobody knows.
    pub(in crate::code) fn unknown(&mut self, key: &str, known: &[&str]) {
        let memory = self.memory;
        let mut told = BTreeSet::new();
        for (rest, cell) in memory.below(key) {
            let name = rest.trim_start_matches('.').split(['.', '[']).next().unwrap_or_default();
            if told.insert(name) && !known.iter().any(|known| known.eq_ignore_ascii_case(name)) {
                self.at(Severity::Error, cell, RemarkKind::UnknownMember(name.into()));
            }
        }
    }

    /// So many bytes of an array from its first element, which is `low` or else the lowest one that is set, 0 or 1.
    /// Without a length all that are set.
    pub(in crate::code) fn bytes(
        &mut self,
        key: &str,
        member: &str,
        low: Option<i128>,
        length: Option<usize>,
    ) -> Vec<u8> {
        let index = |rest: &str| rest.strip_prefix('[')?.strip_suffix(']')?.parse::<i128>().ok();
        // Only where it is asked: an array may be long, and used by many messages.
        let is_known = low.is_some() && length.is_some();
        let below = if is_known { BTreeMap::new() } else { self.memory.below(key) };
        let set: Vec<i128> = below.keys().filter_map(|rest| index(rest)).collect();
        let low = low.unwrap_or_else(|| set.iter().copied().min().unwrap_or(0).clamp(0, 1));
        let last = set.iter().copied().max();
        let all =
            last.map_or(0, |last| usize::try_from(last.saturating_sub(low)).unwrap_or(0).saturating_add(1));
        let values = self.elements(key, member, low, length.unwrap_or(all), (0, 255));
        values.into_iter().map(|value| u8::try_from(value & 0xFF).unwrap_or(0)).collect()
    }

    /// So many elements of an array from an index on. What is not set is 0, and told.
    pub(in crate::code) fn elements(
        &mut self,
        key: &str,
        member: &str,
        from: i128,
        count: usize,
        (low, high): (i64, i64),
    ) -> Vec<i64> {
        if count > MAX_ELEMENTS {
            self.say(Severity::Error, RemarkKind::Told(alloc::format!("{member} is far too long")));
        }
        let (mut values, mut missing) = (Vec::new(), Vec::new());
        for at in (from..).take(count.min(MAX_ELEMENTS)) {
            let path = alloc::format!("{key}[{at}]");
            if self.memory.cell(&path).is_none() {
                missing.push(at);
            }
            values.push(self.integer(&path, &alloc::format!("{member}[{at}]"), low, high).unwrap_or(0));
        }
        if let (Some(first), Some(last)) = (missing.first(), missing.last()) {
            let count = missing.len();
            let words = alloc::format!(
                "{member}: {count} elements from [{first}] to [{last}] are not set: they are 0"
            );
            self.say(Severity::Warning, RemarkKind::Told(words));
        }
        values
    }
}

/// More than any message has.
const MAX_ELEMENTS: usize = 4096;
