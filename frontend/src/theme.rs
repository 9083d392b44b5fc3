//! Dark or light: the system's wish until somebody decides.

use yew::prelude::*;

use crate::{browser, i18n::tr};

/// Where the decision is kept. `boot.js` reads it, too, before anything is drawn.
const KEPT: &str = "cipdeck.theme";

/// Switches between dark and light.
#[component]
pub fn ThemeToggle() -> Html {
    let dark = use_state(|| browser::kept(KEPT).map_or_else(browser::prefers_dark, |theme| theme == "dark"));
    let onclick = use_callback(dark.clone(), |_: MouseEvent, dark| {
        let theme = if **dark { "light" } else { "dark" };
        browser::keep(KEPT, theme);
        if let Some(root) = browser::root() {
            // The name is a valid attribute name.
            let _ = root.set_attribute("data-theme", theme);
        }
        dark.set(!**dark);
    });
    let words = if *dark { tr!("theme.to_light") } else { tr!("theme.to_dark") };
    html! { <button type="button" class="quiet-button" data-test="theme" {onclick}>{ words }</button> }
}
