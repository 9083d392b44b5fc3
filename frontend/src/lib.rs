//! cipdeck's page: builds, explains, runs and monitors blocks in the browser.
//!
//! | module | job |
//! | --- | --- |
//! | [`editor`] | typed text → draft → findings; no browser in it |
//! | [`store`] | the rows of the deck, outside the virtual DOM |
//! | [`net`] | the relay: socket, REST, when to come back |
//! | [`demo`] | engine and simulated device in the browser alone |
//! | [`access`] | who is here, what they may, and whether something may be written now |
//! | [`desk`] | the blocks of a document: stored, edited, commanded |
//! | [`workbench`] | the desk of the workbench, and where its blocks run |
//! | [`kit`] | small components on native elements |
//! | [`pages`] | what people see |
//! | [`office`] | the second document: users, lists, audit, history |
//! | [`devices`] | the third document: devices, groups, variables, their live values |
//! | [`words`] | the fourth: blocks in Control Expert's terms, SEND_REQ and DATA_EXCH |
//! | [`invisible`] | characters that nobody sees, in texts that are pasted |
//! | [`code`] | the fifth and the sixth: code of controllers becomes blocks, projects; a block becomes code |

pub mod access;
pub mod address;
pub mod app;
pub mod browser;
pub mod code;
pub mod demo;
pub mod desk;
pub mod devices;
pub mod editor;
pub mod frame_stats;
pub mod hooks;
mod i18n;
pub mod invisible;
pub mod kit;
pub mod net;
pub mod notice;
pub mod office;
pub mod pages;
pub mod route;
pub mod store;
mod theme;
pub mod words;
pub mod workbench;

/// Puts the workbench into the document's body.
pub fn start() {
    say_crashes();
    yew::Renderer::<app::App>::new().render();
}

/// Puts the office into the document's body.
pub fn start_office() {
    say_crashes();
    yew::Renderer::<office::Office>::new().render();
}

/// Puts the devices into the document's body.
pub fn start_devices() {
    say_crashes();
    yew::Renderer::<devices::Devices>::new().render();
}

/// Puts the blocks of words into the document's body.
pub fn start_words() {
    say_crashes();
    yew::Renderer::<words::Words>::new().render();
}

/// Puts the pages that read code into the document's body.
pub fn start_code() {
    say_crashes();
    yew::Renderer::<code::CodeIn>::new().render();
}

/// Puts the pages that write code, and projects, into the document's body.
pub fn start_take() {
    say_crashes();
    yew::Renderer::<code::CodeOut>::new().render();
}

fn say_crashes() {
    std::panic::set_hook(Box::new(|panic| {
        let place = panic.location().map(ToString::to_string).unwrap_or_default();
        browser::show_crash(&i18n::tr!("crash", place = place));
    }));
}
