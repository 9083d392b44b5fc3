//! Everything as files: download, upload, and the folder that the relay keeps.

mod folder;
mod preview;
mod review;
mod upload;

use cipdeck_shared::api::{ProjectFolder, Role};
use yew::prelude::*;

pub(super) use self::review::Source;
use self::{folder::Folder, upload::Upload};
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
    let is_kept = served.data.as_ref().is_some_and(|served| served.folder.is_some());
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
            if is_kept && session::may(Role::may_edit) {
                <section class="panel project-folder">
                    <h2>{ tr!("project.folder_title") }</h2>
                    <Folder />
                </section>
            }
        </div>
    }
}
