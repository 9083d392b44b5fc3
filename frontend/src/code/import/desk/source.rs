//! A text on the desk, what was found in it, and what is decided about that.

use std::rc::Rc;

use cipdeck_shared::{
    api::Problem,
    code::{Dialect, Found, Imported},
    config::BlockId,
};

use super::super::super::decode::Encoding;

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

impl Source {
    pub(super) fn new(key: u32) -> Self {
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
    pub(super) fn left(key: u32, (file, encoding, text, dialect, picks): Left) -> Self {
        Self { file, encoding, text: text.into(), dialect, picks, is_stale: true, ..Self::new(key) }
    }

    /// Another text, or the same in another dialect. What was decided before a reload was about what was there then.
    pub(super) fn changed(&mut self) {
        self.is_stale = true;
        if self.imported.is_none() {
            self.picks.clear();
        }
    }

    /// Decisions stay with the block of the same name, or at the same place when its name has changed.
    pub(super) fn put(&mut self, imported: Rc<Imported>) {
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
    pub(super) fn reopen(&mut self) {
        if matches!(self.outcome, Outcome::Refused(_)) {
            self.outcome = Outcome::Open;
        }
    }
}
