//! Words and keys, on one page.

use yew::prelude::*;

use crate::{hooks::use_title, i18n::tr};

/// Short: what the words mean, which keys there are, where the manuals are.
#[component]
pub fn HelpPage() -> Html {
    use_title(&tr!("help.title"));
    let word = |word: &'static str, meaning: AttrValue| {
        html! { <><dt>{ word }</dt><dd>{ meaning }</dd></> }
    };
    let key = |keys: &'static str, meaning: AttrValue| {
        html! { <tr><th scope="row"><kbd>{ keys }</kbd></th><td>{ meaning }</td></tr> }
    };
    html! {
        <section class="prose">
            <h1>{ tr!("help.title") }</h1>
            <p>{ tr!("help.what") }</p>
            <h2>{ tr!("help.words") }</h2>
            <dl class="words">
                { word("EN", tr!("bit.en")) }
                { word("EW", tr!("bit.ew")) }
                { word("ST", tr!("bit.st")) }
                { word("ER", tr!("bit.er")) }
                { word("DN", tr!("bit.dn")) }
                { word("IN", tr!("help.in")) }
                { word("Run", tr!("help.run")) }
                { word("Write…", tr!("help.write")) }
                { word("0,0", tr!("help.demo")) }
                { word("controller / monitor", tr!("help.channel")) }
            </dl>
            <h2>{ tr!("help.keys") }</h2>
            <table class="keys"><tbody>
                { key("Ctrl + Enter", tr!("help.key_run")) }
                { key("Ctrl + S", tr!("help.key_save")) }
                { key("← →", tr!("help.key_bytes")) }
                { key("Esc", tr!("help.key_escape")) }
            </tbody></table>
            <h2>{ tr!("help.manuals") }</h2>
            <p>{ tr!("help.manual_block") }</p>
            <p>{ tr!("help.manual_cipdeck") }</p>
        </section>
    }
}
