//! What is missing in the history, and why: a gap must not look like silence.

use cipdeck_shared::api::{HistoryDropped, HistoryLoss};
use yew::prelude::*;

use crate::office::{i18n::tr, when};

/// A sentence per loss.
pub(super) fn dropped(all: &[HistoryDropped]) -> Html {
    if all.is_empty() {
        return html! {};
    }
    html! {
        <ul class="warning-text dropped" data-test="dropped">{ for all.iter().map(|it| html! { <li>{ words(it) }</li> }) }</ul>
    }
}

fn words(it: &HistoryDropped) -> String {
    let why = match it.why {
        HistoryLoss::Queue => tr!("dropped.queue"),
        HistoryLoss::Disk => tr!("dropped.disk"),
        HistoryLoss::Size => tr!("dropped.size"),
        HistoryLoss::Age => tr!("dropped.age"),
        HistoryLoss::Corrupt => tr!("dropped.corrupt"),
    };
    let runs = it.runs.map_or_else(
        || tr!("dropped.unknown").to_string(),
        |runs| tr!("dropped.runs", count = runs).to_string(),
    );
    let detail = it.detail.as_deref().unwrap_or_default();
    tr!("dropped.text", runs = runs, from = when(&it.from), to = when(&it.to), why = why, detail = detail)
        .to_string()
}
