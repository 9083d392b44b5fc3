//! The desk over a reload, and while somebody is elsewhere: its texts and what was decided about them, in the browser's
//! local storage.

use cipdeck_shared::config::BlockId;
use gloo_timers::callback::Timeout;
use serde::{Deserialize, Serialize};
use yew::prelude::*;

use super::{
    super::decode::Encoding,
    desk::{Desk, Outcome, Pick, Source},
};
use crate::browser;

/// Where it is kept.
const DESK: &str = "cipdeck.code";

/// Bytes of all texts together. The storage of a browser ends at about 5 MB, and others keep their drafts there.
const MAX_KEPT: usize = 1 << 20;

/// Bytes that are written at every change; more of them only after a moment.
const QUICK: usize = 64 * 1024;

/// That moment, in ms.
const PAUSE_MS: u32 = 400;

#[derive(Serialize, Deserialize)]
struct Kept {
    shown: usize,
    target: String,
    sources: Vec<KeptSource>,
}

#[derive(Serialize, Deserialize)]
struct KeptSource {
    file: Option<String>,
    encoding: String,
    text: String,
    dialect: String,
    picks: Vec<KeptPick>,
}

#[derive(Serialize, Deserialize)]
struct KeptPick {
    kept: bool,
    name: Option<String>,
    saved: Option<BlockId>,
}

/// What of the desk is kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Keeping {
    /// There is nothing.
    Nothing,
    /// All of it.
    All,
    /// Nothing: it is too much, or the browser keeps nothing.
    NotKept,
}

/// The desk as it was left.
pub(in crate::code) fn restored() -> Desk {
    browser::kept(DESK).as_deref().and_then(read).unwrap_or_default()
}

/// Keeps the desk at every change.
#[hook]
pub(super) fn use_keeping(desk: &UseReducerHandle<Desk>) -> Keeping {
    let keeping = use_state_eq(|| Keeping::Nothing);
    let texts: Vec<_> =
        desk.sources.iter().map(|it| (it.text.clone(), it.dialect, it.picks.clone())).collect();
    use_effect_with((texts, desk.target.clone(), desk.shown), {
        let (desk, keeping) = (desk.clone(), keeping.setter());
        move |_| {
            let is_quick = bytes(&desk) <= QUICK;
            let keep = move || keeping.set(keep(&desk));
            let timer = if is_quick {
                keep();
                None
            } else {
                Some(Timeout::new(PAUSE_MS, keep))
            };
            move || drop(timer)
        }
    });
    *keeping
}

fn keep(desk: &Desk) -> Keeping {
    let is_empty = desk.sources.iter().all(Source::is_empty);
    let text = if is_empty || bytes(desk) > MAX_KEPT { String::new() } else { write(desk) };
    // An older desk in its place would be taken for this one.
    browser::keep(DESK, &text);
    if is_empty {
        Keeping::Nothing
    } else if !text.is_empty() && browser::kept(DESK).is_some_and(|kept| kept.len() == text.len()) {
        Keeping::All
    } else {
        Keeping::NotKept
    }
}

fn bytes(desk: &Desk) -> usize {
    desk.sources.iter().map(|source| source.text.len()).sum()
}

fn write(desk: &Desk) -> String {
    let pick = |pick: &Pick| KeptPick {
        kept: pick.kept,
        name: pick.name.clone(),
        saved: match pick.outcome {
            Outcome::Saved(id) => Some(id),
            _ => None,
        },
    };
    let source = |source: &Source| KeptSource {
        file: source.file.clone(),
        encoding: source.encoding.word().to_owned(),
        text: source.text.to_string(),
        dialect: source.dialect.map_or("", |dialect| dialect.name()).to_owned(),
        picks: source.picks.iter().map(pick).collect(),
    };
    let kept = Kept {
        shown: desk.shown,
        target: desk.target.clone(),
        sources: desk.sources.iter().map(source).collect(),
    };
    serde_json::to_string(&kept).unwrap_or_default()
}

