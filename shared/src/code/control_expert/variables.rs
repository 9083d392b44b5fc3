//! Tables of words among the variables of a section.

use alloc::collections::BTreeMap;
use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;

use super::super::text::{Declaration, Expression, Memory, Reference, Script, Statement, Step};
use super::located::Located;
use super::read::key_of;

/// Words of a table that is looked for by its elements; no exchange has more.
pub(super) const MAX_WORDS: usize = 1_024;

/// What is known of a table of words.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Table {
    /// From its first element on.
    pub(super) words: Vec<Option<Word>>,
    /// How many elements it has, if it is declared or its length is written behind it.
    pub(super) size: Option<usize>,
}

/// What an element holds.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Word {
    /// A constant.
    Known(u16),
    /// Something that the program makes.
    Made,
}

/// The variables of a section at one of its statements.
pub(super) struct Variables<'v, 's, 'a> {
    pub(super) script: &'s Script<'a>,
    pub(super) memory: &'v Memory<'s, 'a>,
    pub(super) located: &'v Located,
    pub(super) names: &'v Names<'s, 'a>,
}

/// Where the variables of a section are declared and assigned, by their names and places in lower case.
#[derive(Debug, Default)]
pub(super) struct Names<'s, 'a> {
    /// The first declaration of each.
    declared: BTreeMap<String, &'s Declaration<'a>>,
    /// The line of the first assignment of each.
    assigned: BTreeMap<String, usize>,
}

impl<'s, 'a> Names<'s, 'a> {
    pub(super) fn of(script: &'s Script<'a>) -> Self {
        let mut all = Self::default();
        for item in &script.items {
            match &item.statement {
                Statement::Declaration(declaration) => {
                    let names = declaration.names.iter().map(|(name, _)| *name).chain(declaration.at);
                    for name in names {
                        all.declared.entry(name.to_ascii_lowercase()).or_insert(declaration);
                    }
                }
                Statement::Assignment { target, .. } => {
                    all.assigned.entry(key_of(target.root)).or_insert(item.place.line);
                }
                Statement::Call(_) => {}
            }
        }
        all
    }

    /// The first line that assigns to a variable.
    pub(super) fn assigned(&self, root: &str) -> Option<usize> {
        self.assigned.get(&key_of(root)).copied()
    }
}

impl<'s, 'a> Variables<'_, 's, 'a> {
    /// The declaration of a variable, or of what lies at a place.
    pub(super) fn declaration(&self, name: &str) -> Option<&'s Declaration<'a>> {
        self.names.declared.get(&name.to_ascii_lowercase()).copied()
    }

    /// A table: an array, `%MW100:5`, or an array from an element on.
    pub(super) fn table(&self, reference: &Reference<'_>) -> Table {
        match memory_words(reference.root) {
            Some((first, count)) => {
                let cell = |index: usize| self.word(&format!("%mw{}", first.saturating_add(index)));
                let known = (0..MAX_WORDS).take_while(|index| cell(*index).is_some()).count();
                let words = (0..count.unwrap_or(known).min(MAX_WORDS)).map(cell).collect();
                Table { words, size: count }
            }
            None => self.array(reference),
        }
    }

    fn array(&self, reference: &Reference<'_>) -> Table {
        let key = reference.root.to_ascii_lowercase();
        let bounds = self.declaration(reference.root).and_then(|it| it.kind.bounds.first().copied());
        let from = match reference.steps.as_slice() {
            [Step::Index(indexes)] => indexes.first().and_then(Expression::integer),
            _ => None,
        };
        let below = self.memory.below(&key).into_keys();
        let index = |path: &str| path.strip_prefix('[')?.strip_suffix(']')?.parse().ok();
        let last: Option<i128> = below.filter_map(index).max();
        // Without a declaration the printed tables begin at 0.
        let low = from.or(bounds.map(|(low, _)| low)).unwrap_or(0);
        let high = bounds.map(|(_, high)| high);
        let count_to = |high: i128| usize::try_from(high.saturating_sub(low).saturating_add(1)).unwrap_or(0);
        let size = high.map(count_to);
        let count = high.or(last).map_or(0, count_to);
        let words = (0..count.min(MAX_WORDS))
            .map(|at| self.word(&format!("{key}[{}]", low.saturating_add(i128::try_from(at).unwrap_or(0)))))
            .collect();
        Table { words, size }
    }

    /// What one word holds; `None`: nobody sets it.
    pub(super) fn word(&self, key: &str) -> Option<Word> {
        let number = self.value(key)?.integer_in(self.memory);
        let word = number.and_then(|number| {
            u16::try_from(number).or_else(|_| i16::try_from(number).map(i16::cast_unsigned)).ok()
        });
        Some(word.map_or(Word::Made, Word::Known))
    }

    /// What is known of a word under either of its names: what was assigned to it last.
    fn value(&self, key: &str) -> Option<&'s Expression<'a>> {
        let here = self.memory.cell(key);
        let there = self.located.other(key).and_then(|other| self.memory.cell(&other));
        let last = here.into_iter().chain(there).max_by_key(|cell| (cell.assigned, cell.item));
        last.map(|cell| cell.value)
    }

    /// The element of a table, such as `Management_Param[2]`.
    pub(super) fn element(&self, table: &Reference<'_>, index: usize) -> Option<Word> {
        if let Some((first, _)) = memory_words(table.root) {
            return self.word(&format!("%mw{}", first.saturating_add(index)));
        }
        let bounds = self.declaration(table.root).and_then(|it| it.kind.bounds.first().copied());
        let low = bounds.map_or(0, |(low, _)| low);
        let index = low.saturating_add(i128::try_from(index).unwrap_or(0));
        self.word(&format!("{}[{index}]", table.root.to_ascii_lowercase()))
    }

    /// The text of an address: `ADDR('…')`, written in the call or assigned before.
    pub(super) fn address(&self, value: &Expression<'a>) -> Option<String> {
        match value {
            Expression::Call(call) => {
                let function = call.name.root.to_ascii_uppercase();
                let argument = call.argument(0, "IN")?.value.as_ref()?;
                let text = match argument {
                    Expression::Reference(reference) => {
                        self.memory.value(&reference.key()?)?.text()?.to_string()
                    }
                    argument => argument.text()?.to_string(),
                };
                Some(format!("{function}('{text}')"))
            }
            Expression::Reference(reference) => {
                let value = self.memory.value(&reference.key()?)?;
                // One step only: a variable that stands for itself would go round for ever.
                if matches!(value, Expression::Reference(_)) { None } else { self.address(value) }
            }
            _ => None,
        }
    }
}

/// `%MW100:5` is 100 and 5.
pub(super) fn memory_words(root: &str) -> Option<(usize, Option<usize>)> {
    let rest = root.strip_prefix("%MW").or_else(|| root.strip_prefix("%mw"))?;
    let (first, count) =
        rest.split_once(':').map_or((rest, None), |(first, count)| (first, count.parse().ok()));
    first.parse().ok().map(|first: usize| (first, count))
}
