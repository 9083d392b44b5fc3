//! Variables that lie on memory words: `Req AT %MW100 : ARRAY [0..9] OF INT` and `%MW100:10` are the same words.

use alloc::collections::BTreeMap;
use alloc::format;
use alloc::string::{String, ToString};

use super::super::text::{Script, Statement};
use super::variables::memory_words;

/// One such variable.
#[derive(Clone, Debug)]
struct Area {
    /// In lower case.
    name: String,
    /// Its first memory word.
    first: usize,
    /// Words.
    count: usize,
    /// The index of the first element; `None`: no array.
    low: Option<i128>,
}

/// All of them.
#[derive(Clone, Debug, Default)]
pub(super) struct Located {
    by_word: BTreeMap<usize, Area>,
    by_name: BTreeMap<String, usize>,
}

impl Located {
    pub(super) fn of(script: &Script<'_>) -> Self {
        let mut located = Self::default();
        for item in &script.items {
            let Statement::Declaration(declaration) = &item.statement else { continue };
            let place = declaration.at.and_then(memory_words);
            let Some(((first, _), (name, _))) = place.zip(declaration.names.first()) else { continue };
            let name = name.to_ascii_lowercase();
            let count = usize::try_from(declaration.kind.elements()).unwrap_or(0);
            let low = declaration.kind.bounds.first().map(|(low, _)| *low);
            located.by_name.insert(name.clone(), first);
            located.by_word.insert(first, Area { name, first, count, low });
        }
        located
    }

    /// The other key of a word: of `%mw101` the element, of an element the memory word.
    pub(super) fn other(&self, key: &str) -> Option<String> {
        if let Some((word, _)) = memory_words(key) {
            let area = self.by_word.range(..=word).next_back()?.1;
            let at = word.checked_sub(area.first).filter(|at| *at < area.count)?;
            return Some(match area.low {
                Some(low) => format!("{}[{}]", area.name, low.saturating_add(i128::try_from(at).ok()?)),
                None => area.name.clone(),
            });
        }
        let (name, index) = match key.split_once('[') {
            Some((name, index)) => (name, Some(index.strip_suffix(']')?.parse::<i128>().ok()?)),
            None => (key, None),
        };
        let area = self.by_word.get(self.by_name.get(name)?)?;
        let at = match index {
            Some(index) => usize::try_from(index.checked_sub(area.low?)?).ok()?,
            None => 0,
        };
        (at < area.count).then(|| format!("%mw{}", area.first.saturating_add(at)))
    }

    /// The other name of a whole variable.
    pub(super) fn alias(&self, root: &str) -> Option<String> {
        match memory_words(root) {
            Some((first, _)) => Some(self.by_word.range(..=first).next_back()?.1)
                .filter(|area| first - area.first < area.count)
                .map(|area| area.name.clone()),
            None => {
                self.by_name.get(&root.to_ascii_lowercase()).map(|first| format!("%mw{first}").to_string())
            }
        }
    }
}
