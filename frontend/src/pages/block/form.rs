//! The form: every member of the block's inputs, in the manual's groups.

use std::rc::Rc;

use cipdeck_shared::{
    config::{Channel, read_hex},
    plan::{Field, Severity},
};
use yew::prelude::*;

use super::{
    fields::{FlagMember, NumberMember, field_id, member_name},
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
    let number =
        |field: Field| html! { <NumberMember subject={subject.clone()} edit={edit.clone()} {field} /> };
    let flag = |field: Field| html! { <FlagMember subject={subject.clone()} edit={edit.clone()} {field} /> };
    let text = |field: Field,
                value: &str,
                readout: Option<AttrValue>,
                placeholder: &'static str,
                multiline: bool| {
        let change = edit.reform({
            let field = field.clone();
            move |text| Edit::Text(field.clone(), text)
        });
        html! {
            <TextField
                id={field_id(&field)} name={field.to_string()} label={member_name(&field)} text={value.to_owned()}
                {readout} {placeholder} {multiline} remarks={subject.remarks_of(&field)} on_text={change}
            />
        }
    };
    let data = read_hex(&config.req_data).ok().map(|data| tr!("field.byte_count", count = data.len()));
    let members = config.app_cfg.member_cnt.clamp(0, 3);
    html! {
        <form class="form" onsubmit={|event: SubmitEvent| event.prevent_default()} data-test="form">
            <Section title="TargetCfg" open=true brief={None::<AttrValue>}>
                { text(Field::Path, &config.target_cfg.path, target_words(&config.target_cfg.path), "4,192.168.1.100", false) }
            </Section>
            <Section title="AppCfg" open=true brief={None::<AttrValue>}>
                { number(Field::Service) }
                { number(Field::Class) }
                { number(Field::Instance) }
                { number(Field::Attribute) }
                { number(Field::MemberCnt) }
                { for (0..3).filter(|index| i64::try_from(*index).is_ok_and(|index| index < members) || has_remarks(subject, &[Field::MemberId(*index)]))
                    .map(|index| number(Field::MemberId(index))) }
                { whole_remarks(subject, &Field::MemberIds) }
            </Section>
            <Section title="ReqData / ResData" open=true brief={None::<AttrValue>}>
                { text(Field::ReqData, &config.req_data, data, "0A 0B 0C", true) }
                { number(Field::ReqLength) }
                { number(Field::ResDataSize) }
            </Section>
            <Section title="CtrlCfg" open={has_remarks(subject, &CTRL)} brief={trigger_words(config.ctrl_cfg.trigger_type)}>
                { number(Field::TriggerType) }
                { flag(Field::Cancel) }
                { number(Field::StrMode) }
                { channel(subject, edit) }
                { flag(Field::Resume) }
            </Section>
            <Section title={tr!("form.connection")} open={has_remarks(subject, &CONNECTION)} brief={connection_words(subject)}>
                { mode(subject, edit) }
                { number(Field::UcmmTimeout) }
                { number(Field::ConnMsgTimeout) }
                { flag(Field::ConnClose) }
            </Section>
            { unknown(subject) }
        </form>
    }
}

#[derive(Clone, PartialEq, Properties)]
struct SectionProps {
    title: AttrValue,
    open: bool,
    /// What is in it, while it is closed.
    brief: Option<AttrValue>,
    children: Html,
}

#[component]
fn Section(props: &SectionProps) -> Html {
    html! {
        <details class="section" open={props.open}>
            <summary>
                <span class="section-title">{ &props.title }</span>
                if let Some(brief) = &props.brief {
                    <span class="section-brief">{ brief }</span>
                }
            </summary>
            <div class="section-body">{ props.children.clone() }</div>
        </details>
    }
}

const CTRL: [Field; 4] = [Field::TriggerType, Field::Cancel, Field::StrMode, Field::Resume];
const CONNECTION: [Field; 4] =
    [Field::CipConnMode, Field::UcmmTimeout, Field::ConnMsgTimeout, Field::ConnClose];

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
    let value = match subject.draft.config.channel {
        Channel::Controller => "controller",
        Channel::Monitor => "monitor",
    };
    let choices = vec![
        ("controller".into(), tr!("form.channel_controller")),
        ("monitor".into(), tr!("form.channel_monitor")),
    ];
    let on_choice = edit.reform(|value: String| {
        Edit::Channel(if value == "monitor" { Channel::Monitor } else { Channel::Controller })
    });
    html! { <SelectField id="field-Channel" name="Channel" label="Channel" {value} {choices} {on_choice} /> }
}

fn mode(subject: &Subject, edit: &Callback<Edit>) -> Html {
    let field = Field::CipConnMode;
    let choices = vec![("0".into(), tr!("form.mode_0")), ("1".into(), tr!("form.mode_1"))];
    let on_choice = edit.reform(|value| Edit::Number(Field::CipConnMode, value));
    html! {
        <SelectField
            id={field_id(&field)} name={field.to_string()} label={member_name(&field)} value={subject.draft.text(&field)}
            {choices} remarks={subject.remarks_of(&field)} {on_choice}
        />
    }
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
