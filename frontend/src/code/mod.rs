//! Messages as code of controllers, and back; projects as files: a document of its own.

mod i18n;

use yew::prelude::*;

use self::i18n::tr;
use crate::{address, theme::ThemeToggle};

/// The whole document.
#[component]
pub fn CodePages() -> Html {
    use_effect_with((), |()| address::listen());
    html! { <>
        <header class="bar">
            <a class="brand" href="/">{ "cipdeck" }</a>
            <span class="bar-place">{ tr!("nav.code") }</span>
            <nav aria-label={tr!("frame.elsewhere")}><ul>
                <li><a href="/">{ tr!("frame.workbench") }</a></li>
                <li><a href="/words">{ tr!("frame.words") }</a></li>
            </ul></nav>
            <ThemeToggle />
        </header>
        <main><h1>{ tr!("code.title") }</h1></main>
    </> }
}
