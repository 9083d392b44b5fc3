//! The frame around every page: where we are, the connection, who is here.

use yew::prelude::*;

use super::{
    block::BlockPage,
    hooks::{use_desk, use_link},
    i18n::tr,
    list::ListPage,
    new::NewPage,
    route::{Page, link, use_page},
};
use crate::{
    access::{refused, who, write_banner},
    browser,
    hooks::{use_second, use_session},
    net::Link,
    pages::{block::age_words, connection::say},
    theme::ThemeToggle,
};

/// Bar, banner, page.
#[component]
pub(super) fn Frame() -> Html {
    let page = use_page();
    let desk = use_desk();
    let state = use_link();
    let view = use_session();
    let writing = desk.relay().writing();
    let waits = matches!(state, Link::Lost { .. } | Link::None { .. });
    use_second(writing.state.window.is_some() || waits);
    let on_try = {
        let desk = desk.clone();
        Callback::from(move |_: MouseEvent| desk.relay().connect())
    };
    let closed = desk.relay().is_closed_to_us();
    html! { <>
        <header class="bar">
            <a class="brand" href="/">{ "cipdeck" }</a>
            <span class="bar-place">{ link(Page::All, "", html! { tr!("nav.words") }) }</span>
            <nav aria-label={tr!("frame.elsewhere")}><ul>
                <li><a href="/">{ tr!("frame.workbench") }</a></li>
                <li><a href="/monitor">{ tr!("nav.monitor") }</a></li>
                <li><a href="/code">{ tr!("frame.code") }</a></li>
                <li><a href="/devices">{ tr!("nav.devices") }</a></li>
                <li><a href="/office">{ tr!("nav.office") }</a></li>
            </ul></nav>
            { connection(&state, waits || closed, on_try) }
            { who(view.as_deref(), writing.state.read_only) }
            <ThemeToggle />
        </header>
        { write_banner(&writing) }
        <main>{ if closed { refused(&state) } else { body(page) } }</main>
    </> }
}

fn body(page: Page) -> Html {
    match page {
        Page::All => html! { <ListPage /> },
        Page::New => html! { <NewPage /> },
        Page::Block(id) => html! { <BlockPage {id} /> },
        Page::NotFound => html! {
            <div class="empty">
                <h1>{ tr!("not_found.title") }</h1>
                <p>{ link(Page::All, "", html! { tr!("block.back") }) }</p>
            </div>
        },
    }
}

/// Word, shape and colour of the connection; a button to try now.
fn connection(state: &Link, can_try: bool, onclick: Callback<MouseEvent>) -> Html {
    let (word, shape, words) = say(state);
    // Without a relay blocks can be made here, but not run, unlike in the workbench.
    let words = if let Link::None { .. } = state { tr!("frame.no_relay") } else { words };
    html! {
        <div class={classes!("connection", word)} data-test="connection" data-state={word}>
            { shape.draw() }
            <span>{ words }</span>
            if can_try {
                <button type="button" class="quiet-button" {onclick}>{ tr!("link.try_now") }</button>
            }
        </div>
    }
}

/// Says that what is shown is not live, and since when.
pub(super) fn stale_note(state: &Link) -> Html {
    let Link::Lost { since_ms, .. } = state else { return html! {} };
    let age = age_words((browser::now_ms() - since_ms) / 1_000.0);
    html! { <p class="warning-text" role="status" data-test="stale">{ tr!("link.stale", age = age) }</p> }
}
