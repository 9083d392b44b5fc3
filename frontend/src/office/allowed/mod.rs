//! What may be reached and written: nothing that is not here.

mod targets;
mod write_form;
mod writes;

use yew::prelude::*;

use self::{targets::Targets, writes::Writes};
use super::i18n::tr;
use crate::hooks::use_title;

/// Two lists.
#[component]
pub(super) fn AllowedPage() -> Html {
    use_title(&tr!("allowed.title"));
    html! { <>
        <h1>{ tr!("allowed.title") }</h1>
        <p class="lead">{ tr!("allowed.lead") }</p>
        <Targets />
        <Writes />
    </> }
}
