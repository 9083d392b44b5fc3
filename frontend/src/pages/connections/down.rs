//! Targets that do not answer: one message each, with their blocks under it.

use std::rc::Rc;

use cipdeck_shared::{api::TargetStatus, engine::Cause};
use yew::prelude::*;

use crate::{
    browser,
    hooks::{use_second, use_targets, use_workbench},
    i18n::{CAUSE, TRY, find, tr},
    kit::Shape,
    pages::block::age_words,
    route::{Route, link},
    store::{Row, RowStore, Shelf, target_of},
};

/// Nothing while everybody answers.
#[component]
pub(crate) fn Down() -> Html {
    let bench = use_workbench();
    use_targets();
    let down = bench.relay().targets().down();
    use_second(!down.is_empty());
    let blocks = if down.is_empty() { Shelf::default() } else { by_target(bench.rows()) };
    let of = |target: &String| blocks.get(target).map_or(&[][..], Vec::as_slice);
    down.iter().map(|target| notice(target, of(&target.target))).collect()
}

/// All entries by their targets, in one pass: there may be a thousand of fifty.
pub(super) fn by_target(rows: &RowStore) -> Shelf<String, Vec<Rc<Row>>> {
    let mut blocks: Shelf<String, Vec<Rc<Row>>> = Shelf::default();
    for row in rows.ids().iter().filter_map(|id| rows.row(*id)) {
        if let Some(target) = target_of(row.config.target_text()) {
            blocks.or_default(target).push(row);
        }
    }
    blocks
}

fn notice(status: &TargetStatus, blocks: &[Rc<Row>]) -> Html {
    let why = status.error.as_ref().map_or("", |error| error.what.word()).replace('_', " ");
    let since = status.since.as_deref().unwrap_or_default();
    let age = browser::age_s(since).map(age_words).unwrap_or_default();
    let text =
        tr!("down.text", why = why, time = browser::time_of_day(since), age = age, count = count(blocks));
    html! {
        <details key={status.target.clone()} class="down" data-test="down">
            <summary>
                <span class="state cross">{ Shape::Cross.draw() }</span>
                <b class="mono">{ &status.target }</b>{ " " }{ text }
            </summary>
            if let Some(error) = &status.error {
                <p>{ advice(error) }</p>
            }
            { names(blocks) }
        </details>
    }
}

/// `1 block`, `12 blocks`
pub(super) fn count(blocks: &[Rc<Row>]) -> AttrValue {
    match blocks.len() {
        1 => tr!("down.block"),
        count => tr!("down.blocks", count = count),
    }
}

/// What it means, and what to try.
pub(super) fn advice(error: &Cause) -> String {
    let word = error.what.word();
    let text = |kind| find(kind, word).unwrap_or_default();
    format!("{} {} {}", text(CAUSE), text(TRY), error.detail.as_deref().unwrap_or_default())
}

/// Links to blocks.
pub(super) fn names(blocks: &[Rc<Row>]) -> Html {
    let name =
        |row: &Rc<Row>| html! { <li>{ link(Route::Block(row.id), "", html! { row.config.name() }) }</li> };
    html! { <>
        <ul class="block-names">{ for blocks.iter().take(MOST).map(name) }</ul>
        if blocks.len() > MOST {
            <p class="quiet">{ tr!("connections.more", count = blocks.len() - MOST) }</p>
        }
    </> }
}

/// Names that are listed.
const MOST: usize = 200;
