//! One quiet sentence about all blocks.

use cipdeck_shared::engine::Phase;
use gloo_timers::callback::Interval;
use yew::prelude::*;

use crate::{hooks::use_workbench, i18n::tr, store::RowStore};

/// `3 of 1,000 failing`: counted anew every second, and not read out each time.
#[component]
pub(super) fn Summary() -> Html {
    let bench = use_workbench();
    let rows = bench.rows().clone();
    let counts = use_state_eq(|| count(&rows));
    use_effect_with(rows, {
        let counts = counts.clone();
        move |rows| {
            let rows = rows.clone();
            let ticks = Interval::new(1_000, move || counts.set(count(&rows)));
            move || drop(ticks)
        }
    });
    let (all, failing, busy) = *counts;
    html! {
        <p class="summary" data-test="summary">
            { tr!("monitor.summary", all = all, failing = failing, busy = busy) }
        </p>
    }
}

fn count(rows: &RowStore) -> (usize, usize, usize) {
    let ids = rows.ids();
    let phases: Vec<_> = ids.iter().filter_map(|id| rows.row(*id)).map(|row| row.status.phase).collect();
    let of = |wanted: fn(Phase) -> bool| phases.iter().filter(|phase| wanted(**phase)).count();
    (ids.len(), of(|phase| phase == Phase::Failed), of(Phase::is_busy))
}
