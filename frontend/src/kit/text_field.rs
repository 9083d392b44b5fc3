//! A text, on one line or on several.

use yew::prelude::*;

use super::field::{FieldRow, describes};
use crate::editor::Remark;

/// A text field.
#[derive(Clone, Debug, PartialEq, Properties)]
pub struct TextFieldProps {
    /// Of the input.
    pub id: AttrValue,
    /// Its name in JSON.
    pub name: AttrValue,
    /// Visible name.
    pub label: AttrValue,
    /// As typed.
    pub text: AttrValue,
    /// Several lines.
    #[prop_or_default]
    pub multiline: bool,
    /// What the text means.
    #[prop_or_default]
    pub readout: Option<AttrValue>,
    /// Shown while nothing is typed.
    #[prop_or_default]
    pub placeholder: Option<AttrValue>,
    /// What is to be said about it.
    #[prop_or_default]
    pub remarks: Vec<Remark>,
    /// Hears every change of the text.
    pub on_text: Callback<String>,
}

/// A text input with its findings.
#[component]
pub fn TextField(props: &TextFieldProps) -> Html {
    let on_text = props.on_text.clone();
    let oninput = use_callback((on_text, props.multiline), |event: InputEvent, (on_text, multiline)| {
        on_text.emit(if *multiline {
            event.target_unchecked_into::<web_sys::HtmlTextAreaElement>().value()
        } else {
            event.target_unchecked_into::<web_sys::HtmlInputElement>().value()
        });
    });
    let invalid = props.remarks.iter().any(Remark::is_error).then_some("true");
    let described = describes(&props.id, &props.remarks, props.readout.as_ref());
    let (id, name, value) = (props.id.clone(), props.name.clone(), props.text.clone());
    let placeholder = props.placeholder.clone();
    html! {
        <FieldRow id={props.id.clone()} label={props.label.clone()} remarks={props.remarks.clone()} readout={props.readout.clone()}>
            if props.multiline {
                <textarea
                    {id} {name} {value} {placeholder} {oninput}
                    class="input bytes-input" rows="2" spellcheck="false"
                    aria-invalid={invalid} aria-describedby={described}
                />
            } else {
                <input
                    {id} {name} {value} {placeholder} {oninput}
                    class="input text" autocomplete="off" spellcheck="false"
                    aria-invalid={invalid} aria-describedby={described}
                />
            }
        </FieldRow>
    }
}
