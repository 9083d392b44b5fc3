//! The form: what the program around the block hands to its pins.

use std::rc::Rc;

use cipdeck_shared::{
    config::SendReqForm,
    plan::{Field, Severity},
};
use yew::prelude::*;

use super::{address::address, data::DataForm, management::management, subject::Subject};
use crate::{
    kit::{CheckField, NumberFieldProps, TextField, number_field},
    pages::block::{channel_field, profile_field},
    words::{edit::Edit, i18n::tr},
};

#[derive(Clone, PartialEq, Properties)]
pub(super) struct FormProps {
    pub(super) subject: Rc<Subject>,
    pub(super) edit: Callback<Edit>,
}

/// One section for each pin; those who may not change blocks can read it.
#[component]
pub(super) fn Form(props: &FormProps) -> Html {
    let FormProps { subject, edit } = props;
    let config = &subject.draft.config;
    let is_data_exch = config.form() == SendReqForm::DataExch;
    // A section that was opened for its findings stays open when they are gone.
    let opened = use_mut_ref(|| false);
    *opened.borrow_mut() |= AROUND.iter().any(|field| !subject.remarks_of(&field.to_string()).is_empty());
    let size = usize::try_from(config.received_data_size).unwrap_or(0);
    html! {
        <form class="form" onsubmit={|event: SubmitEvent| event.prevent_default()} data-test="form">
            if !subject.may_edit {
                <p class="hint" data-test="read-only-form">{ tr!("may.not_edit") }</p>
            }
            <fieldset class="plain" disabled={!subject.may_edit}>
                <section class="section">
                    { address(subject, edit) }
                    { other_remarks(subject) }
                    if is_data_exch {
                        { number(subject, edit, Field::ExchangeType, exchange_words(config.exchange_type)) }
                    } else {
                        { number(subject, edit, Field::RequestCode, request_words(config.request_code)) }
                    }
                </section>
                { section("Data_to_Send".into(), html! { <DataForm subject={subject.clone()} edit={edit.clone()} /> }) }
                { section("Management_Param".into(), management(subject, edit)) }
                { section("Received_Data".into(), number(subject, edit, Field::ReceivedDataSize, Some(tr!("form.words", bytes = 2 * size)))) }
                <details class="section" open={*opened.borrow()}>
                    <summary>
                        <span class="section-title">{ tr!("form.around") }</span>
                        <span class="section-brief">{ period_words(config.period) }</span>
                    </summary>
                    <div class="section-body">{ around(subject, edit) }</div>
                </details>
            </fieldset>
        </form>
    }
}

/// What belongs to the program around the block, and to us.
const AROUND: [Field; 5] =
    [Field::Period, Field::Resume, Field::KeepAlive, Field::ReqLayout, Field::ResLayout];

fn section(title: AttrValue, body: Html) -> Html {
    html! {
        <section class="section">
            <h2 class="section-head">{ title }</h2>
            <div class="section-body">{ body }</div>
        </section>
    }
}

fn around(subject: &Subject, edit: &Callback<Edit>) -> Html {
    let config = &subject.draft.config;
    let layout = |field: Field, text: &str, readout| {
        let (id, name) = (field_id(&field), AttrValue::from(field.to_string()));
        let remarks = subject.remarks_of(&name);
        TextField {
            id,
            label: name.clone(),
            name,
            text: text.to_owned().into(),
            multiline: false,
            readout: Some(readout),
            placeholder: "speed: REAL; run: BOOL",
            remarks,
            on_text: edit.reform(move |text| Edit::Text(field.clone(), text)),
        }
        .draw()
    };
    let resume = CheckField {
        id: "field-Resume".into(),
        name: "Resume".into(),
        label: "Resume".into(),
        checked: config.resume,
        readout: tr!("form.resume"),
        remarks: subject.remarks_of("Resume"),
        on_change: edit.reform(Edit::Resume),
    };
    html! { <>
        { number(subject, edit, Field::Period, Some(period_words(config.period))) }
        { channel_field(config.channel, &edit.reform(Edit::Channel)) }
        { resume.draw() }
        { profile_field(config.profile, &edit.reform(Edit::Profile)) }
        { number(subject, edit, Field::KeepAlive, Some(if config.keep_alive == 0 { tr!("field.no_keep_alive") } else { tr!("field.keep_alive") })) }
        { layout(Field::ReqLayout, &config.req_layout, tr!("form.req_layout")) }
        { layout(Field::ResLayout, &config.res_layout, tr!("form.res_layout")) }
    </> }
}

/// A number member with both radices.
pub(super) fn number(
    subject: &Subject,
    edit: &Callback<Edit>,
    field: Field,
    meaning: Option<AttrValue>,
) -> Html {
    let name = AttrValue::from(field.to_string());
    let remarks = subject.remarks_of(&name);
    // An unreadable text means nothing, whatever was readable before it.
    let meaning = meaning.filter(|_| remarks.iter().all(|remark| !remark.is_error()));
    number_field(&NumberFieldProps {
        id: field_id(&field),
        label: name.clone(),
        name,
        text: subject.draft.number(&field).into(),
        meaning,
        placeholder: None,
        remarks,
        on_text: edit.reform(move |text| Edit::Number(field.clone(), text)),
    })
}

/// `field-Management_Param-2`
pub(super) fn field_id(field: &Field) -> AttrValue {
    let name = field.to_string().replace(['[', '.'], "-").replace(']', "");
    format!("field-{name}").into()
}

/// What has no field here: the kind, its dialect, unknown members.
fn other_remarks(subject: &Subject) -> Html {
    let others = subject.remarks.iter().filter(|remark| {
        matches!(remark.field.as_str(), "kind" | "Dialect") || remark.rule.starts_with("unknown_")
    });
    others
        .map(|remark| {
            let severity = if remark.severity == Severity::Error { "error" } else { "warning" };
            html! { <p class={classes!("finding", severity)}>{ &remark.field }{ ": " }{ &remark.text }</p> }
        })
        .collect()
}

fn period_words(period: i64) -> AttrValue {
    match period {
        0 => tr!("form.once"),
        ms => tr!("form.every", ms = ms),
    }
}

fn request_words(code: i64) -> Option<AttrValue> {
    (code == 14).then_some(tr!("form.cip_request"))
}

fn exchange_words(code: i64) -> Option<AttrValue> {
    (code == 1).then_some(tr!("form.transmission"))
}
