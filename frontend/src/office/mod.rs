//! The office: what is looked at once a day, in a document of its own, so that the workbench stays small.
//!
//! | module | job |
//! | --- | --- |
//! | [`route`] | the addresses of its pages |
//! | [`api`], [`fetch`] | what is asked of the relay, and what comes of it |
//! | [`check`] | what can be said about a form before it is sent |
//! | [`kit`] | small components beside those of the workbench |
//! | the others | its pages |

mod allowed;
pub mod api;
mod audit;
pub mod check;
mod data;
pub mod fetch;
mod history;
mod i18n;
pub mod kit;
mod overview;
mod passes;
mod password;
pub(crate) mod query;
pub mod route;
mod sessions;
mod set_up;
mod sign_in;
mod users;
mod writing;

use cipdeck_shared::api::SessionState;
use yew::prelude::*;

use self::{
    allowed::AllowedPage,
    audit::AuditPage,
    data::DataPage,
    history::HistoryPage,
    i18n::tr,
    overview::OverviewPage,
    passes::PassesPage,
    route::{Page, link, use_page},
    sessions::SessionsPage,
    set_up::SetUpPage,
    sign_in::SignInPage,
    users::UsersPage,
};
use crate::{
    access::{refused, use_writing, who, write_banner},
    address, browser,
    hooks::{use_second, use_session},
    net::{Link, session},
    theme::ThemeToggle,
};

/// The whole document.
#[component]
pub fn Office() -> Html {
    use_memo((), |()| {
        address::listen();
        session::watch_activity();
    });
    let page = use_page();
    let view = use_session();
    let (writing, ask_again) = use_writing();
    use_second(writing.state.window.is_some());
    let caller = view.as_ref().and_then(|view| view.caller.clone());
    let body = match page {
        Page::SignIn => html! { <SignInPage /> },
        Page::SetUp => html! { <SetUpPage /> },
        Page::NotFound => not_found(),
        _ => match view.as_deref().map(|view| view.state) {
            None => html! { <p class="waiting" role="status">{ tr!("deck.connecting") }</p> },
            Some(SessionState::SetUp) => refused(&Link::SetUp),
            Some(SessionState::SignedOut) => refused(&Link::SignedOut),
            Some(SessionState::SignedIn) => show(page, writing.clone(), ask_again),
        },
    };
    html! { <>
        <header class="bar">
            <a class="brand" href="/">{ "cipdeck" }</a>
            <span class="bar-place">{ tr!("nav.office") }</span>
            <nav aria-label={tr!("office.elsewhere")}><ul>
                <li><a href="/">{ tr!("office.to_workbench") }</a></li>
                <li><a href="/monitor">{ tr!("nav.monitor") }</a></li>
                <li><a href="/devices">{ tr!("nav.devices") }</a></li>
            </ul></nav>
            { who(view.as_deref().filter(|_| page != Page::SignIn), writing.state.read_only) }
            <ThemeToggle />
        </header>
        { write_banner(&writing) }
        <div class="office">
            if let Some(caller) = caller {
                <nav class="office-nav" aria-label={tr!("nav.label")}><ul>
                    { for Page::LISTED.into_iter().filter(|listed| listed.is_for(caller.role)).map(|listed| entry(listed, page)) }
                </ul></nav>
            }
            <main class="office-page">{ body }</main>
        </div>
    </> }
}

fn entry(listed: Page, here: Page) -> Html {
    let is_here = listed == here || matches!((listed, here), (Page::History(_), Page::History(_)));
    let words = match listed {
        Page::Users => tr!("users.title"),
        Page::Sessions => tr!("sessions.title"),
        Page::Tokens => tr!("tokens.title"),
        Page::ViewLinks => tr!("view_links.title"),
        Page::Allowed => tr!("allowed.title"),
        Page::Audit => tr!("audit.title"),
        Page::History(_) => tr!("history.title"),
        _ => tr!("overview.title"),
    };
    html! {
        <li aria-current={is_here.then_some("page")} class={classes!(is_here.then_some("here"))}>
            { link(listed, "", html! { words }) }
        </li>
    }
}

fn show(page: Page, writing: std::rc::Rc<crate::net::Writing>, ask_again: Callback<()>) -> Html {
    match page {
        Page::Overview => html! { <OverviewPage {writing} on_changed={ask_again} /> },
        Page::Users => html! { <UsersPage /> },
        Page::Sessions => html! { <SessionsPage /> },
        Page::Tokens => html! { <PassesPage key="tokens" links=false /> },
        Page::ViewLinks => html! { <PassesPage key="links" links=true /> },
        Page::Allowed => html! { <AllowedPage /> },
        Page::Audit => html! { <AuditPage /> },
        Page::History(block) => html! { <HistoryPage {block} /> },
        Page::Data(block) => html! { <DataPage key={block.to_string()} {block} /> },
        Page::SignIn | Page::SetUp | Page::NotFound => not_found(),
    }
}

fn not_found() -> Html {
    html! {
        <div class="empty">
            <h1>{ tr!("not_found.title") }</h1>
            <p>{ link(Page::Overview, "", html! { tr!("office.to_overview") }) }</p>
        </div>
    }
}

/// `2026-11-22 10:32:05`: here, of a time in RFC 3339.
fn when(at: &str) -> String {
    browser::date_and_time(at)
}
