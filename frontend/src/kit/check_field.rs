//! A BOOL of the configuration.

use yew::prelude::*;

use super::field::{FieldRow, describes};
use crate::editor::Remark;

/// A check box.
#[derive(Clone, Debug, PartialEq, Properties)]
pub struct CheckFieldProps {
    /// Of the input.
    pub id: AttrValue,
    /// Its name in JSON.
    pub name: AttrValue,
    /// Visible name.
    pub label: AttrValue,
    /// TRUE?
    pub checked: bool,
    /// What it does.
    #[prop_or_default]
    pub readout: Option<AttrValue>,
    /// What is to be said about it.
    #[prop_or_default]
    pub remarks: Vec<Remark>,
    /// Hears the new value.
    pub on_change: Callback<bool>,
}

/// A native check box with its findings.
#[component]
pub fn CheckField(props: &CheckFieldProps) -> Html {
    let onchange = use_callback(props.on_change.clone(), |event: Event, on_change| {
        on_change.emit(event.target_unchecked_into::<web_sys::HtmlInputElement>().checked());
    });
    let invalid = props.remarks.iter().any(Remark::is_error).then_some("true");
    html! {
        <FieldRow id={props.id.clone()} label={props.label.clone()} remarks={props.remarks.clone()} readout={props.readout.clone()}>
            <input
                id={props.id.clone()}
                type="checkbox"
                class="check"
                name={props.name.clone()}
                checked={props.checked}
                aria-invalid={invalid}
                aria-describedby={describes(&props.id, &props.remarks, props.readout.as_ref())}
                {onchange}
            />
        </FieldRow>
    }
}
