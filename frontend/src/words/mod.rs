//! SEND_REQ and DATA_EXCH: blocks in Control Expert's terms, in a document of their own.

mod i18n;

use yew::prelude::*;

use self::i18n::tr;
use crate::{address, theme::ThemeToggle};

/// The whole document.
#[component]
pub fn Words() -> Html {
    use_effect_with((), |()| address::listen());
    html! { <>
        <header class="bar">
            <a class="brand" href="/">{ "cipdeck" }</a>
            <span class="bar-place">{ tr!("nav.words") }</span>
            <nav aria-label={tr!("frame.elsewhere")}><ul>
                <li><a href="/">{ tr!("frame.workbench") }</a></li>
                <li><a href="/code">{ tr!("frame.code") }</a></li>
            </ul></nav>
            <ThemeToggle />
        </header>
        <main><h1>{ tr!("list.title") }</h1></main>
    </> }
}
