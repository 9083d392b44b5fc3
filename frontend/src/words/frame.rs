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
    hooks::{use_second, use_session},
    pages::connection::connection,
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
    use_second(writing.state.window.is_some() || state.waits());
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
            { connection(desk.relay(), Some(tr!("frame.no_relay"))) }
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
