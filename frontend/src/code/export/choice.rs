//! Which dialect: one list, by who makes the editor that takes the code.

use cipdeck_shared::code::{Dialect, Language};
use yew::prelude::*;

use super::super::{i18n::tr, say};

/// Radio buttons, so that the arrow keys walk through them.
pub(super) fn choice(
    chosen: Dialect,
    language: Language,
    on_dialect: &Callback<Dialect>,
    on_language: &UseStateSetter<Language>,
) -> Html {
    let radio = |dialect: &Dialect| {
        let dialect = *dialect;
        let (id, is_chosen) = (format!("as-{}", dialect.name()), dialect == chosen);
        html! {
            <li>
                <input
                    type="radio" name="dialect" id={id.clone()} class="unseen" checked={is_chosen}
                    onchange={on_dialect.reform(move |_: Event| dialect)}
                />
                <label for={id} data-test={dialect.name()}>{ say::dialect(dialect) }</label>
            </li>
        }
    };
    html! {
        <fieldset class="code-choice">
            <legend class="unseen">{ tr!("take.dialects") }</legend>
            { for say::groups().into_iter().map(|(vendor, dialects)| html! {
                <div class="code-vendor">
                    <h3>{ vendor }</h3>
                    <ul>{ for dialects.iter().map(radio) }</ul>
                </div>
            }) }
            if chosen.has_il() {
                { languages(language, on_language) }
            }
        </fieldset>
    }
}

fn languages(chosen: Language, on_language: &UseStateSetter<Language>) -> Html {
    let button = |language: Language, words: AttrValue, test: &'static str| {
        let set = on_language.clone();
        let pressed = if language == chosen { "true" } else { "false" };
        html! {
            <button type="button" class="segment" aria-pressed={pressed} data-test={test} onclick={move |_: MouseEvent| set.set(language)}>{ words }</button>
        }
    };
    html! {
        <div class="segments" role="group" aria-label={tr!("take.language")}>
            { button(Language::St, tr!("take.st"), "language-st") }
            { button(Language::Il, tr!("take.il"), "language-il") }
        </div>
    }
}
