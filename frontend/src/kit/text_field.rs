//! A text, on one line or on several.

use web_sys::{HtmlInputElement, HtmlTextAreaElement};
use yew::prelude::*;

use super::field::{describes, field_row};
use crate::editor::Remark;

/// A text field.
#[derive(Clone, Debug)]
pub struct TextField {
    /// Of the input.
    pub id: AttrValue,
    /// Its name in JSON.
    pub name: AttrValue,
    /// Visible name.
    pub label: AttrValue,
    /// As typed.
    pub text: AttrValue,
    /// Several lines.
    pub multiline: bool,
    /// What the text means.
    pub readout: Option<AttrValue>,
    /// Shown while nothing is typed.
    pub placeholder: &'static str,
    /// What is to be said about it.
    pub remarks: Vec<Remark>,
    /// Hears every change of the text.
    pub on_text: Callback<String>,
}

impl TextField {
    /// A text input with its findings.
    pub fn draw(self) -> Html {
        let invalid = self.remarks.iter().any(Remark::is_error).then_some("true");
        let described = describes(&self.id, &self.remarks, self.readout.as_ref());
        let (id, name, value) = (self.id.clone(), self.name, self.text);
        let (on_text, placeholder) = (self.on_text, self.placeholder);
        let input = if self.multiline {
            let oninput = move |event: InputEvent| {
                on_text.emit(event.target_unchecked_into::<HtmlTextAreaElement>().value());
            };
            html! {
                <textarea
                    {id} {name} {value} {placeholder} {oninput}
                    class="input bytes-input" rows="2" spellcheck="false"
                    aria-invalid={invalid} aria-describedby={described}
                />
            }
        } else {
            let oninput = move |event: InputEvent| {
                on_text.emit(event.target_unchecked_into::<HtmlInputElement>().value());
            };
            html! {
                <input
                    {id} {name} {value} {placeholder} {oninput}
                    class="input text" autocomplete="off" spellcheck="false"
                    aria-invalid={invalid} aria-describedby={described}
                />
            }
        };
        field_row(&self.id, &self.label, &self.remarks, self.readout.as_ref(), input)
    }
}
