//! How components learn of changes outside the virtual DOM.

use std::{cell::Cell, rc::Rc};

use cipdeck_shared::api::SessionView;
use gloo_timers::callback::Interval;
use yew::prelude::*;

use crate::{
    browser,
    desk::{Desk, Local},
    editor::{Draft, Editable},
    net::{Link, Relay, session},
    notice::Notice,
    store::{DeckId, Row, RowStore},
    workbench::Workbench,
};

/// The application, from the context.
#[hook]
pub fn use_workbench() -> Workbench {
    use_context::<Workbench>().expect("the page provides a Workbench")
}

/// One row; renders once in a frame in which it has changed.
#[hook]
pub fn use_row(id: DeckId) -> Option<Rc<Row>> {
    let bench = use_workbench();
    use_row_of(bench.rows(), id)
}

/// One row of this store.
#[hook]
pub fn use_row_of(store: &RowStore, id: DeckId) -> Option<Rc<Row>> {
    let update = use_force_update();
    use_effect_with((store.clone(), id), move |(store, id)| {
        let watch = store.watch(*id, Callback::from(move |()| update.force_update()));
        move || drop(watch)
    });
    store.row(id)
}

/// All entries; renders when one comes or goes.
#[hook]
pub fn use_ids() -> Rc<[DeckId]> {
    let store = use_workbench().rows().clone();
    let update = use_force_update();
    use_effect_with(store.clone(), move |store| {
        let watch = store.watch_ids(Callback::from(move |()| update.force_update()));
        move || drop(watch)
    });
    store.ids()
}

/// The draft of an entry, if it has one.
#[hook]
pub fn use_draft(id: DeckId) -> Option<Rc<Draft>> {
    let bench = use_workbench();
    use_draft_of(&bench, id)
}

/// The draft of an entry of this desk.
#[hook]
pub fn use_draft_of<D: Editable, L: Local>(desk: &Desk<D, L>, id: DeckId) -> Option<Rc<D>> {
    let update = use_force_update();
    use_effect_with((desk.clone(), id), move |(desk, id)| {
        let watch = desk.drafts().watch(*id, Callback::from(move |()| update.force_update()));
        move || drop(watch)
    });
    desk.drafts().draft(id)
}

/// The connection.
#[hook]
pub fn use_link() -> Link {
    let bench = use_workbench();
    use_link_of(bench.relay())
}

/// This connection.
#[hook]
pub fn use_link_of(relay: &Relay) -> Link {
    let update = use_force_update();
    use_effect_with(relay.clone(), move |relay| {
        let watch = relay.watch(Callback::from(move |()| update.force_update()));
        move || drop(watch)
    });
    relay.link()
}

/// Who is here, as the relay says; `None` before it has said anything.
#[hook]
pub fn use_session() -> Option<Rc<SessionView>> {
    let update = use_force_update();
    use_effect_with((), move |()| {
        let watch = session::watch(Callback::from(move |()| update.force_update()));
        move || drop(watch)
    });
    session::view()
}

/// What is to be told about an entry of this desk.
#[hook]
pub fn use_notice_of<D: Editable, L: Local>(desk: &Desk<D, L>, id: DeckId) -> Option<Notice> {
    let update = use_force_update();
    use_effect_with(desk.clone(), move |desk| {
        let watch = desk.notices().watch(Callback::from(move |()| update.force_update()));
        move || drop(watch)
    });
    desk.notices().notice(id)
}

/// The targets; renders when one looks different.
#[hook]
pub fn use_targets() {
    let bench = use_workbench();
    let update = use_force_update();
    use_effect_with(bench, move |bench| {
        let watch = bench.relay().targets().watch(Callback::from(move |()| update.force_update()));
        move || drop(watch)
    });
}

/// Renders four times a second at most while rows or targets change, and every second for their ages: for what looks at
/// all of them.
#[hook]
pub fn use_rows_now_and_then() {
    let bench = use_workbench();
    let update = use_force_update();
    use_effect_with(bench, move |bench| {
        let changed = Rc::new(Cell::new(0));
        let wake = Callback::from({
            let changed = changed.clone();
            move |()| changed.set(SECOND)
        });
        let watches = (bench.rows().watch_frames(wake.clone()), bench.relay().targets().watch(wake));
        let ticks = Interval::new(250, move || {
            changed.set(changed.get() + 1);
            if changed.get() >= SECOND {
                changed.set(0);
                update.force_update();
            }
        });
        move || drop((watches, ticks))
    });
}

/// Ticks of 250 ms.
const SECOND: u8 = 4;

/// Names the page in the browser's tab: `drive-current · cipdeck`.
#[hook]
pub fn use_title(page: &str) {
    use_effect_with(page.to_owned(), |page| {
        browser::set_title(&if page.is_empty() {
            "cipdeck".to_owned()
        } else {
            format!("{page} · cipdeck")
        });
    });
}

/// Renders every second while `running`: for ages.
#[hook]
pub fn use_second(running: bool) {
    let update = use_force_update();
    use_effect_with(running, move |running| {
        let ticks = running.then(|| Interval::new(1_000, move || update.force_update()));
        move || drop(ticks)
    });
}
