//! cipdeck's page: builds, explains, runs and monitors blocks in the browser.
//!
//! | module | job |
//! | --- | --- |
//! | [`editor`] | typed text → draft → findings; no browser in it |
//! | [`store`] | the rows of the deck, outside the virtual DOM |
//! | [`net`] | the relay: socket, REST, when to come back |
//! | [`demo`] | engine and simulated device in the browser alone |
//! | [`workbench`] | what can be done with a block, and where it runs |
//! | [`kit`] | small components on native elements |
//! | [`pages`] | what people see |

rust_i18n::i18n!("locales", fallback = "en");

pub mod app;
pub mod browser;
pub mod demo;
pub mod editor;
pub mod frame_stats;
pub mod hooks;
mod i18n;
pub mod kit;
pub mod net;
pub mod notice;
pub mod pages;
pub mod route;
pub mod store;
mod theme;
pub mod workbench;

/// Puts the page into the document's body.
pub fn start() {
    std::panic::set_hook(Box::new(|panic| {
        let place = panic.location().map(ToString::to_string).unwrap_or_default();
        browser::show_crash(&i18n::filled("crash", &[("place", &place)]));
    }));
    yew::Renderer::<app::App>::new().render();
}
