//! `ReqData` as its layout has it: an input for each field.

use cipdeck_shared::{
    config::{read_hex, write_hex},
    tag::{DataField, DataFields},
};
use web_sys::HtmlInputElement;
use yew::prelude::*;

use crate::office::{i18n::tr, kit::note};

#[derive(Clone, PartialEq, Properties)]
pub(super) struct RequestFieldsProps {
    pub(super) layout: String,
    /// Hexadecimal.
    pub(super) data: String,
    pub(super) on_data: Callback<String>,
}

/// Nothing without a layout that can be read.
#[component]
pub(super) fn RequestFields(props: &RequestFieldsProps) -> Html {
    // The field that is being typed into keeps its text, also while it is no value.
    let typing = use_state(|| None::<(usize, String)>);
    let Ok(fields) = DataFields::read(&props.layout) else { return html! {} };
    let Ok(data) = read_hex(&props.data) else { return note(tr!("data.unreadable")) };
    let row = |(place, field): (usize, &DataField)| {
        let typed = typing.as_ref().filter(|(at, _)| *at == place).map(|(_, text)| text.clone());
        let held = || field.text(&data).unwrap_or_default();
        let text = typed.unwrap_or_else(held);
        let refused = if text.is_empty() { None } else { field.write(&mut data.clone(), &text).err() };
        let oninput = {
            let (field, data) = (field.clone(), data.clone());
            let (typing, on_data) = (typing.clone(), props.on_data.clone());
            move |event: InputEvent| {
                let text = event.target_unchecked_into::<HtmlInputElement>().value();
                let mut data = data.clone();
                if field.write(&mut data, &text).is_ok() {
                    on_data.emit(write_hex(&data));
                }
                typing.set(Some((place, text)));
            }
        };
        let id = format!("field-{place}");
        let said = format!("{id}-said");
        let name = if field.name.is_empty() { field.type_name() } else { field.name.clone() };
        html! {
            <div class="entry-line">
                <label for={id.clone()}>{ name }<span class="hint">{ format!(" {}", field.type_name()) }</span></label>
                <input
                    id={id} class="input mono" value={text} {oninput} autocomplete="off" spellcheck="false"
                    aria-invalid={refused.is_some().then_some("true")} aria-describedby={refused.is_some().then(|| said.clone())}
                />
                if let Some(refused) = &refused {
                    <p id={said} class="finding error" role="alert">{ refused.to_string() }</p>
                }
            </div>
        }
    };
    html! { <div class="data-fields" data-test="fields">{ for fields.each().iter().enumerate().map(row) }</div> }
}
