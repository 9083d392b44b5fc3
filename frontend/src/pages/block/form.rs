//! The form: every member of the block's inputs, in the manual's groups.

use std::rc::Rc;

use cipdeck_shared::{
    config::read_hex,
    plan::{Field, Severity},
};
use yew::prelude::*;

use super::{
    choices::{channel, mode, profile},
    fields::{field_id, flag_member, member_name, number_member},
    subject::Subject,
    way::way,
};
use crate::{editor::Edit, i18n::tr, kit::TextField};

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
    // A section that was opened for its findings stays open when they are gone.
    let opened = use_mut_ref(|| [false; 2]);
    let stays = |section: usize, open: bool| {
        let mut opened = opened.borrow_mut();
        opened[section] |= open;
        opened[section]
    };
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
            { section("TargetCfg".into(), true, None, html! { <>
                { text(Field::Path, &config.target_cfg.path, way(subject), "4,192.168.1.100", false) }
                { path_help() }
                { mode(subject, edit) }
            </> }) }
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
            { section("CtrlCfg".into(), stays(0, has_remarks(subject, &CTRL)), Some(trigger_words(config.ctrl_cfg.trigger_type)), html! { <>
                { number(Field::TriggerType) }
                { flag(Field::Cancel) }
                { number(Field::StrMode) }
                { channel(subject, edit) }
                { flag(Field::Resume) }
            </> }) }
            { section(tr!("form.connection"), stays(1, opens_connection(subject)), Some(connection_words(subject)), html! { <>
                { number(Field::UcmmTimeout) }
                { number(Field::ConnMsgTimeout) }
                { flag(Field::ConnClose) }
                { profile(subject, edit) }
                { number(Field::KeepAlive) }
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
    [Field::UcmmTimeout, Field::ConnMsgTimeout, Field::ConnClose, Field::KeepAlive];

/// A connection has times of its own.
fn opens_connection(subject: &Subject) -> bool {
    subject.draft.config.target_cfg.cip_conn_mode == 1 || has_remarks(subject, &CONNECTION)
}

/// What can be written as a path, by examples.
fn path_help() -> Html {
    let example = |path: &'static str, meaning: AttrValue| {
        html! { <><dt class="mono">{ path }</dt><dd>{ meaning }</dd></> }
    };
    html! {
        <details class="path-help" data-test="path-help">
            <summary>{ tr!("path.title") }</summary>
            <dl>
                { example("4,192.168.1.100", tr!("path.direct")) }
                { example("4,192.168.1.100,1,0", tr!("path.slot")) }
                { example("4,192.168.1.100,2,10.0.0.5", tr!("path.link")) }
                { example("4,192.168.1.100,1,3,2,10.0.0.5", tr!("path.three")) }
                { example("0,0", tr!("path.built_in")) }
            </dl>
        </details>
    }
}

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
    let Some(plan) = &subject.plan else { return AttrValue::default() };
    let ms = plan.connection().map_or(plan.ucmm_timeout_ms(), |connection| connection.timeout_ms);
    tr!("form.timeout", ms = ms)
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
