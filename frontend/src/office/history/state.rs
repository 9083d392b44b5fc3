//! Whether runs are kept, how many, and for how long.

use cipdeck_shared::api::HistoryState;
use yew::prelude::*;

use crate::office::{fetch::use_fetched, i18n::tr, kit::waiting, when};

/// One sentence.
#[component]
pub(super) fn HistoryKept() -> Html {
    let state = use_fetched::<HistoryState>("history/state".to_owned());
    let Some(kept) = &state.data else { return waiting(&state) };
    if !kept.enabled {
        return html! { <p class="warning-text">{ tr!("history.off") }</p> };
    }
    let since = kept
        .oldest
        .as_deref()
        .map_or_else(String::new, |oldest| tr!("history.since", time = when(oldest)).to_string());
    html! { <>
        if let Some(problem) = &kept.problem {
            <p class="warning-text" role="alert">{ tr!("history.problem", why = problem) }</p>
        }
        <p class="hint" data-test="history-state">
            { tr!("history.kept", runs = kept.runs, since = since, megabytes = kept.bytes / 1_000_000, max_mb = kept.max_mb, days = kept.max_days) }
        </p>
    </> }
}
