//! The left side: which text, in which dialect, and the text itself.

use std::rc::Rc;

use cipdeck_shared::{code::Dialect, plan::Severity};
use web_sys::{HtmlInputElement, HtmlSelectElement};
use yew::prelude::*;

use super::{
    super::{
        decode::{Encoding, MAX_FILE, NoText},
        i18n::tr,
        lines::Lines,
        say,
    },
    desk::{Deed, Desk, MAX_SOURCES, Refusal, Source},
    editor::{CodeEditor, Mark, Wish},
    files,
    kept::Keeping,
};
use crate::invisible::{self, Invisible};

#[derive(Clone, PartialEq, Properties)]
pub(super) struct IntakeProps {
    pub(super) desk: UseReducerHandle<Desk>,
    pub(super) wish: Wish,
    pub(super) keeping: Keeping,
    pub(super) on_deed: Callback<Deed>,
}

/// The text that is shown, and what chooses it.
#[component]
pub(super) fn Intake(props: &IntakeProps) -> Html {
    let Some(source) = props.desk.source().cloned() else { return html! {} };
    let lines = use_memo((source.text.clone(), source.imported.clone(), source.dialect), |(text, _, _)| {
        Lines::of(text, &parts(&source))
    });
    let marks: Rc<[Mark]> = (*use_memo(source.imported.clone(), |_| marks(&source))).clone().into();
    let unseen = *use_memo(source.text.clone(), |text| Invisible::first_of(text));
    let key = source.key;
    let on_text = props.on_deed.reform(move |text| Deed::Type(key, text));
    html! {
        <section class="code-intake" aria-label={tr!("intake.sources")}>
            { tools(&source, &props.on_deed) }
            { tabs(&props.desk, &props.on_deed) }
            { for props.desk.refused.iter().map(|(name, why)| refused(name, *why)) }
            { encoding(source.encoding) }
            if let Some(first) = unseen.filter(|_| marks.iter().any(|mark| mark.severity == Severity::Error)) {
                { unseen_note(&source, first, &props.on_deed) }
            }
            <CodeEditor key={key} text={source.text.clone()} {lines} {marks} wish={props.wish} {on_text} />
            { kept_note(props.keeping) }
        </section>
    }
}

/// Says what nobody sees where something is not understood, and offers to take it out.
fn unseen_note(source: &Source, first: Invisible, on_deed: &Callback<Deed>) -> Html {
    let (key, text) = (source.key, source.text.clone());
    let onclick = on_deed.reform(move |_: MouseEvent| Deed::Type(key, invisible::without(&text)));
    let count = invisible::count(&source.text);
    html! {
        <p class="warning-text" role="status" data-test="unseen">
            if count == 1 {
                { tr!("intake.unseen_one", line = first.line, name = first.name()) }
            } else {
                { tr!("intake.unseen", count = count, line = first.line, name = first.name()) }
            }
            { " " }
            <button type="button" class="tool" {onclick} data-test="take-out">{ tr!("intake.take_out") }</button>
        </p>
    }
}

fn kept_note(keeping: Keeping) -> Html {
    match keeping {
        Keeping::Nothing => html! {},
        Keeping::All => html! { <p class="hint" data-test="kept">{ tr!("intake.kept") }</p> },
        Keeping::NotKept => {
            html! { <p class="finding warning" role="status" data-test="not-kept">{ tr!("intake.not_kept") }</p> }
        }
    }
}

fn tools(source: &Source, on_deed: &Callback<Deed>) -> Html {
    let key = source.key;
    let on_dialect = on_deed.reform(move |event: Event| {
        let value = event.target_unchecked_into::<HtmlSelectElement>().value();
        Deed::Choose(key, value.parse().ok())
    });
    let on_files = {
        let on_deed = on_deed.clone();
        move |event: Event| {
            let input = event.target_unchecked_into::<HtmlInputElement>();
            if let Some(files) = input.files() {
                files::take(&files, &on_deed);
            }
            // The same file may be chosen again.
            input.set_value("");
        }
    };
    let on_clear = on_deed.reform(move |_: MouseEvent| Deed::Remove(key));
    let option = |dialect: &Dialect| {
        let selected = source.dialect == Some(*dialect);
        html! { <option value={dialect.name()} {selected}>{ say::dialect(*dialect) }</option> }
    };
    html! {
        <div class="code-tools">
            <label for="code-dialect">{ tr!("intake.dialect") }</label>
            <select id="code-dialect" class="input" onchange={on_dialect}>
                <option value="" selected={source.dialect.is_none()}>{ tr!("intake.recognised") }</option>
                { for say::groups().into_iter().map(|(vendor, dialects)| html! {
                    <optgroup label={vendor}>{ for dialects.iter().map(option) }</optgroup>
                }) }
            </select>
            <span class="spring" />
            <input id="code-files" class="unseen" type="file" multiple=true onchange={on_files} data-test="code-files" />
            <label for="code-files" class="button file-button">{ tr!("intake.files") }</label>
            <button type="button" class="button" disabled={source.is_empty()} onclick={on_clear} data-test="clear">{ tr!("intake.clear") }</button>
        </div>
    }
}

