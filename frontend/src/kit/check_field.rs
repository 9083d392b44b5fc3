//! A BOOL of the configuration.

use web_sys::HtmlInputElement;
use yew::prelude::*;

use super::field::{describes, field_row};
use crate::editor::Remark;

/// A check box.
#[derive(Clone, Debug)]
pub struct CheckField {
    /// Of the input.
    pub id: AttrValue,
    /// Its name in JSON.
    pub name: AttrValue,
    /// Visible name.
    pub label: AttrValue,
    /// TRUE?
    pub checked: bool,
    /// What it does.
    pub readout: AttrValue,
    /// What is to be said about it.
    pub remarks: Vec<Remark>,
    /// Hears the new value.
    pub on_change: Callback<bool>,
}

impl CheckField {
    /// A native check box with its findings.
    pub fn draw(self) -> Html {
        let changed = self.on_change;
        let onchange = move |event: Event| {
            changed.emit(event.target_unchecked_into::<HtmlInputElement>().checked());
        };
        let invalid = self.remarks.iter().any(Remark::is_error).then_some("true");
        let input = html! {
            <input
                id={self.id.clone()}
                type="checkbox"
                class="check"
                name={self.name}
                checked={self.checked}
                aria-invalid={invalid}
                aria-describedby={describes(&self.id, &self.remarks, Some(&self.readout))}
                {onchange}
            />
        };
        field_row(&self.id, &self.label, &self.remarks, Some(&self.readout), input)
    }
}
