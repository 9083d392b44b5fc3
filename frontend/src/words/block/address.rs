//! `Address`: the text as it stands in the program, and what each part of it means.

use cipdeck_shared::{
    config::{AddressPart, PlcAddress, SendReqForm},
    plan::Field,
};
use yew::prelude::*;

use super::{form::field_id, subject::Subject};
use crate::{
    editor::Remark,
    kit::TextField,
    words::{edit::Edit, i18n::tr},
};

/// The field, and its parts or the place where it stops to be an address.
pub(super) fn address(subject: &Subject, edit: &Callback<Edit>) -> Html {
    let config = &subject.draft.config;
    let text = &config.address;
    let field = TextField {
        id: field_id(&Field::Address),
        name: "Address".into(),
        label: "Address".into(),
        text: text.clone().into(),
        multiline: false,
        readout: None,
        placeholder: example(config.form()),
        remarks: subject.remarks_of("Address"),
        on_text: edit.reform(|text| Edit::Text(Field::Address, text)),
    };
    let explained = match PlcAddress::read(text) {
        Ok((_, parts)) => explained(text, &parts),
        Err(error) if !text.trim().is_empty() => marked(text, error.position),
        Err(_) => html! {},
    };
    let has_errors = subject.remarks_of("Address").iter().any(Remark::is_error);
    html! { <>
        { field.draw() }
        { explained }
        if has_errors {
            <p class="beside hint">{ tr!("address.example") }{ " " }<code>{ example(config.form()) }</code></p>
        }
    </> }
}

const fn example(form: SendReqForm) -> &'static str {
    match form {
        SendReqForm::Etc100 => "ADDR('0.2.0.192.168.1.102')",
        SendReqForm::Etc101 => "ADDR('0.4.0')",
        SendReqForm::DataExch => "ADDMX('0.2.0{192.168.1.102}UNC.CIP')",
    }
}

fn explained(text: &str, parts: &[AddressPart]) -> Html {
    let part = |part: &AddressPart| {
        html! {
            <li>
                <code>{ text.get(part.range.clone()).unwrap_or_default() }</code>
                <span>{ &part.text }</span>
            </li>
        }
    };
    html! { <ul class="beside address-parts" data-test="address-parts">{ for parts.iter().map(part) }</ul> }
}

/// The text with the character that is wrong.
pub(super) fn marked(text: &str, position: usize) -> Html {
    let mut characters = text.chars();
    let before: String = characters.by_ref().take(position).collect();
    let wrong = characters.next();
    let after: String = characters.collect();
    html! {
        <p class="beside marked mono" aria-hidden="true" data-test="marked">
            { before }
            <mark>{ wrong.map_or_else(|| "…".to_owned(), String::from) }</mark>
            { after }
        </p>
    }
}