/// Only where there is a choice, or a name to tell.
fn tabs(desk: &Desk, on_deed: &Callback<Deed>) -> Html {
    if let [only] = &*desk.sources
        && only.file.is_none()
    {
        return html! {};
    }
    let tab = |(index, source): (usize, &Source)| {
        let (key, is_here) = (source.key, index == desk.shown);
        let name = source.file.clone().map_or_else(|| tr!("intake.pasted"), AttrValue::from);
        let errors = source.imported.as_ref().map_or(0, |it| it.remarks.len());
        html! {
            <li key={key} class={classes!("code-tab", is_here.then_some("here"))}>
                <button type="button" aria-current={is_here.then_some("true")} onclick={on_deed.reform(move |_: MouseEvent| Deed::Show(key))} data-test="tab">
                    { name.clone() }
                    <span class="quiet">{ counts(source.picks.len(), errors) }</span>
                </button>
                <button type="button" class="tool" aria-label={tr!("intake.remove", name = name)} onclick={on_deed.reform(move |_: MouseEvent| Deed::Remove(key))}>{ "×" }</button>
            </li>
        }
    };
    html! { <ul class="code-tabs" aria-label={tr!("intake.sources")}>{ for desk.sources.iter().enumerate().map(tab) }</ul> }
}

/// ` 3`, ` 3 !2`
fn counts(blocks: usize, remarks: usize) -> String {
    if remarks == 0 { format!(" {blocks}") } else { format!(" {blocks} !{remarks}") }
}

fn refused(name: &str, why: Refusal) -> Html {
    let why = match why {
        Refusal::NoText(NoText::Empty) => tr!("intake.no_text_empty"),
        Refusal::NoText(NoText::TooBig(bytes)) => {
            tr!("intake.no_text_too_big", bytes = bytes, limit = MAX_FILE)
        }
        Refusal::NoText(NoText::Binary) => tr!("intake.no_text_binary"),
        Refusal::Unreadable => tr!("intake.unreadable"),
        Refusal::TooMany => tr!("intake.too_many", count = MAX_SOURCES),
    };
    html! { <p class="finding error" role="alert" data-test="file-refused">{ tr!("intake.refused", name = name, why = why) }</p> }
}

fn encoding(encoding: Encoding) -> Html {
    match encoding {
        Encoding::Utf8 => html! {},
        Encoding::Utf16 => html! { <p class="hint">{ tr!("intake.utf16") }</p> },
        Encoding::Latin1 => {
            html! { <p class="finding warning" data-test="latin1">{ tr!("intake.latin1") }</p> }
        }
    }
}

/// Which lines are in which dialect: what was found, or what was chosen.
fn parts(source: &Source) -> Vec<(core::ops::Range<usize>, Dialect)> {
    let found = source.imported.iter().flat_map(|imported| &imported.blocks);
    let found: Vec<_> = found.map(|found| (found.lines.clone(), found.dialect)).collect();
    match (source.dialect, &*found) {
        (Some(dialect), _) => vec![(1..usize::MAX, dialect)],
        // One dialect alone: what is around its messages is in it as well.
        (None, [(_, first), rest @ ..]) if rest.iter().all(|(_, dialect)| dialect == first) => {
            vec![(1..usize::MAX, *first)]
        }
        (None, _) => found,
    }
}

/// The worst that is said about each line.
fn marks(source: &Source) -> Vec<Mark> {
    let Some(imported) = &source.imported else { return Vec::new() };
    let of_blocks = imported.blocks.iter().flat_map(|found| &found.remarks);
    let all = imported.remarks.iter().chain(of_blocks);
    let mut marks: Vec<_> = all
        .filter(|remark| remark.severity != Severity::Note)
        .map(|remark| Mark { line: remark.line, severity: remark.severity })
        .collect();
    marks.sort_by_key(|mark| (mark.line, mark.severity));
    marks.dedup_by_key(|mark| mark.line);
    marks
}
