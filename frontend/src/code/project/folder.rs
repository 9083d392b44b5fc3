//! The relay's folder, read again after somebody else has changed it.

use yew::prelude::*;

use super::{
    super::i18n::tr,
    review::{Source, use_review},
};

/// The button that looks, and what comes of it.
#[component]
pub(super) fn Folder() -> Html {
    let review = use_review();
    let onclick = {
        let review = review.clone();
        move |_: MouseEvent| review.look(Source::Folder)
    };
    html! { <>
        <p>{ tr!("project.folder") }</p>
        <p><button type="button" class="button" disabled={review.is_busy()} {onclick} data-test="folder-look">{ tr!("project.folder_look") }</button></p>
        { review.html() }
    </> }
}
