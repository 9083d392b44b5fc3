//! Messages as code of controllers, and back; projects as files: a document of its own.
//!
//! | module | job |
//! | --- | --- |
//! | [`route`] | the addresses of its pages |
//! | `import` | code in: texts, the blocks in them, what is not understood |
//! | `export` | code out: a block in every dialect, and as a block of another kind |
//! | `project` | everything as files: download, upload |
//! | `decode` | bytes of a file → text |
//! | `lines`, `sheet` | code with line numbers and colours |
//! | `say`, `facts` | words for what `shared::code` names, and for what a block sends |
//!
//! What is read and written is decided by `shared::code`, here in the browser; the relay is asked for blocks only.

mod api;
mod changes;
pub mod decode;
mod export;
mod facts;
mod i18n;
pub mod import;
pub mod lines;
mod project;
pub mod route;
mod say;
pub mod sheet;

use cipdeck_shared::api::SessionState;
use yew::prelude::*;

use self::{
    export::ExportPage,
    i18n::tr,
    import::{Desk, ImportPage},
    project::ProjectPage,
    route::{Page, link, use_page},
};
use crate::{
    access::{refused, use_writing, who, write_banner},
    address,
    hooks::{use_second, use_session},
    net::{Link, session},
    theme::ThemeToggle,
};

/// The whole document.
#[component]
pub fn CodePages() -> Html {
    use_memo((), |()| {
        address::listen();
        session::watch_activity();
    });
    let page = use_page();
    let view = use_session();
    let (writing, _) = use_writing();
    use_second(writing.state.window.is_some());
    let desk = use_reducer(Desk::default);
    let body = match view.as_deref().map(|view| view.state) {
        Some(SessionState::SetUp) => refused(&Link::SetUp),
        Some(SessionState::SignedOut) => refused(&Link::SignedOut),
        // Without an answer: code is read and converted here. What needs the relay says so.
        None | Some(SessionState::SignedIn) => show(page, desk),
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
            { link(listed, "", html! { words }) }
        </li>
    }
}

fn show(page: Page, desk: UseReducerHandle<Desk>) -> Html {
    match page {
        Page::Import => html! { <ImportPage {desk} /> },
        Page::Export(id) => html! { <ExportPage key={id.to_string()} {id} /> },
        Page::Project => html! { <ProjectPage /> },
        Page::NotFound => html! {
            <div class="empty">
                <h1>{ tr!("not_found.title") }</h1>
                <p>{ link(Page::Import, "", html! { tr!("frame.to_import") }) }</p>
            </div>
        },
    }
}
