//! What lies on the desk: the texts, what was found in them, and what somebody has decided about it.

use std::rc::Rc;

use cipdeck_shared::{
    api::Problem,
    code::{Dialect, Found, Imported},
    config::BlockId,
};
use yew::Reducible;

use super::super::decode::{Encoding, NoText};

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

/// A text.
#[derive(Clone, Debug, PartialEq)]
pub struct Source {
    /// Its own for ever.
    pub key: u32,
    /// The file that it came from.
    pub file: Option<String>,
    /// How that was written.
    pub encoding: Encoding,
    /// The text.
    pub text: Rc<str>,
    /// The dialect that somebody has chosen; otherwise it is recognised.
    pub dialect: Option<Dialect>,
    /// What was found in it when it was read last.
    pub imported: Option<Rc<Imported>>,
    /// Whether it has changed since then.
    pub is_stale: bool,
    /// What is decided about each block that was found.
    pub picks: Vec<Pick>,
}

/// What is decided about a block.
#[derive(Clone, Debug, PartialEq)]
pub struct Pick {
    /// Whether it is to be saved.
    pub kept: bool,
    /// What it is to be called, if somebody has decided that.
    pub name: Option<String>,
    /// What became of it.
    pub outcome: Outcome,
}

/// What became of a block.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Outcome {
    /// Nothing yet.
    #[default]
    Open,
    /// It is on its way.
    Saving,
    /// The relay has it.
    Saved(BlockId),
    /// The relay does not take it.
    Refused(Rc<Problem>),
}

/// A text that was left: file, how that was written, text, chosen dialect, and what was decided.
pub type Left = (Option<String>, Encoding, String, Option<Dialect>, Vec<Pick>);

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

impl Source {
    fn new(key: u32) -> Self {
        Self {
            key,
            file: None,
            encoding: Encoding::Utf8,
            text: "".into(),
            dialect: None,
            imported: None,
            is_stale: false,
            picks: Vec::new(),
        }
    }

    /// Whether nobody would miss it.
    pub fn is_empty(&self) -> bool {
        self.file.is_none() && self.text.trim().is_empty()
    }

    /// Decides about what is read next, if it is this text again.
    fn left(key: u32, (file, encoding, text, dialect, picks): Left) -> Self {
        Self { file, encoding, text: text.into(), dialect, picks, is_stale: true, ..Self::new(key) }
    }

    /// Another text, or the same in another dialect. What was decided before a reload was about what was there then.
    fn changed(&mut self) {
        self.is_stale = true;
        if self.imported.is_none() {
            self.picks.clear();
        }
    }

    /// Decisions stay with the block of the same name, or at the same place when its name has changed.
    fn put(&mut self, imported: Rc<Imported>) {
        let before = self.imported.take();
        if before.is_none() && self.picks.len() == imported.blocks.len() {
            self.imported = Some(imported);
            self.is_stale = false;
            return;
        }
        let old: &[Found] = before.as_ref().map_or(&[], |imported| &imported.blocks);
        let mut picks: Vec<_> = self.picks.drain(..).map(Some).collect();
        let matching = |found: &Found, index: usize, picks: &[Option<Pick>]| {
            let open = |at: &usize| picks.get(*at).is_some_and(Option::is_some);
            let named = old.iter().position(|other| other.config.name() == found.config.name());
            let same_place = || (old.len() == imported.blocks.len()).then_some(index);
            named.filter(open).or_else(same_place).filter(open)
        };
        let mut decided = Vec::with_capacity(imported.blocks.len());
        for (index, found) in imported.blocks.iter().enumerate() {
            let at = matching(found, index, &picks);
            let pick = at.and_then(|at| picks.get_mut(at)).and_then(Option::take);
            let is_same = at.and_then(|at| old.get(at)).is_some_and(|old| old.config == found.config);
            let mut pick = pick.unwrap_or_default();
            if !is_same {
                pick.outcome = Outcome::Open;
            }
            decided.push(pick);
        }
        self.picks = decided;
        self.imported = Some(imported);
        self.is_stale = false;
    }
}

impl Default for Pick {
    fn default() -> Self {
        Self { kept: true, name: None, outcome: Outcome::Open }
    }
}

impl Pick {
    /// Whether it is done with.
    pub fn is_saved(&self) -> bool {
        matches!(self.outcome, Outcome::Saved(_))
    }

    /// A changed block may be tried again.
    fn reopen(&mut self) {
        if matches!(self.outcome, Outcome::Refused(_)) {
            self.outcome = Outcome::Open;
        }
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
