//! What variables hold.

use alloc::collections::BTreeMap;
use alloc::format;
use alloc::string::{String, ToString};

use super::script::{Item, Script};
use super::syntax::{Declaration, Expression, Statement};

/// Values that one text may set. More are left out, which [`Memory::is_full`] tells.
const MAX_CELLS: usize = 100_000;

/// Values that all calculations of one text look at: a thousand messages whose every byte is calculated. Without a limit a
/// short text would be calculated for hours.
const MAX_WORK: u32 = 4_000_000;

/// Elements of a variable that are listed: more than [`super::Reading`] takes of any.
const MAX_BELOW: usize = 5_000;

/// Bytes of a key; names in programs are far shorter.
const MAX_KEY: usize = 256;

/// A value, and who set it.
#[derive(Clone, Copy, Debug)]
pub(in crate::code) struct Cell<'s, 'a> {
    /// What was assigned.
    pub(in crate::code) value: &'s Expression<'a>,
    /// Which item of the script did it.
    pub(in crate::code) item: usize,
    /// An assignment, not an initial value.
    pub(in crate::code) assigned: bool,
    /// Assigned more than once since the last call; the last one counts.
    pub(in crate::code) again: bool,
}

/// What each variable holds at one place of a script. Keys are those of [`super::Reference::key`]: elements and
/// members are entries of their own, whichever way they were set.
#[derive(Clone, Debug, Default)]
pub(in crate::code) struct Memory<'s, 'a> {
    now: Cells<'s, 'a>,
    /// The first assignment of each variable in the whole text: for what is assigned only after it is used.
    first: Cells<'s, 'a>,
    last_call: Option<usize>,
    /// Values that calculations have looked at so far.
    looked_at: core::cell::Cell<u32>,
}

#[derive(Clone, Debug, Default)]
struct Cells<'s, 'a> {
    cells: BTreeMap<String, Cell<'s, 'a>>,
    full: bool,
}

impl<'s, 'a> Memory<'s, 'a> {
    /// Before the first item: the initial values.
    pub(in crate::code) fn new(script: &'s Script<'a>) -> Self {
        let mut memory = Self::default();
        for (index, item) in script.items.iter().enumerate() {
            match &item.statement {
                Statement::Declaration(declaration) => memory.now.declare(index, declaration),
                Statement::Assignment { target, value } => {
                    let key = target.key().filter(|key| !memory.first.cells.contains_key(key));
                    if let Some(key) = key {
                        let cell = Cell { value, item: index, assigned: true, again: false };
                        memory.first.spread(&key, cell, 0);
                    }
                }
                Statement::Call(_) => {}
            }
        }
        memory
    }

    /// Before an item.
    #[cfg(test)]
    pub(in crate::code) fn before(script: &'s Script<'a>, item: usize) -> Self {
        let mut memory = Self::new(script);
        for (index, item) in script.items.iter().enumerate().take(item) {
            memory.step(index, item);
        }
        memory
    }

    /// After one more item.
    pub(in crate::code) fn step(&mut self, index: usize, item: &'s Item<'a>) {
        match &item.statement {
            Statement::Assignment { target, value } => {
                let Some(key) = target.key() else { return };
                let again =
                    self.now.cells.get(&key).is_some_and(|cell| {
                        cell.assigned && self.last_call.is_none_or(|call| cell.item > call)
                    });
                self.now.spread(&key, Cell { value, item: index, assigned: true, again }, 0);
            }
            Statement::Call(_) => self.last_call = Some(index),
            Statement::Declaration(_) => {}
        }
    }

    /// Whether there were too many values.
    pub(in crate::code) fn is_full(&self) -> bool {
        self.now.full || self.first.full || self.looked_at.get() > MAX_WORK
    }

    /// Counts one more value that a calculation looks at; whether it may.
    pub(super) fn look(&self) -> bool {
        let so_far = self.looked_at.get();
        self.looked_at.set(so_far.saturating_add(1));
        so_far < MAX_WORK
    }

    /// What a variable holds.
    pub(in crate::code) fn cell(&self, key: &str) -> Option<&Cell<'s, 'a>> {
        self.now.cells.get(key).or_else(|| self.first.cells.get(key))
    }

    /// What a variable holds.
    pub(in crate::code) fn value(&self, key: &str) -> Option<&'s Expression<'a>> {
        self.cell(key).map(|cell| cell.value)
    }

    /// A whole number that a variable holds.
    #[cfg(test)]
    pub(in crate::code) fn integer(&self, key: &str) -> Option<i128> {
        self.value(key)?.integer_in(self)
    }

    /// The elements and members of a variable, in the order of their keys: what follows its key, and the value. Of one
    /// that has more than any message, so many that this is seen.
    pub(in crate::code) fn below(&self, key: &str) -> BTreeMap<&str, &Cell<'s, 'a>> {
        let mut below = BTreeMap::new();
        for cells in [&self.first, &self.now] {
            for open in ['.', '['] {
                let start = format!("{key}{open}");
                let range =
                    cells.cells.range(start.clone()..).take_while(|(path, _)| path.starts_with(&start));
                below.extend(
                    range.take(MAX_BELOW).filter_map(|(path, cell)| Some((path.get(key.len()..)?, cell))),
                );
            }
        }
        below
    }
}

impl<'s, 'a> Cells<'s, 'a> {
    fn declare(&mut self, item: usize, declaration: &'s Declaration<'a>) {
        let Some(value) = &declaration.initial else { return };
        let low = declaration.kind.bounds.first().map_or(0, |(low, _)| *low);
        let cell = Cell { value, item, assigned: false, again: false };
        for (name, _) in &declaration.names {
            self.spread(&name.to_ascii_lowercase(), cell, low);
        }
        if let Some(address) = declaration.at {
            self.spread(&address.to_ascii_lowercase(), cell, low);
        }
    }

    /// Lists become elements, structures become members.
    fn spread(&mut self, key: &str, cell: Cell<'s, 'a>, low: i128) {
        match cell.value {
            Expression::List(elements, _) => {
                let mut at = low;
                for value in elements {
                    at = self.element(key, Cell { value, ..cell }, at);
                }
            }
            Expression::Repeated(..) => {
                self.element(key, cell, low);
            }
            Expression::Structure(members, _) => {
                for (name, value) in members {
                    self.spread(&format!("{key}.{}", name.to_ascii_lowercase()), Cell { value, ..cell }, 0);
                }
            }
            _ if self.cells.len() < MAX_CELLS && key.len() <= MAX_KEY => {
                self.cells.insert(key.to_string(), cell);
            }
            _ => self.full = true,
        }
    }

    /// One element, or several of them; the index after it.
    fn element(&mut self, key: &str, cell: Cell<'s, 'a>, at: i128) -> i128 {
        let Expression::Repeated(count, values, _) = cell.value else {
            self.spread(&format!("{key}[{at}]"), cell, 0);
            return at.saturating_add(1);
        };
        let mut at = at;
        for _ in 0..(*count).max(0) {
            // Repetitions inside of repetitions multiply: they are not read.
            if values.iter().any(|value| matches!(value, Expression::Repeated(..))) {
                self.full = true;
            }
            if values.is_empty() || self.full {
                break;
            }
            for value in values {
                self.spread(&format!("{key}[{at}]"), Cell { value, ..cell }, 0);
                at = at.saturating_add(1);
            }
        }
        at
    }
}
