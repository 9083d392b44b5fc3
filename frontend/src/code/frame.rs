//! What is around the pages of both documents: the bar, who is here, whether something may be written.

use cipdeck_shared::api::SessionState;
use yew::prelude::*;

use super::{
    i18n::tr,
    route::{Page, link, use_page},
};
use crate::{
    access::{refused, use_writing, who, write_banner},
    address::{self, Pages},
    hooks::{use_second, use_session},
    net::{Link, session},
    theme::ThemeToggle,
};

#[derive(Clone, PartialEq, Properties)]
pub(super) struct FrameProps {
    /// The page of an address, unless the relay shows nothing to whom is here.
    pub(super) show: Callback<Page, Html>,
}

/// The bar and a page.
#[component]
pub(super) fn Frame(props: &FrameProps) -> Html {
    use_memo((), |()| {
        address::listen();
        session::watch_activity();
    });
    let page = use_page();
    let view = use_session();
    let (writing, _) = use_writing();
    use_second(writing.state.window.is_some());
    let body = match view.as_deref().map(|view| view.state) {
        Some(SessionState::SetUp) => refused(&Link::SetUp),
        Some(SessionState::SignedOut) => refused(&Link::SignedOut),
        // Without an answer: code is read and converted here. What needs the relay says so.
        None | Some(SessionState::SignedIn) => props.show.emit(page),
    };
    html! { <>
        <header class="bar">
            <a class="brand" href="/">{ "cipdeck" }</a>
            <span class="bar-place">{ tr!("nav.code") }</span>
            <nav aria-label={tr!("nav.pages")}><ul>
                { entry(Page::Import, page, tr!("nav.import")) }
                if matches!(page, Page::Export(_)) {
                    { entry(page, page, tr!("nav.export")) }
                }
                { entry(Page::Project, page, tr!("nav.project")) }
                <li><a href="/">{ tr!("frame.workbench") }</a></li>
                <li><a href="/words">{ tr!("frame.words") }</a></li>
                <li><a href="/devices">{ tr!("nav.devices") }</a></li>
                <li><a href="/office">{ tr!("nav.office") }</a></li>
            </ul></nav>
            { who(view.as_deref(), writing.state.read_only) }
            <ThemeToggle />
        </header>
        { write_banner(&writing) }
        <main class="code-main">{ body }</main>
    </> }
}

fn entry(listed: Page, here: Page, words: AttrValue) -> Html {
    let is_here = listed == here;
    html! {
        <li aria-current={is_here.then_some("page")} class={classes!(is_here.then_some("here"))}>
            if listed.is_out() == here.is_out() {
                { link(listed, "", html! { words }) }
            } else {
                // The other document.
                <a href={listed.path()}>{ words }</a>
            }
        </li>
    }
}

/// For an address that leads nowhere.
pub(super) fn not_found() -> Html {
    html! {
        <div class="empty">
            <h1>{ tr!("not_found.title") }</h1>
            <p><a href={Page::Import.path()}>{ tr!("frame.to_import") }</a></p>
        </div>
    }
}
