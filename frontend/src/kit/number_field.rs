//! A number, shown in the radix that was typed and beside it in the other.

use cipdeck_shared::config::read_number;
use yew::prelude::*;

use super::field::{describes, field_row};
use crate::editor::{Remark, other_radix};

/// A number field.
#[derive(Clone, Debug, PartialEq, Properties)]
pub struct NumberFieldProps {
    /// Of the input.
    pub id: AttrValue,
    /// Its name in JSON.
    pub name: AttrValue,
    /// Visible name.
    pub label: AttrValue,
    /// As typed.
    pub text: AttrValue,
    /// What the number means: a service's or a class's name.
    #[prop_or_default]
    pub meaning: Option<AttrValue>,
    /// Shown while nothing is typed.
    #[prop_or_default]
    pub placeholder: Option<AttrValue>,
    /// What is to be said about it.
    #[prop_or_default]
    pub remarks: Vec<Remark>,
    /// Hears every change of the text.
    pub on_text: Callback<String>,
}

/// The input with both radices. A function: a component would only cost.
pub fn number_field(props: &NumberFieldProps) -> Html {
    let oninput = props
        .on_text
        .reform(|event: InputEvent| event.target_unchecked_into::<web_sys::HtmlInputElement>().value());
    let value = read_number(&props.text).ok();
    let radix = value.map(|value| format!("= {}", other_radix(&props.text, value)));
    let parts: Vec<_> = radix.into_iter().chain(props.meaning.as_ref().map(ToString::to_string)).collect();
    let readout = (!parts.is_empty()).then(|| AttrValue::from(parts.join("  ")));
    let invalid = props.remarks.iter().any(Remark::is_error).then_some("true");
    let described = describes(&props.id, &props.remarks, readout.as_ref());
    let input = html! {
        <input
            id={props.id.clone()}
            class="input number"
            name={props.name.clone()}
            value={props.text.clone()}
            placeholder={props.placeholder.clone()}
            inputmode="text"
            autocomplete="off"
            spellcheck="false"
            aria-invalid={invalid}
            aria-describedby={described}
            {oninput}
        />
    };
    field_row(&props.id, &props.label, &props.remarks, readout.as_ref(), input)
}
