//! A block that was found.

use std::rc::Rc;

use cipdeck_shared::{
    code::Kind,
    config::Target,
    plan::{Finding, Severity},
};
use web_sys::HtmlInputElement;
use yew::prelude::*;

use super::{
    super::{facts, i18n::tr, say},
    desk::{Deed, Outcome},
    entry::{Double, Entry},
    remarks::{said, to_line},
};
use crate::{editor::Remark, invisible, office::kit::problem_note};

#[derive(Clone, PartialEq, Properties)]
pub(super) struct BlockCardProps {
    pub(super) entry: Rc<Entry>,
    pub(super) on_line: Callback<(u32, usize)>,
    pub(super) on_deed: Callback<Deed>,
}

/// What it is, what it sends, what is wrong with it, what became of it.
#[component]
pub(super) fn BlockCard(props: &BlockCardProps) -> Html {
    let entry = &*props.entry;
    let (key, _) = entry.place;
    let on_line = props.on_line.reform(move |line| (key, line));
    let is_wrong = entry.has_errors();
    let class = classes!(
        "code-block",
        is_wrong.then_some("wrong"),
        (!entry.pick.kept).then_some("left-out"),
        entry.pick.is_saved().then_some("saved"),
    );
    html! {
        <li {class} data-test="found" data-name={entry.config.name().to_owned()}>
            { head(entry, &props.on_deed, &on_line) }
            { what(entry) }
            { double(entry) }
            { findings(entry) }
            { for entry.found.remarks.iter().map(|remark| said(remark, &on_line)) }
            { outcome(entry) }
        </li>
    }
}

fn head(entry: &Entry, on_deed: &Callback<Deed>, on_line: &Callback<usize>) -> Html {
    let place = entry.place;
    let name = entry.config.name().to_owned();
    let onchange = on_deed.reform(move |event: Event| {
        Deed::Keep(place, event.target_unchecked_into::<HtmlInputElement>().checked())
    });
    let oninput = on_deed.reform(move |event: InputEvent| {
        Deed::Rename(place, event.target_unchecked_into::<HtmlInputElement>().value())
    });
    let lines = &entry.found.lines;
    let is_saved = entry.pick.is_saved();
    html! {
        <div class="code-block-head">
            <input
                type="checkbox" class="check" checked={entry.pick.kept} disabled={is_saved} {onchange}
                aria-label={tr!("found.keep", name = name)} data-test="keep"
            />
            <input
                class="input code-name" value={name} disabled={is_saved} {oninput} autocomplete="off" spellcheck="false"
                aria-label={tr!("found.name_of", line = lines.start)} data-test="name"
            />
            <span class="pill" data-test="kind">{ Kind::of(&entry.config).to_string() }</span>
            <span class="quiet">{ say::dialect(entry.found.dialect) }</span>
            <span class="spring" />
            { to_line(lines, entry.file.as_deref(), on_line) }
        </div>
    }
}

fn what(entry: &Entry) -> Html {
    let target = match &entry.plan {
        Some(plan) if *plan.target() == Target::BuiltIn && entry.is_without_target => tr!("found.no_target"),
        _ => invisible::shown(entry.config.target_text()).into(),
    };
    html! {
        <dl class="facts">
            <dt>{ tr!("found.target") }</dt><dd class="mono" data-test="target">{ target }</dd>
            if let Some(plan) = &entry.plan {
                <dt>{ tr!("found.request") }</dt>
                <dd>
                    { facts::in_words(plan) }<br />
                    <span class="mono quiet" data-test="request">{ facts::hex(plan.bytes()) }</span>
                </dd>
            }
        </dl>
    }
}

fn double(entry: &Entry) -> Html {
    let words = match entry.double {
        None => return html! {},
        Some(Double::InDeck) => tr!("found.in_deck"),
        Some(Double::Here) => tr!("found.here"),
    };
    html! { <p class="finding warning" data-test="double">{ words }</p> }
}

fn findings(entry: &Entry) -> Html {
    let line = |finding: &Finding| {
        let remark = Remark::from_rule(finding);
        let class = match finding.severity {
            Severity::Error => "error",
            Severity::Warning => "warning",
            Severity::Note => "note",
        };
        html! { <li class={classes!("finding", class)}><span class="finding-word">{ remark.field }</span>{ remark.text }</li> }
    };
    let (errors, others): (Vec<_>, Vec<_>) =
        entry.findings.iter().partition(|finding| finding.severity == Severity::Error);
    html! { <>
        if !errors.is_empty() {
            <div class="code-wrong" role="alert" data-test="wrong">
                <p><b>{ tr!("found.wrong") }</b></p>
                <ul>{ for errors.into_iter().map(line) }</ul>
                <p class="hint">{ if entry.is_without_target { tr!("found.correct_in_or_device") } else { tr!("found.correct_in") } }</p>
            </div>
        }
        if !others.is_empty() {
            <ul>{ for others.into_iter().map(line) }</ul>
        }
    </> }
}

fn outcome(entry: &Entry) -> Html {
    match &entry.pick.outcome {
        Outcome::Open => html! {},
        Outcome::Saving => html! { <p class="hint" role="status">{ tr!("found.saving") }</p> },
        Outcome::Saved(id) => html! {
            <p class="code-saved" role="status" data-test="saved">
                { tr!("found.saved", id = id) }{ " " }
                <a href={facts::place(Kind::of(&entry.config), *id)}>{ tr!("found.open") }</a>{ " " }
                <a href={format!("/code/{id}")}>{ tr!("found.as_code") }</a>
            </p>
        },
        Outcome::Refused(problem) => html! {
            <div class="code-wrong" data-test="refused">
                // Without an answer nobody knows what became of it.
                <p><b>{ if problem.status == 0 { tr!("found.unanswered") } else { tr!("found.refused") } }</b></p>
                { problem_note(Some(problem)) }
                { for problem.findings.iter().flatten().map(|finding| {
                    let remark = Remark::from_relay(finding);
                    html! { <p class="finding error"><span class="finding-word">{ remark.field }</span>{ remark.text }</p> }
                }) }
            </div>
        },
    }
}
