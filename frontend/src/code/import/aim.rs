//! Where to, for blocks whose text does not say it.

use web_sys::HtmlInputElement;
use yew::prelude::*;

use super::{
    super::{i18n::tr, say},
    Entries,
    desk::Deed,
};

/// One field for all of them; nothing where every text names its device.
pub(super) fn aim(target: &str, entries: &Entries, on_deed: &Callback<Deed>) -> Html {
    let concerned = entries.iter().filter(|entry| entry.is_without_target && entry.pick.kept).count();
    if concerned == 0 {
        return html! {};
    }
    let oninput = on_deed
        .reform(|event: InputEvent| Deed::Target(event.target_unchecked_into::<HtmlInputElement>().value()));
    html! {
        <div class="entry-line code-aim">
            <label for="code-target">{ tr!("aim.label") }</label>
            <input
                id="code-target" class="input mono" value={target.to_owned()} {oninput} autocomplete="off" spellcheck="false"
                placeholder="192.168.1.10" aria-describedby="code-target-hint"
            />
            <p id="code-target-hint" class="hint">{ tr!("aim.hint", blocks = say::blocks(concerned)) }</p>
        </div>
    }
}
