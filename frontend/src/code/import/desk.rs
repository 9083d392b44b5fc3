//! What lies on the desk: the texts, what was found in them, and what somebody has decided about it.

use std::rc::Rc;

use cipdeck_shared::code::{Dialect, Imported};
use yew::Reducible;

pub use self::source::{Left, Outcome, Pick, Source};
use super::super::decode::{Encoding, NoText};

mod source;

/// Texts that lie beside each other.
pub const MAX_SOURCES: usize = 50;

/// The texts; the first is where somebody types.
#[derive(Clone, Debug, PartialEq)]
pub struct Desk {
    /// At least one.
    pub sources: Vec<Source>,
    /// Which of them is shown.
    pub shown: usize,
    /// Where the blocks go whose text names no device.
    pub target: String,
    /// Files that are not read, and why.
    pub refused: Vec<(String, Refusal)>,
    /// Numbers for what comes next.
    next: u32,
}

/// Why a file is not on the desk.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Refusal {
    /// It is no text that we read.
    NoText(NoText),
    /// The browser does not give it.
    Unreadable,
    /// There are [`MAX_SOURCES`] already.
    TooMany,
}

/// A block among all texts: the key of its text, and its number there.
pub type Place = (u32, usize);

/// Something that happens to the desk.
#[derive(Clone, Debug)]
pub enum Deed {
    /// Another text in the source with this key.
    Type(u32, String),
    /// Another dialect for it, or none.
    Choose(u32, Option<Dialect>),
    /// It was read, as this text and in this dialect.
    Read(u32, Rc<str>, Option<Dialect>, Rc<Imported>),
    /// A file with its text.
    Add(String, String, Encoding),
    /// A file that is not taken.
    Refuse(String, Refusal),
    /// A text is put away; the last one is emptied.
    Remove(u32),
    /// The source with this key is shown.
    Show(u32),
    /// A block is to be saved, or not.
    Keep(Place, bool),
    /// All blocks are to be saved, or none.
    KeepAll(bool),
    /// Another name for a block.
    Rename(Place, String),
    /// Where to, for those that do not know.
    Target(String),
    /// What became of a block.
    Became(Place, Outcome),
}

impl Default for Desk {
    fn default() -> Self {
        Self { sources: vec![Source::new(0)], shown: 0, target: String::new(), refused: Vec::new(), next: 1 }
    }
}

impl Desk {
    /// The desk with texts that were left on it; `None` without any.
    pub fn left(texts: impl Iterator<Item = Left>, shown: usize, target: String) -> Option<Self> {
        let sources: Vec<_> =
            (0..).zip(texts.take(MAX_SOURCES)).map(|(key, left)| Source::left(key, left)).collect();
        let next = u32::try_from(sources.len()).ok()?;
        let shown = if shown < sources.len() { shown } else { 0 };
        (!sources.is_empty()).then(|| Self { sources, shown, target, refused: Vec::new(), next })
    }

    /// The source that is shown.
    pub fn source(&self) -> Option<&Source> {
        self.sources.get(self.shown)
    }

    fn at(&mut self, key: u32) -> Option<&mut Source> {
        self.sources.iter_mut().find(|source| source.key == key)
    }

    fn pick(&mut self, (key, index): Place) -> Option<&mut Pick> {
        self.at(key)?.picks.get_mut(index)
    }

    fn add(&mut self, file: String, text: String, encoding: Encoding) {
        if self.sources.iter().all(Source::is_empty) {
            self.sources.clear();
        }
        if self.sources.len() >= MAX_SOURCES {
            self.refused.push((file, Refusal::TooMany));
            return;
        }
        let key = self.next;
        self.next += 1;
        let file = Some(file);
        self.sources.push(Source { file, text: text.into(), encoding, is_stale: true, ..Source::new(key) });
        self.shown = self.sources.len() - 1;
    }

    fn remove(&mut self, key: u32) {
        self.sources.retain(|source| source.key != key);
        if self.sources.is_empty() {
            self.sources.push(Source::new(self.next));
            self.next += 1;
        }
        self.shown = self.shown.min(self.sources.len() - 1);
    }

    fn suffer(&mut self, deed: Deed) -> Option<()> {
        match deed {
            Deed::Type(key, text) => {
                self.refused.clear();
                let source = self.at(key)?;
                source.text = text.into();
                source.changed();
            }
            Deed::Choose(key, dialect) => {
                let source = self.at(key)?;
                source.dialect = dialect;
                source.changed();
            }
            Deed::Read(key, text, dialect, imported) => {
                // What was typed in the meantime is read next.
                let source = self.at(key).filter(|it| it.text == text && it.dialect == dialect)?;
                source.put(imported);
            }
            Deed::Add(file, text, encoding) => self.add(file, text, encoding),
            Deed::Refuse(file, why) => self.refused.push((file, why)),
            Deed::Remove(key) => {
                self.refused.clear();
                self.remove(key);
            }
            Deed::Show(key) => self.shown = self.sources.iter().position(|source| source.key == key)?,
            Deed::Keep(place, kept) => self.pick(place)?.kept = kept,
            Deed::KeepAll(kept) => {
                self.sources.iter_mut().flat_map(|it| &mut it.picks).for_each(|it| it.kept = kept);
            }
            Deed::Rename(place, name) => {
                let pick = self.pick(place)?;
                pick.name = Some(name);
                pick.reopen();
            }
            Deed::Target(target) => {
                self.target = target;
                self.sources.iter_mut().flat_map(|it| &mut it.picks).for_each(Pick::reopen);
            }
            Deed::Became(place, outcome) => self.pick(place)?.outcome = outcome,
        }
        Some(())
    }
}

impl Reducible for Desk {
    type Action = Deed;

    fn reduce(self: Rc<Self>, deed: Deed) -> Rc<Self> {
        let mut desk = (*self).clone();
        match desk.suffer(deed) {
            Some(()) => desk.into(),
            None => self,
        }
    }
}

#[cfg(test)]
mod tests;
