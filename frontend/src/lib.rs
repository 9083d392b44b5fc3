//! cipdeck's page: builds, explains, runs and monitors blocks in the browser.

use yew::prelude::*;

/// Puts the page into the document's body.
pub fn start() {
    yew::Renderer::<App>::new().render();
}

/// The whole page.
#[component]
pub fn App() -> Html {
    html! { <h1>{ "cipdeck" }</h1> }
}
