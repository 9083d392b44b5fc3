//! A zip: looked at first, then imported.

use js_sys::Uint8Array;
use web_sys::HtmlInputElement;
use yew::{platform::spawn_local, prelude::*};

use super::{
    super::i18n::tr,
    review::{Source, use_review},
};
use crate::browser;

/// Bytes of a zip that are sent. A thousand blocks have less than one of these MiB.
const MAX_ZIP: usize = 16 << 20;

/// How each zip begins, also an empty one.
const ZIP: [&[u8]; 2] = [b"PK\x03\x04", b"PK\x05\x06"];

/// The choice of a file, what it would do, and the button that does it.
#[component]
pub(super) fn Upload() -> Html {
    let review = use_review();
    let said = use_state(|| None::<AttrValue>);
    let onchange = {
        let (review, said) = (review.clone(), said.setter());
        move |event: Event| {
            let input = event.target_unchecked_into::<HtmlInputElement>();
            let Some(file) = input.files().and_then(|files| files.get(0)) else { return };
            // The same file may be chosen again.
            input.set_value("");
            review.clear();
            said.set(None);
            let (review, said) = (review.clone(), said.clone());
            spawn_local(async move {
                match zip(&file).await {
                    Ok(bytes) => review.look(Source::Zip(bytes)),
                    Err(why) => said.set(Some(why)),
                }
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
        { review.html() }
    </> }
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
