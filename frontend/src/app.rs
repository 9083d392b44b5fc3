//! The frame around every page: navigation, connection, theme.

use yew::prelude::*;

use crate::{
    access::{refused, who, write_banner},
    hooks::{use_link, use_second, use_session, use_workbench},
    i18n::tr,
    pages::{
        connection::Connection, connections::ConnectionsPage, deck::DeckPage, help::HelpPage,
        monitor::MonitorPage, not_found::not_found,
    },
    route::{Route, link, use_page},
    theme::ThemeToggle,
    workbench::Workbench,
};

/// Where drafts are kept in the browser's local storage.
const DRAFTS: &str = "cipdeck.drafts";

/// The whole page.
#[component]
pub fn App() -> Html {
    let bench = use_memo((), |()| Workbench::open(DRAFTS));
    html! {
        <ContextProvider<Workbench> context={(*bench).clone()}>
            <Frame />
        </ContextProvider<Workbench>>
    }
}

#[component]
fn Frame() -> Html {
    let route = use_page();
    let link_state = use_link();
    let bench = use_workbench();
    let writing = bench.relay().writing();
    let view = use_session();
    // What is below has no new properties, and is not drawn again.
    use_second(writing.state.window.is_some());
    html! { <>
        <header class="bar">
            { link(Route::Deck, "brand", html! { "cipdeck" }) }
            { navigation(route) }
            <Connection />
            { who(view.as_deref(), writing.state.read_only) }
            <ThemeToggle />
        </header>
        { write_banner(&writing) }
        <main>{ if bench.relay().is_closed_to_us() { refused(&link_state) } else { page(route) } }</main>
    </> }
}

fn navigation(route: Route) -> Html {
    let entry = |to: Route, words: AttrValue| {
        let here = matches!((route, to), (Route::Block(_), Route::Deck)) || route == to;
        html! {
            <li aria-current={here.then_some("page")} class={classes!(here.then_some("here"))}>
                { link(to, "", html! { words }) }
            </li>
        }
    };
    html! {
        <nav aria-label={tr!("nav.label")}>
            <ul>
                { entry(Route::Deck, tr!("nav.deck")) }
                { entry(Route::Monitor, tr!("nav.monitor")) }
                { entry(Route::Connections, tr!("nav.connections")) }
                { entry(Route::Help, tr!("nav.help")) }
                <li><a href="/words">{ "SEND_REQ" }</a></li>
                <li><a href="/code">{ tr!("nav.code") }</a></li>
                <li><a href="/devices">{ tr!("nav.devices") }</a></li>
                <li><a href="/office">{ tr!("nav.office") }</a></li>
            </ul>
        </nav>
    }
}

fn page(route: Route) -> Html {
    match route {
        Route::Deck => html! { <DeckPage /> },
        Route::Block(id) => html! { <DeckPage {id} /> },
        Route::Monitor => html! { <MonitorPage /> },
        Route::Connections => html! { <ConnectionsPage /> },
        Route::Help => html! { <HelpPage /> },
        Route::NotFound => not_found(),
    }
}
