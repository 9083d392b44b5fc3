//! One of a few values.

use web_sys::HtmlSelectElement;
use yew::prelude::*;

use super::field::{describes, field_row};
use crate::editor::Remark;

/// A choice.
#[derive(Clone, Debug)]
pub struct SelectField {
    /// Of the select.
    pub id: AttrValue,
    /// Its name in JSON.
    pub name: AttrValue,
    /// Visible name.
    pub label: AttrValue,
    /// The chosen value.
    pub value: AttrValue,
    /// Value and words of each choice. A value that is none of them is shown as it is.
    pub choices: Vec<(&'static str, AttrValue)>,
    /// What the chosen value means.
    pub readout: Option<AttrValue>,
    /// What is to be said about it.
    pub remarks: Vec<Remark>,
    /// Hears the chosen value.
    pub on_choice: Callback<String>,
}

impl SelectField {
    /// A native select.
    pub fn draw(self) -> Html {
        let on_choice = self.on_choice;
        let onchange = move |event: Event| {
            on_choice.emit(event.target_unchecked_into::<HtmlSelectElement>().value());
        };
        let invalid = self.remarks.iter().any(Remark::is_error).then_some("true");
        let is_known = self.choices.iter().any(|(value, _)| *value == self.value);
        let option = |value: AttrValue, words: &AttrValue| {
            let selected = value == self.value;
            html! { <option {value} {selected}>{ words }</option> }
        };
        let input = html! {
            <select
                id={self.id.clone()}
                class="input select"
                name={self.name}
                aria-invalid={invalid}
                aria-describedby={describes(&self.id, &self.remarks, self.readout.as_ref())}
                {onchange}
            >
                { for self.choices.iter().map(|(value, words)| option((*value).into(), words)) }
                if !is_known {
                    { option(self.value.clone(), &self.value) }
                }
            </select>
        };
        field_row(&self.id, &self.label, &self.remarks, self.readout.as_ref(), input)
    }
}
