//! The browser's address, and how to get to another one of the same document.

use wasm_bindgen::{JsCast, JsValue, closure::Closure};
use web_sys::{History, Location};
use yew::prelude::*;

use crate::store::Watchers;

// The address is the browser's: there is one per document, whoever asks.
thread_local! {
    static WATCHERS: Watchers = Watchers::default();
}

/// The pages of a document: each has an address.
pub trait Pages: Copy + PartialEq + 'static {
    /// The page of a path.
    fn read(path: &str) -> Self;

    /// The path of a page.
    fn path(self) -> String;
}

/// Goes to another page of this document.
pub fn go(to: impl Pages) {
    push(&to.path());
}

fn push(to: &str) {
    if let Some(history) = history() {
        // Refused only for an address of another server.
        let _ = history.push_state_with_url(&JsValue::NULL, "", Some(to));
    }
    wake();
}

/// Replaces this address: the back button does not lead here again.
pub fn replace(to: &str) {
    if let Some(history) = history() {
        let _ = history.replace_state_with_url(&JsValue::NULL, "", Some(to));
    }
    wake();
}

/// Loads an address anew: another document, or this one with another person in front of it.
pub fn load(to: &str) {
    if let Some(location) = location() {
        // Refused only for an address that is none.
        let _ = location.assign(to);
    }
}

/// The path, without what is behind a question mark.
pub fn path() -> String {
    location().and_then(|location| location.pathname().ok()).unwrap_or_default()
}

/// What is behind the question mark, with it.
pub fn query() -> String {
    location().and_then(|location| location.search().ok()).unwrap_or_default()
}

/// Listens to the browser's own buttons.
pub fn listen() {
    let moved = Closure::<dyn Fn()>::new(wake);
    if let Some(window) = web_sys::window() {
        window.set_onpopstate(Some(moved.as_ref().unchecked_ref()));
    }
    // Lives as long as the page.
    moved.forget();
}

/// The path; renders again when it changes.
#[hook]
pub fn use_path() -> String {
    let update = use_force_update();
    use_effect_with((), move |()| {
        let wake = Callback::from(move |()| update.force_update());
        let watch = WATCHERS.with(|watchers| watchers.watch(wake));
        move || drop(watch)
    });
    path()
}

/// Where we are; renders again when that changes.
#[hook]
pub fn use_page<P: Pages>() -> P {
    P::read(&use_path())
}

#[derive(Clone, PartialEq, Properties)]
struct RedirectProps {
    to: String,
}

/// Shows nothing, and another page instead of this one: the back button does not lead here again.
pub fn redirect(to: impl Pages) -> Html {
    html! { <Redirect to={to.path()} /> }
}

#[component]
fn Redirect(props: &RedirectProps) -> Html {
    use_effect_with(props.to.clone(), |to| replace(to));
    html! {}
}

/// A link to a page of this document.
pub fn link(to: impl Pages, class: &'static str, words: Html) -> Html {
    let to = to.path();
    let onclick = {
        let to = to.clone();
        move |event: MouseEvent| {
            // With a key held, people want what the browser does: a new tab, a download.
            let plain = event.button() == 0
                && !(event.ctrl_key() || event.meta_key() || event.shift_key() || event.alt_key());
            if plain {
                event.prevent_default();
                push(&to);
            }
        }
    };
    html! { <a href={to} {class} {onclick}>{ words }</a> }
}

fn location() -> Option<Location> {
    Some(web_sys::window()?.location())
}

fn history() -> Option<History> {
    web_sys::window()?.history().ok()
}

fn wake() {
    WATCHERS.with(Clone::clone).wake();
}
