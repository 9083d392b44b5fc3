//! One quiet sentence about all blocks.

use cipdeck_shared::engine::Phase;
use yew::prelude::*;

use crate::{
    hooks::{use_ids, use_second, use_workbench},
    i18n::tr,
    store::{DeckId, RowStore},
};

/// `3 of 1,000 failing`: counted anew every second, and not read out each time.
#[component]
pub(super) fn Summary() -> Html {
    let bench = use_workbench();
    let ids = use_ids();
    use_second(!ids.is_empty());
    let (failing, busy) = count(bench.rows(), &ids);
    html! {
        <p class="summary" data-test="summary">
            { tr!("monitor.summary", all = ids.len(), failing = failing, busy = busy) }
        </p>
    }
}

fn count(rows: &RowStore, ids: &[DeckId]) -> (usize, usize) {
    let phases: Vec<_> = ids.iter().filter_map(|id| rows.row(*id)).map(|row| row.status.phase).collect();
    let of = |wanted: fn(Phase) -> bool| phases.iter().filter(|phase| wanted(**phase)).count();
    (of(|phase| phase == Phase::Failed), of(Phase::is_busy))
}
