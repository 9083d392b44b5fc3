//! Who is here and whether something may be written, in a real browser.
#![cfg(target_arch = "wasm32")]
#![allow(clippy::unwrap_used, reason = "a test may fail")]

mod page;

use cipdeck_frontend::{
    access::{who, write_banner},
    net::{Writing, session},
    office::Office,
};
use cipdeck_shared::api::{ActorKind, Caller, Role, SessionState, SessionView, WindowView, WriteState};
use page::{click, render, text, try_find, type_into};
use wasm_bindgen_test::{wasm_bindgen_test, wasm_bindgen_test_configure};
use web_sys::Element;
use yew::prelude::*;

wasm_bindgen_test_configure!(run_in_browser);

fn caller(kind: ActorKind, role: Role) -> SessionView {
    let csrf = (kind != ActorKind::Local).then(|| "secret".to_owned());
    let caller = Caller { name: "anna".to_owned(), kind, role, csrf, ends_at: None, idle_minutes: None };
    SessionView { state: SessionState::SignedIn, caller: Some(caller), fingerprint: None, moves_to: None }
}

#[derive(Clone, PartialEq, Properties)]
struct HeaderProps {
    view: SessionView,
    left_ms: u64,
    #[prop_or_default]
    read_only: bool,
}

/// What both documents have above their pages.
#[component]
fn Header(props: &HeaderProps) -> Html {
    let window = WindowView {
        owner: "otto".to_owned(),
        opened_at: "2026-11-22T10:00:00Z".to_owned(),
        ends_at: String::new(),
        left_ms: props.left_ms,
    };
    let window = (props.left_ms > 0).then_some(window);
    let state = WriteState { window, read_only: props.read_only, stopped: None };
    session::put(props.view.clone());
    html! { <>
        { who(Some(&props.view), props.read_only) }
        { write_banner(&Writing::heard(state)) }
    </> }
}

async fn header(view: SessionView, left_ms: u64, read_only: bool) -> Element {
    render::<Header>(HeaderProps { view, left_ms, read_only }).await
}

#[wasm_bindgen_test]
async fn an_open_window_is_seen_by_everybody_and_closed_by_persons() {
    let root = header(caller(ActorKind::Person, Role::Viewer), 899_000, false).await;
    let banner = text(&root, "[data-test=write-banner]");
    assert!(banner.contains("Opened by otto") && banner.contains("14:59 left"), "{banner}");
    assert!(try_find(&root, "[data-test=window-close]").is_some(), "also a viewer may stop writing");
    let root = header(caller(ActorKind::ViewLink, Role::Viewer), 899_000, false).await;
    assert!(try_find(&root, "[data-test=write-banner]").is_some());
    assert!(try_find(&root, "[data-test=window-close]").is_none(), "a tablet on a wall closes nothing");
    let root = header(caller(ActorKind::Person, Role::Engineer), 0, false).await;
    assert!(try_find(&root, "[data-test=write-banner]").is_none());
}

#[wasm_bindgen_test]
async fn the_header_says_who_is_here_and_how() {
    let root = header(caller(ActorKind::Person, Role::Admin), 0, true).await;
    assert!(text(&root, "[data-test=who]").contains("anna, administrator"));
    assert!(try_find(&root, "[data-test=read-only]").is_some());
    assert!(try_find(&root, "[data-test=sign-out]").is_some());
    let root = header(caller(ActorKind::Local, Role::Engineer), 0, false).await;
    assert!(text(&root, "[data-test=who]").contains("local access, no log-in"));
    assert!(try_find(&root, "[data-test=sign-out]").is_none(), "there is nothing to sign out of");
}

#[wasm_bindgen_test]
async fn what_a_role_may_is_known_before_somebody_tries() {
    session::put(caller(ActorKind::Person, Role::Viewer));
    assert!(!session::may(Role::may_send) && session::is_person());
    session::put(caller(ActorKind::Local, Role::Engineer));
    assert!(session::may(Role::may_write) && session::is_person());
    session::lost();
    assert_eq!(session::view().unwrap().state, SessionState::SignedOut);
    assert!(session::csrf().is_none(), "the proof is forgotten with the session");
}

#[wasm_bindgen_test]
async fn set_up_says_at_each_field_what_is_wrong_before_anything_is_sent() {
    let history = web_sys::window().unwrap().history().unwrap();
    history.replace_state_with_url(&wasm_bindgen::JsValue::NULL, "", Some("/office/set-up")).unwrap();
    session::put(SessionView { state: SessionState::SetUp, caller: None, fingerprint: None, moves_to: None });
    let root = render::<Office>(()).await;
    type_into(&root, "#code", "7H2K-9PQX").await;
    type_into(&root, "#name", "Anna").await;
    type_into(&root, "#password", "short").await;
    click(&root, "[data-test=set-up]").await;
    assert!(text(&root, "#code-said").contains("12 characters; here are 8"));
    assert!(text(&root, "#name-said").contains("only a-z"));
    assert!(text(&root, "#password-said").contains("7 more"));
}
