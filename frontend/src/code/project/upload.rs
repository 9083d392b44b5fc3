//! A zip: looked at first, then imported.

use cipdeck_shared::{api::ProjectImport, plan::Severity};
use js_sys::Uint8Array;
use web_sys::HtmlInputElement;
use yew::{platform::spawn_local, prelude::*};

use super::{
    super::{api, i18n::tr},
    preview::preview,
};
use crate::{
    browser,
    office::{fetch::use_action, kit::problem_note},
};

/// Bytes of a zip that are sent. A thousand blocks have less than one of these MiB.
const MAX_ZIP: usize = 16 << 20;

/// How each zip begins, also an empty one.
const ZIP: [&[u8]; 2] = [b"PK\x03\x04", b"PK\x05\x06"];

/// The choice of a file, what it would do, and the button that does it.
#[component]
pub(super) fn Upload() -> Html {
    let action = use_action();
    let said = use_state(|| None::<AttrValue>);
    let seen = use_state(|| None::<(Uint8Array, ProjectImport)>);
    let done = use_state(|| None::<ProjectImport>);
    let onchange = {
        let (action, said, seen, done) = (action.clone(), said.setter(), seen.setter(), done.setter());
        move |event: Event| {
            let input = event.target_unchecked_into::<HtmlInputElement>();
            let Some(file) = input.files().and_then(|files| files.get(0)) else { return };
            // The same file may be chosen again.
            input.set_value("");
            seen.set(None);
            done.set(None);
            said.set(None);
            let (action, said, seen) = (action.clone(), said.clone(), seen.clone());
            spawn_local(async move {
                let bytes = match zip(&file).await {
                    Ok(bytes) => bytes,
                    Err(why) => return said.set(Some(why)),
                };
                let zip = bytes.clone();
                action.go(async move { api::import_project(&zip, true).await }, move |import| {
                    seen.set(Some((bytes, import)));
                });
            });
        }
    };
    let onclick = {
        let (action, seen, done) = (action.clone(), seen.clone(), done.setter());
        move |_: MouseEvent| {
            let Some((bytes, _)) = &*seen else { return };
            let (bytes, seen, done) = (bytes.clone(), seen.setter(), done.clone());
            action.go(async move { api::import_project(&bytes, false).await }, move |import| {
                seen.set(None);
                done.set(Some(import));
            });
        }
    };
    html! { <>
        <p>{ tr!("project.up") }</p>
        <div class="entry-line">
            <label for="project-file">{ tr!("project.up_file") }</label>
            <input id="project-file" type="file" accept=".zip,application/zip" {onchange} data-test="project-file" />
        </div>
        if let Some(words) = &*said {
            <p class="finding error" role="alert" data-test="no-zip">{ words }</p>
        }
        { problem_note(action.problem().as_ref()) }
        if action.is_busy() {
            <p class="hint" role="status">{ tr!("project.looking") }</p>
        }
        if let Some((_, import)) = &*seen {
            { preview(import) }
            <div class="code-save">
                <button type="button" class="button primary" disabled={action.is_busy() || !may(import)} {onclick} data-test="project-do">{ tr!("project.do") }</button>
                if has_errors(import) {
                    <span class="finding error">{ tr!("project.not_whole") }</span>
                } else if !changes_something(import) {
                    <span class="hint">{ tr!("project.nothing") }</span>
                }
            </div>
        }
        if let Some(import) = &*done {
            <div class="code-all" role="status" data-test="project-done">{ tr!("project.done") }</div>
            { preview(import) }
        }
    </> }
}

fn may(import: &ProjectImport) -> bool {
    !has_errors(import) && changes_something(import)
}

fn has_errors(import: &ProjectImport) -> bool {
    import.findings.iter().any(|finding| finding.severity == Severity::Error)
}

fn changes_something(import: &ProjectImport) -> bool {
    use cipdeck_shared::api::ProjectChange::{Changed, Created, Removed};
    import.parts.iter().any(|part| matches!(part.how, Created | Changed | Removed))
}

/// The bytes of a file that can be a zip, or why it cannot.
async fn zip(file: &web_sys::File) -> Result<Uint8Array, AttrValue> {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "whole, not negative")]
    let size = file.size() as usize;
    if size > MAX_ZIP {
        return Err(tr!("project.too_big", bytes = size, limit = MAX_ZIP));
    }
    let bytes = browser::bytes_of(file).await.ok_or(tr!("project.unreadable"))?;
    if !ZIP.iter().any(|begin| bytes.starts_with(begin)) {
        return Err(tr!("project.no_zip"));
    }
    Ok(Uint8Array::from(&*bytes))
}
