//! Rows in a real browser: one render per frame, and only of the row that has changed.
#![cfg(target_arch = "wasm32")]
#![allow(clippy::unwrap_used, reason = "a test may fail")]

mod page;

use std::{
    cell::{Cell, RefCell},
    rc::Rc,
};

use cipdeck_frontend::{
    editor::DraftStore,
    hooks::use_row,
    net::Relay,
    store::{DeckId, RowStore},
    workbench::Workbench,
};
use cipdeck_shared::config::{Block, BlockId, MsgCipGeneric};
use page::{render, text};
use wasm_bindgen_test::{wasm_bindgen_test, wasm_bindgen_test_configure};
use yew::prelude::*;

wasm_bindgen_test_configure!(run_in_browser);

#[derive(Clone, PartialEq, Properties)]
struct LineProps {
    id: DeckId,
    renders: Renders,
}

/// Counts how often a line was rendered.
#[derive(Clone)]
struct Renders(Rc<Cell<usize>>);

impl PartialEq for Renders {
    fn eq(&self, other: &Self) -> bool {
        Rc::ptr_eq(&self.0, &other.0)
    }
}

#[component]
fn Line(props: &LineProps) -> Html {
    props.renders.0.set(props.renders.0.get() + 1);
    let runs = use_row(props.id).map_or(0, |row| row.status.runs);
    html! { <p id={props.id.to_string()}>{ runs }</p> }
}

#[derive(Clone, PartialEq, Properties)]
struct LinesProps {
    bench: Workbench,
    renders: Vec<Renders>,
}

#[component]
fn Lines(props: &LinesProps) -> Html {
    html! {
        <ContextProvider<Workbench> context={props.bench.clone()}>
            { for (1..).zip(&props.renders).map(|(number, renders)| html! {
                <Line key={number} id={DeckId::Stored(BlockId(number))} renders={renders.clone()} />
            }) }
        </ContextProvider<Workbench>>
    }
}

#[wasm_bindgen_test]
async fn three_changes_in_one_frame_render_one_row_once_and_the_other_never() {
    let asked = Rc::new(RefCell::new(Vec::<Box<dyn FnOnce()>>::new()));
    let ask = asked.clone();
    let rows = RowStore::new(Rc::new(move |flush| ask.borrow_mut().push(flush)));
    let block = |number| Block {
        id: BlockId(number),
        revision: 1,
        config: MsgCipGeneric::product_name("0,0").into(),
    };
    rows.snapshot(vec![block(1), block(2)], vec![]);
    let (relay, drafts) =
        (Relay::new(rows.clone(), Callback::noop()), DraftStore::new(None, Rc::new(|_| ())));
    let bench = Workbench::new(rows.clone(), drafts, relay);
    let renders = vec![Renders(Rc::default()), Renders(Rc::default())];
    let root = render::<Lines>(LinesProps { bench, renders: renders.clone() }).await;
    for flush in asked.take() {
        flush();
    }
    yew::scheduler::flush().await;
    let before: Vec<_> = renders.iter().map(|renders| renders.0.get()).collect();

    for runs in 1..=3 {
        let mut status = (*rows.row(DeckId::Stored(BlockId(1))).unwrap().status).clone();
        status.runs = runs;
        rows.changes(vec![status], vec![], &[]);
    }
    yew::scheduler::flush().await;
    assert_eq!(text(&root, "#b1"), "0", "nothing is drawn before the frame");
    for flush in asked.take() {
        flush();
    }
    yew::scheduler::flush().await;

    assert_eq!(text(&root, "#b1"), "3");
    let after: Vec<_> = renders.iter().map(|renders| renders.0.get()).collect();
    assert_eq!(after, [before[0] + 1, before[1]]);
}
