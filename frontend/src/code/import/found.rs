//! The right side: what was found.

use yew::prelude::*;

use super::{
    super::{i18n::tr, say},
    Entries,
    aim::aim,
    block::BlockCard,
    desk::{Deed, Desk},
    entry,
    remarks::rest,
    save::SaveBar,
};

/// Blocks that are drawn before somebody asks for all of them.
const FIRST_SHOWN: usize = 50;

#[derive(Clone, PartialEq, Properties)]
pub(super) struct FoundProps {
    pub(super) desk: UseReducerHandle<Desk>,
    pub(super) entries: Entries,
    pub(super) on_line: Callback<(u32, usize)>,
    pub(super) on_deed: Callback<Deed>,
    pub(super) on_saved: Callback<()>,
}

/// Blocks, what is said about the rest of the text, and Save.
#[component]
pub(super) fn Found(props: &FoundProps) -> Html {
    let whole = use_state(|| false);
    let (desk, entries) = (&props.desk, &props.entries);
    let is_reading = desk.sources.iter().any(|source| source.is_stale);
    let shown = if *whole { entries.len() } else { FIRST_SHOWN };
    let left = entries.len().saturating_sub(shown);
    let on_whole = {
        let whole = whole.setter();
        move |_: MouseEvent| whole.set(true)
    };
    let card = |entry: &std::rc::Rc<entry::Entry>| {
        let (key, number) = entry.place;
        html! {
            <BlockCard key={format!("{key}-{number}")} entry={entry.clone()} on_line={props.on_line.clone()} on_deed={props.on_deed.clone()} />
        }
    };
    html! {
        <section class="code-found" aria-label={tr!("found.title")}>
            { head(desk, entries, is_reading, &props.on_deed) }
            { aim(&desk.target, entries, &props.on_deed) }
            { rest(desk, &props.on_line) }
            if entries.is_empty() {
                { nothing(is_reading) }
            } else {
                <ul class="code-blocks">{ for entries.iter().take(shown).map(card) }</ul>
                if left > 0 {
                    <button type="button" class="button" onclick={on_whole}>{ tr!("found.show_more", count = entries.len()) }</button>
                }
            }
            if !entries.is_empty() {
                <SaveBar entries={entries.clone()} on_deed={props.on_deed.clone()} on_saved={props.on_saved.clone()} />
            }
        </section>
    }
}

fn head(desk: &Desk, entries: &Entries, is_reading: bool, on_deed: &Callback<Deed>) -> Html {
    let [errors, warnings, _] = entry::remarks(desk.sources.iter().filter_map(|it| it.imported.as_ref()));
    let mut parts = vec![say::blocks(entries.len())];
    if errors > 0 {
        parts.push(say::errors(errors));
    }
    if warnings > 0 {
        parts.push(say::warnings(warnings));
    }
    let words = if is_reading { tr!("found.reading").to_string() } else { parts.join(", ") };
    html! {
        <div class="code-found-head">
            <h2>{ tr!("found.title") }</h2>
            <p id="code-summary" role="status" data-test="summary">{ words }</p>
            <span class="spring" />
            if entries.len() > 1 {
                <button type="button" class="tool" onclick={on_deed.reform(|_: MouseEvent| Deed::KeepAll(true))}>{ tr!("found.all") }</button>
                <button type="button" class="tool" onclick={on_deed.reform(|_: MouseEvent| Deed::KeepAll(false))}>{ tr!("found.none") }</button>
            }
        </div>
    }
}

fn nothing(is_reading: bool) -> Html {
    if is_reading {
        return html! {};
    }
    html! {
        <div class="panel" data-test="no-block">
            <p><b>{ tr!("found.no_block") }</b></p>
            <p class="hint">{ tr!("found.no_block_hint") }</p>
        </div>
    }
}
