//! Messages as code of controllers, and back; projects as files: two documents of their own. One reads code, the other one
//! writes code and has the projects: together they would be more than a document may weigh.
//!
//! | module | job |
//! | --- | --- |
//! | [`route`], `frame` | the addresses of their pages, and what is around them |
//! | [`import`] | code in: texts, the blocks in them, what is not understood |
//! | `export` | code out: a block in every dialect, and as a block of another kind |
//! | `project` | everything as files: download, upload |
//! | [`decode`] | bytes of a file → text |
//! | [`lines`], [`sheet`] | code with line numbers and colours |
//! | `say`, `facts` | words for what `shared::code` names, and for what a block sends |
//!
//! What is read and written is decided by `shared::code`, here in the browser; the relay is asked for blocks only.

mod api;
mod changes;
pub mod decode;
mod export;
mod facts;
mod frame;
mod i18n;
pub mod import;
pub mod lines;
mod project;
pub mod route;
mod say;
pub mod sheet;

use yew::prelude::*;

use self::{
    export::ExportPage,
    frame::{Frame, not_found},
    import::{ImportPage, restored},
    project::ProjectPage,
    route::Page,
};

/// The document that reads code.
#[component]
pub fn CodeIn() -> Html {
    let desk = use_reducer(restored);
    let show = move |page| match page {
        Page::Import => html! { <ImportPage desk={desk.clone()} /> },
        Page::Export(_) | Page::Project | Page::NotFound => not_found(),
    };
    html! { <Frame show={Callback::from(show)} /> }
}

/// The document that writes code, and that has the projects.
#[component]
pub fn CodeOut() -> Html {
    let show = |page| match page {
        Page::Export(id) => html! { <ExportPage key={id.to_string()} {id} /> },
        Page::Project => html! { <ProjectPage /> },
        Page::Import | Page::NotFound => not_found(),
    };
    html! { <Frame show={Callback::from(show)} /> }
}
