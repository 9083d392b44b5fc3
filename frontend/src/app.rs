//! The frame around every page: navigation, connection, theme.

use yew::prelude::*;
use yew_router::prelude::*;

use crate::{
    browser,
    editor::DraftStore,
    frame_stats::FrameStats,
    i18n::tr,
    net::Relay,
    notice::NoticeStore,
    pages::{
        connection::Connection, deck::DeckPage, help::HelpPage, monitor::MonitorPage, not_found::not_found,
    },
    route::Route,
    store::{DeckId, RowStore},
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
            <ContextProvider<RowStore> context={bench.rows().clone()}>
                <BrowserRouter>
                    <Frame />
                </BrowserRouter>
            </ContextProvider<RowStore>>
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
    Workbench::new(rows, drafts, relay, NoticeStore::default())
}

#[component]
fn Frame() -> Html {
    html! { <>
        <header class="bar">
            <Link<Route> to={Route::Deck} classes="brand">{ "cipdeck" }</Link<Route>>
            <Navigation />
            <Connection />
            <ThemeToggle />
        </header>
        <main>
            <Switch<Route> render={page} />
        </main>
    </> }
}

#[component]
fn Navigation() -> Html {
    let route = use_route::<Route>();
    let link = |to: Route, words: AttrValue| {
        let here = match (&route, &to) {
            (Some(Route::Block { .. }), Route::Deck) => true,
            (Some(route), to) => route == to,
            (None, _) => false,
        };
        html! {
            <li aria-current={here.then_some("page")} class={classes!(here.then_some("here"))}>
                <Link<Route> {to}>{ words }</Link<Route>>
            </li>
        }
    };
    html! {
        <nav aria-label={tr!("nav.label")}>
            <ul>
                { link(Route::Deck, tr!("nav.deck")) }
                { link(Route::Monitor, tr!("nav.monitor")) }
                { link(Route::Help, tr!("nav.help")) }
            </ul>
        </nav>
    }
}

fn page(route: Route) -> Html {
    match route {
        Route::Deck => html! { <DeckPage /> },
        Route::Block { id } => match id.parse::<DeckId>() {
            Ok(id) => html! { <DeckPage {id} /> },
            Err(_) => not_found(),
        },
        Route::Monitor => html! { <MonitorPage /> },
        Route::Help => html! { <HelpPage /> },
        Route::NotFound => not_found(),
    }
}
