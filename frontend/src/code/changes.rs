//! What a conversion changes: the table of it, the worst first, and what is said loudly above it.

use std::cmp::Reverse;

use cipdeck_shared::code::{Change, Grade};
use yew::prelude::*;

use super::{i18n::tr, say};

/// The whole of it. What is only told in other words is folded away.
pub(super) fn changes(changes: &[Change]) -> Html {
    let mut losses: Vec<_> = changes.iter().filter(|change| change.is_loss()).collect();
    losses.sort_by_key(|change| Reverse(change.grade));
    let carried: Vec<_> = changes.iter().filter(|change| !change.is_loss()).collect();
    let count = |grade: Grade| losses.iter().filter(|change| change.grade == grade).count();
    let (requests, lost) = (count(Grade::Request), count(Grade::Lost));
    html! { <>
        if requests > 0 {
            <p class="code-loud" role="alert" data-test="request-changes">{ if requests == 1 { tr!("changes.request_alert_one") } else { tr!("changes.request_alert", count = requests) } }</p>
        }
        if lost > 0 {
            <p class="warning-text" data-test="lost">{ tr!("changes.lost_alert", count = lost) }</p>
        }
        if losses.is_empty() {
            <p class="code-all" data-test="all-carried">{ tr!("changes.all_carried") }</p>
        } else {
            { table(&losses) }
        }
        if !carried.is_empty() {
            <details>
                <summary>{ if carried.len() == 1 { tr!("changes.carried_one") } else { tr!("changes.carried_more", count = carried.len()) } }</summary>
                { table(&carried) }
            </details>
        }
    </> }
}

fn table(changes: &[&Change]) -> Html {
    html! {
        <div class="scroll"><table class="listing code-changes" aria-label={tr!("changes.title")} data-test="changes">
            <thead><tr>
                <th scope="col">{ tr!("changes.what") }</th><th scope="col">{ tr!("changes.member") }</th>
                <th scope="col">{ tr!("changes.from") }</th><th scope="col">{ tr!("changes.to") }</th><th scope="col">{ tr!("changes.why") }</th>
            </tr></thead>
            <tbody>{ for changes.iter().map(|change| line(change)) }</tbody>
        </table></div>
    }
}

fn line(change: &Change) -> Html {
    let (word, shape, class) = say::grade(change.grade);
    html! {
        <tr data-test="change" data-grade={change.grade.name()}>
            <td><span class={classes!("state", class)}>{ shape.draw() }<span>{ word }</span></span></td>
            <th scope="row" class="mono">{ &change.member }</th>
            <td class="mono">{ value(&change.from) }</td>
            <td class="mono">{ value(&change.to) }</td>
            <td>{ change.why.to_string() }</td>
        </tr>
    }
}

fn value(text: &str) -> Html {
    if text.is_empty() {
        html! { <span class="quiet">{ tr!("changes.nothing") }</span> }
    } else {
        html! { { text.to_owned() } }
    }
}
