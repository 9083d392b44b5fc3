//! `Management_Param` as the program sets it: timeout and length.

use cipdeck_shared::plan::Field;
use web_sys::HtmlInputElement;
use yew::prelude::*;

use super::{
    form::{field_id, number},
    subject::Subject,
};
use crate::{
    kit::{describes, field_row},
    words::{edit::Edit, i18n::tr},
};

/// The two words that belong to the program, and a loud word about waiting for ever.
pub(super) fn management(subject: &Subject, edit: &Callback<Edit>) -> Html {
    let config = &subject.draft.config;
    let tenths = config.management_param.get(2).copied().unwrap_or_default();
    let timeout = match tenths {
        0 => tr!("management.for_ever"),
        tenths => tr!("management.timeout", ms = tenths.saturating_mul(100)),
    };
    let whole = subject.remarks_of("Management_Param");
    html! { <>
        <p class="hint">{ tr!("management.hint") }</p>
        { for whole.iter().map(|remark| html! { <p class="finding error" role="alert">{ &remark.text }</p> }) }
        { number(subject, edit, Field::ManagementParam(2), Some(timeout)) }
        if tenths == 0 {
            <p class="loud" role="status" data-test="waits-for-ever">
                <b>{ tr!("management.loud") }</b>{ " " }{ tr!("management.loud_text") }
            </p>
        }
        { length(subject, edit) }
    </> }
}

/// The length follows the words until somebody wants another one.
fn length(subject: &Subject, edit: &Callback<Edit>) -> Html {
    let field = Field::ManagementParam(3);
    let (id, name) = (field_id(&field), AttrValue::from(field.to_string()));
    let remarks = subject.remarks_of(&name);
    let draft = &subject.draft;
    let value = draft.length();
    let readout = (value >= 0).then(|| {
        let (words, half) = (value / 2, value % 2 == 1);
        let bytes = if half {
            tr!("management.bytes_half", words = words)
        } else {
            tr!("management.bytes", words = words)
        };
        AttrValue::from(format!("= 0x{value:02X}  {bytes}"))
    });
    let oninput = edit.reform(|event: InputEvent| {
        let text = event.target_unchecked_into::<HtmlInputElement>().value();
        Edit::Number(Field::ManagementParam(3), text)
    });
    let onchange = edit
        .reform(|event: Event| Edit::AutoLength(event.target_unchecked_into::<HtmlInputElement>().checked()));
    let invalid = remarks.iter().any(crate::editor::Remark::is_error).then_some("true");
    let input = html! { <>
        <input
            id={id.clone()} name={name.clone()} class="input number" value={draft.number(&field)} {oninput}
            disabled={draft.auto_length} autocomplete="off" spellcheck="false"
            aria-invalid={invalid} aria-describedby={describes(&id, &remarks, readout.as_ref())}
        />
        <label class="follows">
            <input type="checkbox" class="check" checked={draft.auto_length} {onchange} data-test="auto-length" />
            { tr!("management.follows") }
        </label>
    </> };
    field_row(&id, &name, &remarks, readout.as_ref(), input)
}
