//! An address that is no page.

use yew::prelude::*;

use crate::{
    i18n::tr,
    route::{Route, link},
};

/// Says so, and shows the way back.
pub fn not_found() -> Html {
    html! {
        <section class="prose">
            <h1>{ tr!("not_found.title") }</h1>
            <p>{ link(Route::Deck, "", html! { tr!("not_found.back") }) }</p>
        </section>
    }
}
