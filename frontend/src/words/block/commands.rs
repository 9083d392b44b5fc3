//! EN, Run and Cancel. A write is asked for before anything is sent.

use std::rc::Rc;

use cipdeck_shared::api::{BlockStatus, Role};
use yew::{platform::spawn_local, prelude::*};

use super::subject::Subject;
use crate::{
    kit::Switch,
    net::session,
    pages::block::{Key, WriteDialog, use_keys},
    words::{desk::Desk, hooks::use_desk, i18n::tr},
    workbench::{Consent, Intent},
};

#[derive(Clone, PartialEq, Properties)]
pub(super) struct CommandsProps {
    pub(super) subject: Rc<Subject>,
    pub(super) status: Rc<BlockStatus>,
}

/// The commands of a block; Ctrl+Enter runs it, Ctrl+S stores it.
#[component]
pub(super) fn Commands(props: &CommandsProps) -> Html {
    let desk = use_desk();
    let CommandsProps { subject, status } = props;
    let id = subject.id;
    let asked = use_state(|| desk.take_wanted(id));
    let obstacle = subject.obstacle();
    let busy = status.phase.is_busy();
    let can_run = obstacle.is_none() && !busy && !status.input;
    let begin = {
        let (desk, asked, subject) = (desk.clone(), asked.clone(), subject.clone());
        Callback::from(move |intent: Intent| match intent {
            _ if subject.may_write() => ask(&desk, &asked, &subject, intent),
            Intent::Run => desk.run(id, None),
            Intent::SwitchOn => desk.set_en(id, true, None),
        })
    };
    let on_run = begin.reform(|_: MouseEvent| Intent::Run);
    let on_switch = {
        let (desk, begin) = (desk.clone(), begin.clone());
        Callback::from(
            move |on: bool| {
                if on { begin.emit(Intent::SwitchOn) } else { desk.set_en(id, false, None) }
            },
        )
    };
    let on_cancel = use_callback((desk.clone(), id), |_: MouseEvent, (desk, id)| desk.cancel(*id));
    use_keys({
        let (desk, unsaved) = (desk.clone(), subject.no_save().is_none() && subject.errors() == 0);
        let is_open = asked.is_some();
        Callback::from(move |key: Key| match key {
            Key::Run if can_run && !is_open => begin.emit(Intent::Run),
            Key::Save if unsaved && !is_open => desk.save(id),
            _ => {}
        })
    });
    let on_answer = {
        let (desk, asked) = (desk.clone(), asked.clone());
        Callback::from(move |consent: Consent| {
            if let Some(ticket) = consent.ticket() {
                match *asked {
                    Some(Intent::Run) => desk.run(id, Some(ticket)),
                    Some(Intent::SwitchOn) => desk.set_en(id, true, Some(ticket)),
                    None => {}
                }
            }
            asked.set(None);
        })
    };
    let may_command = subject.online && session::may(Role::may_send);
    let words = if subject.is_cyclic() { tr!("run.en_cyclic") } else { tr!("run.en_once") };
    let switch = Switch {
        label: "EN",
        on: status.input,
        disabled: if status.input { !may_command } else { obstacle.is_some() },
        title: obstacle.clone().unwrap_or(words),
        on_switch,
    };
    let dialog = (*asked).zip(subject.plan.clone()).zip(id.stored());
    html! {
        <div class="commands">
            { switch.draw() }
            <button type="button" class="button primary run" disabled={!can_run} title={obstacle.clone()} onclick={on_run} data-test="run">
                { if subject.may_write() { tr!("run.write") } else { tr!("run.run") } }
            </button>
            <button type="button" class="button" disabled={!busy || !may_command} onclick={on_cancel} data-test="cancel">{ tr!("run.cancel") }</button>
            <span class="obstacle" data-test="obstacle">{ obstacle.unwrap_or_default() }</span>
            if let Some(((intent, plan), block)) = dialog {
                <WriteDialog
                    relay={desk.relay().clone()}
                    stored={(block, subject.revision)}
                    {plan}
                    repeats={intent == Intent::SwitchOn && subject.is_cyclic()}
                    {on_answer}
                />
            }
        </div>
    }
}

/// Opens the dialog of a write. The relay writes what is stored, so that comes first.
fn ask(desk: &Desk, asked: &UseStateHandle<Option<Intent>>, subject: &Subject, intent: Intent) {
    if !subject.unsaved {
        return asked.set(Some(intent));
    }
    let (desk, asked, id) = (desk.clone(), asked.clone(), subject.id);
    spawn_local(async move {
        if desk.store_to_write(id, intent).await {
            asked.set(Some(intent));
        }
    });
}
