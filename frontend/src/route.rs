//! The addresses of the pages, and how to get there.
//!
//! A hundred lines instead of yew-router, which cost 28 kB of a page that may have 400 (gzipped).

use wasm_bindgen::{JsCast, JsValue, closure::Closure};
use yew::prelude::*;

use crate::store::{DeckId, Watchers};

/// A page.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Route {
    /// The deck, or the first start.
    Deck,
    /// One entry of the deck.
    Block(DeckId),
    /// All blocks, live.
    Monitor,
    /// Buffers, targets, discovery.
    Connections,
    /// Words and keys.
    Help,
    /// Everything else.
    NotFound,
}

impl Route {
    /// The page of a path.
    pub fn read(path: &str) -> Self {
        let path = path.trim_end_matches('/');
        match path.strip_prefix("/deck/") {
            Some(id) => id.parse().map_or(Self::NotFound, Self::Block),
            None => match path {
                "" => Self::Deck,
                "/monitor" => Self::Monitor,
                "/connections" => Self::Connections,
                "/help" => Self::Help,
                _ => Self::NotFound,
            },
        }
    }

    /// The path of a page.
    pub fn path(self) -> String {
        match self {
            Self::Deck => "/".to_owned(),
            Self::Block(id) => format!("/deck/{id}"),
            Self::Monitor => "/monitor".to_owned(),
            Self::Connections => "/connections".to_owned(),
            Self::Help => "/help".to_owned(),
            Self::NotFound => "/404".to_owned(),
        }
    }
}

// The address is the browser's: there is one per page, whoever asks.
thread_local! {
    static WATCHERS: Watchers = Watchers::default();
}

/// Goes to a page.
pub fn go(to: Route) {
    if let Some(history) = history() {
        // Refused only for an address of another server.
        let _ = history.push_state_with_url(&JsValue::NULL, "", Some(&to.path()));
    }
    wake();
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

/// Where we are; renders again when that changes.
#[hook]
pub fn use_route() -> Route {
    let update = use_force_update();
    use_effect_with((), move |()| {
        let wake = Callback::from(move |()| update.force_update());
        let watch = WATCHERS.with(|watchers| watchers.watch(wake));
        move || drop(watch)
    });
    let path = web_sys::window().and_then(|window| window.location().pathname().ok());
    Route::read(&path.unwrap_or_default())
}

/// A link to a page.
pub fn link(to: Route, class: &'static str, words: Html) -> Html {
    let onclick = move |event: MouseEvent| {
        // With a key held, people want what the browser does: a new tab, a download.
        let plain = event.button() == 0
            && !(event.ctrl_key() || event.meta_key() || event.shift_key() || event.alt_key());
        if plain {
            event.prevent_default();
            go(to);
        }
    };
    html! { <a href={to.path()} {class} {onclick}>{ words }</a> }
}

/// Where to go instead.
#[derive(Clone, Debug, PartialEq, Properties)]
pub struct RedirectProps {
    /// The page.
    pub to: Route,
}

/// Replaces this address: the back button does not lead here again.
#[component]
pub fn Redirect(props: &RedirectProps) -> Html {
    use_effect_with(props.to, |to| {
        if let Some(history) = history() {
            let _ = history.replace_state_with_url(&JsValue::NULL, "", Some(&to.path()));
        }
        wake();
    });
    html! {}
}

fn history() -> Option<web_sys::History> {
    web_sys::window()?.history().ok()
}

fn wake() {
    WATCHERS.with(Clone::clone).wake();
}

#[cfg(test)]
mod tests {
    use super::*;
    use cipdeck_shared::config::BlockId;

    #[test]
    fn a_page_is_found_by_the_path_that_it_writes() {
        let block = Route::Block(DeckId::Stored(BlockId(7)));
        for route in [
            Route::Deck,
            block,
            Route::Block(DeckId::New(1)),
            Route::Monitor,
            Route::Connections,
            Route::Help,
            Route::NotFound,
        ] {
            assert_eq!(Route::read(&route.path()), route);
        }
        assert_eq!(Route::read("/monitor/"), Route::Monitor);
        for path in ["/deck/", "/deck/7", "/deck/b7/x", "/nowhere"] {
            assert_eq!(Route::read(path), Route::NotFound, "{path}");
        }
    }
}
