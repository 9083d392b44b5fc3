//! All blocks, live, in a windowed table.

mod row;
mod summary;

use std::rc::Rc;

use web_sys::HtmlInputElement;
use yew::prelude::*;

use self::{row::MonitorRow, summary::Summary};
use crate::{
    browser,
    hooks::{use_ids, use_targets, use_title, use_workbench},
    i18n::tr,
    kit::WindowTable,
    pages::{connection::StaleNote, connections::down::Down},
    store::{DeckId, RowStore},
};

/// Height of a row in px; `pages.css` says the same.
const ROW_HEIGHT: u32 = 32;

/// Filter, summary, table.
#[component]
pub fn MonitorPage() -> Html {
    let bench = use_workbench();
    let ids = use_ids();
    use_title(&tr!("monitor.title"));
    let filter = use_state(String::new);
    let oninput = use_callback(filter.clone(), |event: InputEvent, filter| {
        filter.set(event.target_unchecked_into::<HtmlInputElement>().value());
    });
    let shown = use_memo((ids, (*filter).clone()), {
        let rows = bench.rows().clone();
        move |(ids, filter)| found(&rows, ids, filter)
    });
    use_targets();
    let down = bench.relay().targets().down();
    let down: Rc<[AttrValue]> = down.iter().map(|target| target.target.clone().into()).collect();
    let row = use_callback(down, |(index, id): (usize, DeckId), down| {
        html! { <MonitorRow key={id.to_string()} {index} {id} down={down.clone()} /> }
    });
    let heading = |class: &'static str, words: AttrValue| html! { <th scope="col" {class}>{ words }</th> };
    let header = html! { <>
        { heading("col-state", tr!("monitor.state")) }
        { heading("col-name", tr!("monitor.name")) }
        { heading("col-target", tr!("monitor.target")) }
        { heading("col-value", tr!("monitor.value")) }
        { heading("col-age", tr!("monitor.age")) }
        { heading("col-runs", tr!("monitor.runs")) }
        { heading("col-reply", tr!("monitor.reply")) }
        { heading("col-error", tr!("monitor.error")) }
    </> };
    html! {
        <section class="monitor">
            <div class="monitor-head">
                <h1>{ tr!("monitor.title") }</h1>
                <Summary />
                <input
                    class="input filter" type="search" placeholder={tr!("list.filter")} aria-label={tr!("list.filter")}
                    value={(*filter).clone()} {oninput} data-test="monitor-filter"
                />
            </div>
            <StaleNote />
            <Down />
            if shown.is_empty() {
                <p class="empty">{ tr!("monitor.empty") }</p>
            } else {
                <WindowTable<DeckId> label={tr!("monitor.label")} ids={(*shown).clone()} row_height={ROW_HEIGHT} {header} {row} />
            }
        </section>
    }
}

/// Entries whose name or target contains the text.
fn found(rows: &RowStore, ids: &Rc<[DeckId]>, filter: &str) -> Rc<[DeckId]> {
    if filter.trim().is_empty() {
        return ids.clone();
    }
    let is_found = |id: &DeckId| {
        rows.row(*id)
            .is_some_and(|row| browser::is_found(filter, [row.config.name(), row.config.target_text()]))
    };
    ids.iter().copied().filter(is_found).collect()
}
