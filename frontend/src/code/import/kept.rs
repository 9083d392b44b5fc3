//! The desk over a reload, and while somebody is elsewhere: its texts and what was decided about them, in the browser's
//! local storage.

use gloo_timers::callback::Timeout;
use yew::prelude::*;

use super::{
    super::decode::Encoding,
    desk::{Desk, Left, Outcome, Pick, Source},
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

/// A line of fields for the desk, for each text, and for each decision about a block in it. Not JSON: what reads that would
/// be 5 kB of the document.
fn write(desk: &Desk) -> String {
    let mut lines = line(&[&desk.shown.to_string(), &desk.target]);
    for source in &desk.sources {
        let dialect = source.dialect.map_or("", |dialect| dialect.name());
        lines += &line(&[TEXT, &some(source.file.as_deref()), source.encoding.word(), dialect, &source.text]);
        for pick in &source.picks {
            let saved = match pick.outcome {
                Outcome::Saved(id) => id.to_string(),
                _ => String::new(),
            };
            let kept = if pick.kept { KEPT } else { "" };
            lines += &line(&[PICK, kept, &saved, &some(pick.name.as_deref())]);
        }
    }
    lines
}

/// What a line is about.
const TEXT: &str = "text";
const PICK: &str = "pick";

/// In a pick that is to be saved.
const KEPT: &str = "kept";

fn read(lines: &str) -> Option<Desk> {
    let mut lines = lines.lines().map(|line| line.split('\t').map(plain).collect::<Vec<_>>());
    let head = lines.next()?;
    let [shown, target] = &*head else { return None };
    let mut texts: Vec<Left> = Vec::new();
    for fields in lines {
        match &*fields {
            [mark, file, encoding, dialect, text] if mark == TEXT => {
                let (encoding, dialect) = (Encoding::of_word(encoding), dialect.parse().ok());
                texts.push((of_some(file), encoding, text.clone(), dialect, Vec::new()));
            }
            [mark, kept, saved, name] if mark == PICK => {
                let outcome = saved.parse().map_or(Outcome::Open, Outcome::Saved);
                let pick = Pick { kept: kept == KEPT, name: of_some(name), outcome };
                texts.last_mut()?.4.push(pick);
            }
            _ => return None,
        }
    }
    Desk::left(texts.into_iter(), shown.parse().ok()?, target.clone())
}

fn line(fields: &[&str]) -> String {
    let escaped =
        |field: &&str| ESCAPES.iter().fold((*field).to_owned(), |text, (c, code)| text.replace(c, code));
    fields.iter().map(escaped).collect::<Vec<_>>().join("\t") + "\n"
}

fn plain(field: &str) -> String {
    ESCAPES.iter().rev().fold(field.to_owned(), |text, (c, code)| text.replace(code, c))
}

/// What would end a field, or a line. The first one escapes the others.
const ESCAPES: [(&str, &str); 4] = [("%", "%25"), ("\t", "%09"), ("\n", "%0A"), ("\r", "%0D")];

/// A text that may be none is not the same as one without letters.
fn some(text: Option<&str>) -> String {
    text.map(|text| format!("={text}")).unwrap_or_default()
}

fn of_some(text: &str) -> Option<String> {
    text.strip_prefix('=').map(str::to_owned)
}

#[cfg(test)]
mod tests {
    use std::rc::Rc;

    use cipdeck_shared::{
        code::{Dialect, import},
        config::BlockId,
    };
    use yew::Reducible;

    use super::{super::desk::Deed, *};

    const REQUEST: &str = "0E 03 20 01 24 01 30 07";

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
        let text: Rc<str> = REQUEST.into();
        let desk = done(
            Rc::default(),
            vec![
                Deed::Type(0, REQUEST.to_owned()),
                Deed::Choose(0, Some(Dialect::Hex)),
                Deed::Read(0, text.clone(), Some(Dialect::Hex), Rc::new(import(&text, Some(Dialect::Hex)))),
                Deed::Rename((0, 0), "mine".to_owned()),
                Deed::Became((0, 0), Outcome::Saved(BlockId(7))),
                Deed::Add("a\t%0A.st".to_owned(), "(* d\u{e9}bit\n100 %25\t*)".to_owned(), Encoding::Latin1),
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
                Deed::Type(0, REQUEST.to_owned()),
                Deed::Read(0, REQUEST.into(), None, Rc::new(import(REQUEST, None))),
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
        for text in ["", "{}", "0\t\n", "0\t\npick\tkept\t\t\n", "x\t\ntext\t\t\t\tx\n"] {
            assert_eq!(read(text), None, "{text}");
        }
        let beyond = read("9\t\ntext\t\t?\t?\tx\n").map(|desk| (desk.shown, desk.sources.len()));
        assert_eq!(beyond, Some((0, 1)));
    }
}
