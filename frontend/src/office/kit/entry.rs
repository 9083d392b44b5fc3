//! A labelled line of a form.

use web_sys::{HtmlInputElement, HtmlSelectElement};
use yew::prelude::*;

/// A text, a password or a number.
#[derive(Clone, Debug)]
pub struct Entry {
    /// Of the input.
    pub id: &'static str,
    /// Visible name.
    pub label: AttrValue,
    /// The `type` of the input.
    pub kind: &'static str,
    /// What it is for browsers that fill in.
    pub autocomplete: &'static str,
    /// As typed.
    pub text: String,
    /// What may be typed.
    pub hint: Option<AttrValue>,
    /// What is wrong with it.
    pub problem: Option<AttrValue>,
    /// Hears every change.
    pub on_text: Callback<String>,
}

impl Entry {
    /// A text without a hint.
    pub fn text(id: &'static str, label: AttrValue, text: &UseStateHandle<String>) -> Self {
        let set = text.setter();
        let on_text = Callback::from(move |text| set.set(text));
        let text = (**text).clone();
        Self { id, label, kind: "text", autocomplete: "off", text, hint: None, problem: None, on_text }
    }

    /// A password: `autocomplete` tells whether it is a new one.
    pub fn password(
        id: &'static str,
        label: AttrValue,
        text: &UseStateHandle<String>,
        autocomplete: &'static str,
    ) -> Self {
        Self { kind: "password", autocomplete, ..Self::text(id, label, text) }
    }

    /// With what may be typed.
    #[must_use]
    pub fn hint(self, hint: AttrValue) -> Self {
        Self { hint: Some(hint), ..self }
    }

    /// With what is wrong.
    #[must_use]
    pub fn problem(self, problem: Option<AttrValue>) -> Self {
        Self { problem, ..self }
    }

    /// Label, input, and what there is to say.
    pub fn draw(self) -> Html {
        let on_text = self.on_text;
        let oninput = move |event: InputEvent| {
            on_text.emit(event.target_unchecked_into::<HtmlInputElement>().value());
        };
        let (said, class, role) = match (&self.problem, &self.hint) {
            (Some(problem), _) => (Some(problem.clone()), "finding error", Some("alert")),
            (None, hint) => (hint.clone(), "hint", None),
        };
        let said_id = format!("{}-said", self.id);
        html! {
            <div class="entry-line">
                <label for={self.id}>{ self.label }</label>
                <input
                    id={self.id} name={self.id} class="input" type={self.kind} value={self.text} {oninput}
                    autocomplete={self.autocomplete} spellcheck="false" autocapitalize="none"
                    aria-invalid={self.problem.is_some().then_some("true")}
                    aria-describedby={said.is_some().then(|| said_id.clone())}
                />
                if let Some(said) = said {
                    <p id={said_id} {class} {role}>{ said }</p>
                }
            </div>
        }
    }
}

/// One of a few values.
pub fn choice(
    id: &'static str,
    label: AttrValue,
    chosen: &str,
    choices: &[(AttrValue, AttrValue)],
    on_choice: Callback<String>,
) -> Html {
    let onchange = move |event: Event| {
        on_choice.emit(event.target_unchecked_into::<HtmlSelectElement>().value());
    };
    let option = |(value, words): &(AttrValue, AttrValue)| {
        html! { <option value={value.clone()} selected={**value == *chosen}>{ words }</option> }
    };
    html! {
        <div class="entry-line">
            <label for={id}>{ label }</label>
            <select {id} class="input select" {onchange}>{ for choices.iter().map(option) }</select>
        </div>
    }
}
