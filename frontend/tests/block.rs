//! One block's page in a real browser, without a relay: the demo device answers in the page itself.
#![cfg(target_arch = "wasm32")]
#![allow(clippy::unwrap_used, reason = "a test may fail")]

mod page;

use std::rc::Rc;

use cipdeck_frontend::{
    browser,
    editor::DraftStore,
    net::Relay,
    pages::block::BlockPane,
    store::{DeckId, RowStore},
    workbench::Workbench,
};
use cipdeck_shared::{config::MsgCipGeneric, engine::Phase};
use page::{a_write, click, find, render, text, try_find, type_into};
use wasm_bindgen_test::{wasm_bindgen_test, wasm_bindgen_test_configure};
use web_sys::Element;
use yew::prelude::*;

wasm_bindgen_test_configure!(run_in_browser);

#[derive(Clone, PartialEq, Properties)]
struct DeskProps {
    bench: Workbench,
    id: DeckId,
}

#[component]
fn Desk(props: &DeskProps) -> Html {
    html! {
        <ContextProvider<Workbench> context={props.bench.clone()}>
            <BlockPane id={props.id} />
        </ContextProvider<Workbench>>
    }
}

/// The page of one block in a browser without a relay.
async fn desk(config: MsgCipGeneric) -> (Element, Workbench, DeckId) {
    let rows = RowStore::new(Rc::new(browser::before_next_frame));
    let relay = Relay::new(rows.clone(), Callback::noop());
    let bench = Workbench::new(rows, DraftStore::new(None, Rc::new(|_| ())), relay);
    let id = bench.add(config);
    let root = render::<Desk>(DeskProps { bench: bench.clone(), id }).await;
    (root, bench, id)
}

/// Waits until a frame has shown this phase.
async fn until(bench: &Workbench, id: DeckId, phase: Phase) {
    for _ in 0..600 {
        next_frame().await;
        yew::scheduler::flush().await;
        if bench.rows().row(id).is_some_and(|row| row.status.phase == phase) {
            next_frame().await;
            return yew::scheduler::flush().await;
        }
    }
    panic!("never {phase:?}: {:?}", bench.rows().row(id));
}

async fn next_frame() {
    let promise = js_sys::Promise::new(&mut |resolve, _| {
        web_sys::window().unwrap().request_animation_frame(&resolve).unwrap();
    });
    js_sys::futures::JsFuture::from(promise).await.unwrap();
}

fn is_disabled(root: &Element, selector: &str) -> bool {
    find(root, selector).has_attribute("disabled")
}

#[wasm_bindgen_test]
async fn a_read_runs_at_once_and_its_reply_is_decoded() {
    let (root, bench, id) = desk(MsgCipGeneric::product_name("0,0")).await;
    assert_eq!(text(&root, "[data-test=run]").trim(), "Run");
    click(&root, "[data-test=run]").await;
    until(&bench, id, Phase::Done).await;
    assert_eq!(text(&root, "[data-test=decoded-value]"), "cipdeck demo drive");
    assert_eq!(find(&root, "[data-bit=DN]").get_attribute("data-on").as_deref(), Some("true"));
    assert!(text(&root, "[data-test=reply-bytes]").contains("8E"));
}

#[wasm_bindgen_test]
async fn a_service_out_of_range_is_found_at_its_field_and_cannot_run() {
    let (root, ..) = desk(MsgCipGeneric::product_name("0,0")).await;
    type_into(&root, "#field-AppCfg-Service", "300").await;
    assert!(text(&root, "#field-AppCfg-Service-finding [role=alert]").contains("300 is outside 1 to 127"));
    assert!(is_disabled(&root, "[data-test=run]"));
    type_into(&root, "#field-AppCfg-Service", "1x").await;
    assert!(text(&root, "#field-AppCfg-Service-finding").contains("not a number"));
    type_into(&root, "#field-AppCfg-Service", "0x0E").await;
    assert!(try_find(&root, "#field-AppCfg-Service-finding").is_none());
    assert!(!is_disabled(&root, "[data-test=run]"));
}

#[wasm_bindgen_test]
async fn a_refusal_is_explained_in_words() {
    let mut config = MsgCipGeneric::product_name("0,0");
    config.app_cfg.class = 238;
    let (root, bench, id) = desk(config).await;
    click(&root, "[data-test=run]").await;
    until(&bench, id, Phase::Failed).await;
    assert!(text(&root, "[data-test=error-codes]").contains("ErrorID 224 · SubErrorID 5 (0x05)"));
    assert_eq!(text(&root, "[data-test=error-name]"), "Path destination unknown");
}

#[wasm_bindgen_test]
async fn a_write_is_sent_only_after_a_confirmation() {
    let (root, bench, id) = desk(a_write()).await;
    assert_eq!(text(&root, "[data-test=run]").trim(), "Write…");
    click(&root, "[data-test=run]").await;
    let dialog = find(&root, "[data-test=write-dialog]");
    assert!(dialog.has_attribute("open"));
    assert!(text(&root, "[data-test=write-bytes]").starts_with("10 03 20 04 24 96 30 03 01"));
    click(&root, "[data-test=write-cancel]").await;
    assert!(try_find(&root, "[data-test=write-dialog]").is_none());
    assert_eq!(bench.rows().row(id).unwrap().status.phase, Phase::Idle, "nothing was sent");
    click(&root, "[data-test=run]").await;
    click(&root, "[data-test=write-confirm]").await;
    until(&bench, id, Phase::Done).await;
}

#[wasm_bindgen_test]
async fn a_write_that_repeats_itself_is_asked_for_twice() {
    let mut config = a_write();
    config.ctrl_cfg.trigger_type = 100;
    let (root, bench, id) = desk(config).await;
    click(&root, "[data-test=in-switch]").await;
    click(&root, "[data-test=write-confirm]").await;
    assert!(text(&root, "[data-test=write-dialog]").contains("every 100 ms"));
    assert!(!bench.rows().row(id).unwrap().status.input, "confirmed once only");
    click(&root, "[data-test=write-confirm]").await;
    until(&bench, id, Phase::Done).await;
    assert_eq!(find(&root, "[data-test=in-switch]").get_attribute("aria-checked").as_deref(), Some("true"));
    click(&root, "[data-test=in-switch]").await;
    assert!(!bench.rows().row(id).unwrap().status.input, "switching off needs no question");
}

#[wasm_bindgen_test]
async fn without_a_relay_a_device_on_the_network_is_out_of_reach_and_says_so() {
    let (root, ..) = desk(MsgCipGeneric::product_name("4,192.168.1.100")).await;
    assert!(is_disabled(&root, "[data-test=run]"));
    assert!(text(&root, "[data-test=obstacle]").contains("relay"));
    assert!(text(&root, "[data-test=request-bytes]").contains("0E"), "its bytes are shown all the same");
}
