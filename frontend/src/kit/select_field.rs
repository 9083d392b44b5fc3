//! One of a few values.

use yew::prelude::*;

use super::field::{FieldRow, describes};
use crate::editor::Remark;

/// A choice.
#[derive(Clone, Debug, PartialEq, Properties)]
pub struct SelectFieldProps {
    /// Of the select.
    pub id: AttrValue,
    /// Its name in JSON.
    pub name: AttrValue,
    /// Visible name.
    pub label: AttrValue,
    /// The chosen value.
    pub value: AttrValue,
    /// Value and words of each choice. A value that is none of them is shown as it is.
    pub choices: Vec<(AttrValue, AttrValue)>,
    /// What is to be said about it.
    #[prop_or_default]
    pub remarks: Vec<Remark>,
    /// Hears the chosen value.
    pub on_choice: Callback<String>,
}

/// A native select.
#[component]
pub fn SelectField(props: &SelectFieldProps) -> Html {
    let onchange = use_callback(props.on_choice.clone(), |event: Event, on_choice| {
        on_choice.emit(event.target_unchecked_into::<web_sys::HtmlSelectElement>().value());
    });
    let invalid = props.remarks.iter().any(Remark::is_error).then_some("true");
    let is_known = props.choices.iter().any(|(value, _)| *value == props.value);
    let option = |value: &AttrValue, words: &AttrValue| {
        html! { <option value={value.clone()} selected={*value == props.value}>{ words }</option> }
    };
    html! {
        <FieldRow id={props.id.clone()} label={props.label.clone()} remarks={props.remarks.clone()}>
            <select
                id={props.id.clone()}
                class="input select"
                name={props.name.clone()}
                aria-invalid={invalid}
                aria-describedby={describes(&props.id, &props.remarks, None)}
                {onchange}
            >
                { for props.choices.iter().map(|(value, words)| option(value, words)) }
                if !is_known {
                    { option(&props.value, &props.value) }
                }
            </select>
        </FieldRow>
    }
}
