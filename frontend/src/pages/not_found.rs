//! An address that is no page.

use yew::prelude::*;
use yew_router::prelude::Link;

use crate::{i18n::tr, route::Route};

/// Says so, and shows the way back.
pub fn not_found() -> Html {
    html! {
        <section class="prose">
            <h1>{ tr!("not_found.title") }</h1>
            <p><Link<Route> to={Route::Deck}>{ tr!("not_found.back") }</Link<Route>></p>
        </section>
    }
}
