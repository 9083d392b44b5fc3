//! The words as text: typed, or pasted from a program.

use std::rc::Rc;

use cipdeck_shared::config::{read_words, write_words};
use wasm_bindgen::JsCast;
use web_sys::HtmlTextAreaElement;
use yew::prelude::*;

use super::address::marked;
use crate::{
    editor::Remark,
    kit::{describes, finding},
    words::{
        edit::{Edit, pasted},
        i18n::tr,
    },
};

#[derive(Clone, PartialEq, Properties)]
pub(super) struct WordTextProps {
    pub(super) text: String,
    pub(super) remarks: Rc<Vec<Remark>>,
    pub(super) edit: Callback<Edit>,
}

/// A text area; a table of a program that is pasted into it becomes words.
#[component]
pub(super) fn WordText(props: &WordTextProps) -> Html {
    let said = use_state(|| None::<AttrValue>);
    let remarks = &props.remarks;
    let oninput = {
        let (edit, said) = (props.edit.clone(), said.clone());
        move |event: InputEvent| {
            said.set(None);
            edit.emit(Edit::Words(event.target_unchecked_into::<HtmlTextAreaElement>().value()));
        }
    };
    let onpaste = {
        let (edit, said) = (props.edit.clone(), said.clone());
        move |event: Event| {
            let Some(text) = event.dyn_ref::<web_sys::ClipboardEvent>().and_then(clipboard) else { return };
            // Anything else is pasted as it is, and says itself what is wrong with it.
            if let Some(words) = pasted(&text) {
                event.prevent_default();
                said.set(Some(tr!("data.pasted", count = words.len())));
                edit.emit(Edit::Words(write_words(&words)));
            }
        }
    };
    let wrong = read_words(&props.text).err();
    let count = read_words(&props.text).map_or(0, |words| words.len());
    let rows = (1 + count / 12).clamp(2, 12);
    let invalid = remarks.iter().any(Remark::is_error).then_some("true");
    html! {
        <div class="word-text">
            <textarea
                id="field-Data_to_Send" name="Data_to_Send" class="input bytes-input" rows={rows.to_string()} value={props.text.clone()}
                placeholder="0000 030E 0120 0124 0730" spellcheck="false" aria-label="Data_to_Send" {oninput} {onpaste}
                aria-invalid={invalid} aria-describedby={describes("field-Data_to_Send", remarks, None)}
            />
            <p class="hint">{ (*said).clone().unwrap_or(tr!("data.words_hint")) }</p>
            if let Some(wrong) = wrong {
                { marked(&props.text, wrong.position) }
            }
            if !remarks.is_empty() {
                <div class="findings" id="field-Data_to_Send-finding">{ for remarks.iter().map(finding) }</div>
            }
        </div>
    }
}

fn clipboard(event: &web_sys::ClipboardEvent) -> Option<String> {
    event.clipboard_data()?.get_data("text/plain").ok()
}
