//! The frame around every page: navigation, connection, theme.

use yew::prelude::*;

use crate::{
    browser,
    editor::DraftStore,
    frame_stats::FrameStats,
    i18n::tr,
    net::Relay,
    notice::NoticeStore,
    pages::{
        connection::Connection, connections::ConnectionsPage, deck::DeckPage, help::HelpPage,
        monitor::MonitorPage, not_found::not_found,
    },
    route::{self, Route, link, use_route},
    store::RowStore,
    theme::ThemeToggle,
    workbench::Workbench,
};

/// Where drafts are kept in the browser's local storage.
const DRAFTS: &str = "cipdeck.drafts";

/// The whole page.
#[component]
pub fn App() -> Html {
    let bench = use_memo((), |()| open());
    html! {
        <ContextProvider<Workbench> context={(*bench).clone()}>
            <Frame />
        </ContextProvider<Workbench>>
    }
}

/// Opens the workbench of this browser, and starts to connect.
fn open() -> Workbench {
    let stats = FrameStats::default();
    stats.offer();
    let rows = RowStore::new(stats.ask_for_frame());
    let drafts = DraftStore::new(
        browser::kept(DRAFTS).as_deref(),
        std::rc::Rc::new(|text| browser::keep(DRAFTS, text)),
    );
    let relay = Relay::new(rows.clone(), Callback::from(move |ms| stats.spend(ms)));
    relay.connect();
    route::listen();
    Workbench::new(rows, drafts, relay, NoticeStore::default())
}

#[component]
fn Frame() -> Html {
    let route = use_route();
    html! { <>
        <header class="bar">
            { link(Route::Deck, "brand", html! { "cipdeck" }) }
            { navigation(route) }
            <Connection />
            <ThemeToggle />
        </header>
        <main>{ page(route) }</main>
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
