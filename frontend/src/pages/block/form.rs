//! The form: every member of the block's inputs, in the manual's groups.

use std::rc::Rc;

use cipdeck_shared::{
    config::{Channel, read_hex},
    plan::{Field, Severity},
};
use yew::prelude::*;

use super::{
    fields::{field_id, flag_member, member_name, number_member},
    subject::{Subject, target_words},
};
use crate::{
    editor::Edit,
    i18n::tr,
    kit::{SelectField, TextField},
};

#[derive(Clone, PartialEq, Properties)]
pub(super) struct FormProps {
    pub(super) subject: Rc<Subject>,
    pub(super) edit: Callback<Edit>,
}

/// Sections; those with findings are open.
#[component]
pub(super) fn Form(props: &FormProps) -> Html {
    let FormProps { subject, edit } = props;
    let config = &subject.draft.config;
    let number = |field| number_member(subject, edit, field);
    let flag = |field| flag_member(subject, edit, field);
    let text = |field: Field, text: &str, readout, placeholder, multiline| {
        let (id, name, label) = (field_id(&field), field.to_string().into(), member_name(&field));
        let (text, remarks) = (text.to_owned().into(), subject.remarks_of(&field));
        let on_text = edit.reform(move |text| Edit::Text(field.clone(), text));
        TextField { id, name, label, text, multiline, readout, placeholder, remarks, on_text }.draw()
    };
    let data = read_hex(&config.req_data).ok().map(|data| tr!("field.byte_count", count = data.len()));
    html! {
        <form class="form" onsubmit={|event: SubmitEvent| event.prevent_default()} data-test="form">
            { section("TargetCfg".into(), true, None, text(
                Field::Path, &config.target_cfg.path, target_words(&config.target_cfg.path), "4,192.168.1.100", false,
            )) }
            { section("AppCfg".into(), true, None, html! { <>
                { number(Field::Service) }
                { number(Field::Class) }
                { number(Field::Instance) }
                { number(Field::Attribute) }
                { number(Field::MemberCnt) }
                { for (0..3).filter(|index| is_shown(subject, *index)).map(|index| number(Field::MemberId(index))) }
                { whole_remarks(subject, &Field::MemberIds) }
            </> }) }
            { section("ReqData / ResData".into(), true, None, html! { <>
                { text(Field::ReqData, &config.req_data, data, "0A 0B 0C", true) }
                { number(Field::ReqLength) }
                { number(Field::ResDataSize) }
            </> }) }
            { section("CtrlCfg".into(), has_remarks(subject, &CTRL), Some(trigger_words(config.ctrl_cfg.trigger_type)), html! { <>
                { number(Field::TriggerType) }
                { flag(Field::Cancel) }
                { number(Field::StrMode) }
                { channel(subject, edit) }
                { flag(Field::Resume) }
            </> }) }
            { section(tr!("form.connection"), has_remarks(subject, &CONNECTION), Some(connection_words(subject)), html! { <>
                { mode(subject, edit) }
                { number(Field::UcmmTimeout) }
                { number(Field::ConnMsgTimeout) }
                { flag(Field::ConnClose) }
            </> }) }
            { unknown(subject) }
        </form>
    }
}

/// `brief` says what is in it while it is closed.
fn section(title: AttrValue, open: bool, brief: Option<AttrValue>, body: Html) -> Html {
    html! {
        <details class="section" {open}>
            <summary>
                <span class="section-title">{ title }</span>
                if let Some(brief) = brief {
                    <span class="section-brief">{ brief }</span>
                }
            </summary>
            <div class="section-body">{ body }</div>
        </details>
    }
}

const CTRL: [Field; 4] = [Field::TriggerType, Field::Cancel, Field::StrMode, Field::Resume];
const CONNECTION: [Field; 4] =
    [Field::CipConnMode, Field::UcmmTimeout, Field::ConnMsgTimeout, Field::ConnClose];

/// Members that are sent, and those with something to say about them.
fn is_shown(subject: &Subject, member: usize) -> bool {
    let sent = usize::try_from(subject.draft.config.app_cfg.member_cnt).unwrap_or(0);
    member < sent || has_remarks(subject, &[Field::MemberId(member)])
}

fn has_remarks(subject: &Subject, fields: &[Field]) -> bool {
    fields.iter().any(|field| !subject.remarks_of(field).is_empty())
}

fn trigger_words(trigger: i64) -> AttrValue {
    match trigger {
        0 => tr!("field.once"),
        1 => tr!("field.fast"),
        ms => tr!("field.every", ms = ms),
    }
}

fn connection_words(subject: &Subject) -> AttrValue {
    let mode = match subject.draft.config.target_cfg.cip_conn_mode {
        0 => tr!("form.unconnected"),
        _ => tr!("form.class_3"),
    };
    let timeout = subject.plan.as_ref().map(|plan| tr!("form.timeout", ms = plan.ucmm_timeout_ms()));
    timeout.map_or(mode.clone(), |timeout| format!("{mode}, {timeout}").into())
}

fn channel(subject: &Subject, edit: &Callback<Edit>) -> Html {
    SelectField {
        id: "field-Channel".into(),
        name: "Channel".into(),
        label: "Channel".into(),
        value: String::from(subject.draft.config.channel).into(),
        choices: [("controller", tr!("form.channel_controller")), ("monitor", tr!("form.channel_monitor"))],
        remarks: Vec::new(),
        on_choice: edit.reform(|value: String| Edit::Channel(Channel::try_from(value).unwrap_or_default())),
    }
    .draw()
}

fn mode(subject: &Subject, edit: &Callback<Edit>) -> Html {
    let field = Field::CipConnMode;
    SelectField {
        id: field_id(&field),
        name: field.to_string().into(),
        label: member_name(&field),
        value: subject.draft.text(&field).into(),
        choices: [("0", tr!("form.mode_0")), ("1", tr!("form.mode_1"))],
        remarks: subject.remarks_of(&field),
        on_choice: edit.reform(|value| Edit::Number(Field::CipConnMode, value)),
    }
    .draw()
}

/// Findings about something that has no input of its own.
fn whole_remarks(subject: &Subject, field: &Field) -> Html {
    subject
        .remarks_of(field)
        .iter()
        .map(|remark| {
            html! {
                <p class="finding error" role="alert">{ &remark.field }{ ": " }{ &remark.text }</p>
            }
        })
        .collect()
}

/// Members of the stored JSON that this version does not know, and the kind if it is another.
fn unknown(subject: &Subject) -> Html {
    let unknown = subject.remarks.iter().filter(|remark| remark.rule.starts_with("unknown_"));
    unknown
        .map(|remark| {
            let class =
                classes!("finding", if remark.severity == Severity::Error { "error" } else { "warning" });
            html! { <p {class}>{ &remark.field }{ ": " }{ &remark.text }</p> }
        })
        .collect()
}
