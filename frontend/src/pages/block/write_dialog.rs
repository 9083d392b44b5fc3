//! Asks before something is written to a device: what, where, and the bytes themselves.

use std::rc::Rc;

use cipdeck_shared::{
    plan::{MessagePlan, TriggerType},
    table::{self, Access},
    wire::ServiceCode,
};
use yew::prelude::*;

use super::subject::Subject;
use crate::{editor::hexadecimal, i18n::tr, kit::Dialog};

/// What is about to happen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Intent {
    /// One message.
    Run,
    /// IN goes TRUE.
    SwitchOn,
}

#[derive(Clone, PartialEq, Properties)]
pub(super) struct WriteDialogProps {
    pub(super) intent: Intent,
    pub(super) subject: Rc<Subject>,
    /// Whether a person has confirmed.
    pub(super) on_answer: Callback<bool>,
}

/// Confirmed once; a write that repeats itself, twice.
#[component]
pub(super) fn WriteDialog(props: &WriteDialogProps) -> Html {
    let repeats = props.intent == Intent::SwitchOn && props.subject.is_cyclic();
    let confirmed_once = use_state(|| false);
    let onsubmit = {
        let (on_answer, confirmed_once) = (props.on_answer.clone(), confirmed_once.clone());
        Callback::from(move |event: SubmitEvent| {
            event.prevent_default();
            if repeats && !*confirmed_once {
                confirmed_once.set(true);
            } else {
                on_answer.emit(true);
            }
        })
    };
    let Some(plan) = &props.subject.plan else { return html! {} };
    let (title, confirm) = match (*confirmed_once, repeats) {
        (true, _) => (tr!("write.cyclic_title"), tr!("write.cyclic_do")),
        (false, true) => (tr!("write.title"), tr!("write.next")),
        (false, false) => (tr!("write.title"), tr!("write.do")),
    };
    html! {
        <Dialog {title} test="write-dialog" on_close={props.on_answer.reform(|()| false)}>
            <form {onsubmit}>
                if *confirmed_once {
                    <p class="warning-text">{ every(plan) }</p>
                } else {
                    { what(&props.subject, plan) }
                }
                <div class="dialog-buttons">
                    <button type="button" class="button" autofocus=true data-test="write-cancel"
                        onclick={props.on_answer.reform(|_: MouseEvent| false)}>{ tr!("dialog.cancel") }</button>
                    <button type="submit" class="button danger" data-test="write-confirm">{ confirm }</button>
                </div>
            </form>
        </Dialog>
    }
}

fn every(plan: &MessagePlan) -> AttrValue {
    match plan.trigger() {
        TriggerType::Every(ms) => tr!("write.cyclic", ms = ms),
        TriggerType::Once | TriggerType::Fast => tr!("write.fast"),
    }
}

fn what(subject: &Subject, plan: &MessagePlan) -> Html {
    let app = &subject.draft.config.app_cfg;
    let class = u16::try_from(app.class).unwrap_or_default();
    let service = ServiceCode(u8::try_from(app.service).unwrap_or_default());
    let name = table::service(class, service).map_or("", |entry| entry.name);
    let class_name = table::class(class).map_or("", |entry| entry.name);
    let access = match plan.access() {
        Access::Write => tr!("write.access_write"),
        Access::Unknown | Access::Read => tr!("write.access_unknown"),
    };
    let bytes: Vec<_> = plan.bytes().iter().map(|byte| format!("{byte:02X}")).collect();
    let number = |value: i64| format!("{value} = {}", hexadecimal(value));
    html! { <>
        <p>{ access }</p>
        <dl class="facts">
            <dt>{ tr!("write.target") }</dt><dd>{ plan.target().to_string() }</dd>
            <dt>{ tr!("write.service") }</dt><dd>{ number(app.service) }{ " " }{ name }</dd>
            <dt>{ tr!("write.path") }</dt>
            <dd>
                { tr!("write.object", class = number(app.class), name = class_name, instance = number(app.instance), attribute = number(app.attribute)) }
            </dd>
            <dt>{ tr!("write.bytes") }</dt><dd class="mono" data-test="write-bytes">{ bytes.join(" ") }</dd>
        </dl>
    </> }
}
