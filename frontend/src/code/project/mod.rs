//! Everything as files: download, upload.

mod preview;
mod upload;

use cipdeck_shared::api::{ProjectFolder, Role};
use yew::prelude::*;

use self::upload::Upload;
use super::i18n::tr;
use crate::{
    hooks::{use_session, use_title},
    net::session,
    office::{fetch::use_fetched, kit::note},
};

/// The page.
#[component]
pub(super) fn ProjectPage() -> Html {
    use_title(&tr!("project.title"));
    use_session();
    let served = use_fetched::<ProjectFolder>("project/folder".to_owned());
    html! {
        <div class="code-page">
            <div class="page-head"><h1>{ tr!("project.title") }</h1></div>
            <p class="lead">{ tr!("project.lead") }</p>
            if let Some(served) = &served.data {
                <p class="code-all" data-test="served">{ match &served.folder {
                    Some(folder) => tr!("project.served", folder = folder),
                    None => tr!("project.not_served"),
                } }</p>
            }
            <div class="cards">
                <section class="panel">
                    <h2>{ tr!("project.down_title") }</h2>
                    <p>{ tr!("project.down") }</p>
                    <p><a class="button primary link" href="/api/v1/project" download="" data-test="project-down">{ tr!("project.down_do") }</a></p>
                </section>
                <section class="panel">
                    <h2>{ tr!("project.up_title") }</h2>
                    if session::may(Role::may_edit) {
                        <Upload />
                    } else {
                        { note(tr!("project.not_you")) }
                    }
                </section>
            </div>
        </div>
    }
}