fn read(text: &str) -> Option<Desk> {
    let kept: Kept = serde_json::from_str(text).ok()?;
    let pick = |pick: KeptPick| Pick {
        kept: pick.kept,
        name: pick.name,
        outcome: pick.saved.map_or(Outcome::Open, Outcome::Saved),
    };
    let source = |source: KeptSource| {
        let encoding = Encoding::of_word(&source.encoding);
        let picks = source.picks.into_iter().map(pick).collect();
        (source.file, encoding, source.text, source.dialect.parse().ok(), picks)
    };
    Desk::left(kept.sources.into_iter().map(source), kept.shown, kept.target)
}

#[cfg(test)]
mod tests {
    use std::rc::Rc;

    use cipdeck_shared::code::{Dialect, import};
    use yew::Reducible;

    use super::{super::desk::Deed, *};

    const TEXT: &str = "0E 03 20 01 24 01 30 07";

    fn done(desk: Rc<Desk>, deeds: Vec<Deed>) -> Rc<Desk> {
        deeds.into_iter().fold(desk, Desk::reduce)
    }

    /// Writes a desk, reads it, and reads its texts.
    fn left_and_back(desk: &Desk) -> Rc<Desk> {
        let back = read(&write(desk)).expect("a desk");
        let deeds = back
            .sources
            .iter()
            .map(|it| Deed::Read(it.key, it.text.clone(), it.dialect, Rc::new(import(&it.text, it.dialect))));
        done(Rc::new(back.clone()), deeds.collect())
    }

    #[test]
    fn a_desk_is_as_it_was_left() {
        let text: Rc<str> = TEXT.into();
        let desk = done(
            Rc::default(),
            vec![
                Deed::Type(0, TEXT.to_owned()),
                Deed::Choose(0, Some(Dialect::Hex)),
                Deed::Read(0, text.clone(), Some(Dialect::Hex), Rc::new(import(&text, Some(Dialect::Hex)))),
                Deed::Rename((0, 0), "mine".to_owned()),
                Deed::Became((0, 0), Outcome::Saved(BlockId(7))),
                Deed::Add("a.st".to_owned(), "(* d\u{e9}bit *)".to_owned(), Encoding::Latin1),
                Deed::Target("192.168.1.7".to_owned()),
            ],
        );
        let back = left_and_back(&desk);
        let picks = |desk: &Desk| desk.sources.iter().map(|it| it.picks.clone()).collect::<Vec<_>>();
        assert_eq!(picks(&back), picks(&desk), "nothing is saved twice");
        let looks = |desk: &Desk| {
            let of = |it: &Source| (it.file.clone(), it.encoding, it.text.clone(), it.dialect);
            (desk.sources.iter().map(of).collect::<Vec<_>>(), desk.target.clone(), desk.shown)
        };
        assert_eq!(looks(&back), looks(&desk));
    }

    #[test]
    fn what_was_decided_is_not_for_another_text() {
        let desk = done(
            Rc::default(),
            vec![
                Deed::Type(0, TEXT.to_owned()),
                Deed::Read(0, TEXT.into(), None, Rc::new(import(TEXT, None))),
                Deed::Became((0, 0), Outcome::Saved(BlockId(7))),
            ],
        );
        let back = read(&write(&desk)).expect("a desk");
        let key = back.sources[0].key;
        let other = "0E 03 20 01 24 01 30 06";
        let typed = done(
            Rc::new(back),
            vec![
                Deed::Type(key, other.to_owned()),
                Deed::Read(key, other.into(), None, Rc::new(import(other, None))),
            ],
        );
        assert!(!typed.sources[0].picks[0].is_saved());
    }

    #[test]
    fn what_is_no_desk_is_an_empty_one() {
        for text in ["", "{}", "not json", r#"{"shown":0,"target":"","sources":[]}"#] {
            assert_eq!(read(text), None, "{text}");
        }
        let beyond = r#"{"shown":9,"target":"","sources":[{"file":null,"encoding":"?","text":"x","dialect":"?","picks":[]}]}"#;
        assert_eq!(read(beyond).map(|desk| (desk.shown, desk.sources.len())), Some((0, 1)));
    }
}
