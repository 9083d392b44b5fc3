//! IN, Run and Cancel. A write is asked for before anything is sent.

use std::rc::Rc;

use cipdeck_shared::api::BlockStatus;
use wasm_bindgen::{JsCast, closure::Closure};
use yew::{platform::spawn_local, prelude::*};

use super::{subject::Subject, write_dialog::WriteDialog};
use crate::{
    hooks::use_workbench,
    i18n::tr,
    kit::Switch,
    workbench::{Consent, Intent, Place, Workbench},
};

#[derive(Clone, PartialEq, Properties)]
pub(super) struct CommandsProps {
    pub(super) subject: Rc<Subject>,
    pub(super) status: Rc<BlockStatus>,
}

/// The commands of a block; Ctrl+Enter runs it, Ctrl+S stores it.
#[component]
pub(super) fn Commands(props: &CommandsProps) -> Html {
    let bench = use_workbench();
    let CommandsProps { subject, status } = props;
    let id = subject.id;
    let asked = use_state(|| bench.take_wanted(id));
    let obstacle = subject.obstacle();
    let busy = status.phase.is_busy();
    let can_run = obstacle.is_none() && !busy && !status.input;
    let begin = {
        let (bench, asked, subject) = (bench.clone(), asked.clone(), subject.clone());
        Callback::from(move |intent: Intent| match intent {
            _ if subject.may_write() => ask(&bench, &asked, &subject, intent),
            Intent::Run => bench.run(id, Consent::None),
            Intent::SwitchOn => bench.set_in(id, true, Consent::None),
        })
    };
    let on_run = begin.reform(|_: MouseEvent| Intent::Run);
    let on_switch =
        {
            let (bench, begin) = (bench.clone(), begin.clone());
            Callback::from(move |on: bool| {
                if on { begin.emit(Intent::SwitchOn) } else { bench.set_in(id, false, Consent::None) }
            })
        };
    let on_cancel = use_callback((bench.clone(), id), |_: MouseEvent, (bench, id)| bench.cancel(*id));
    use_keys({
        let (bench, unsaved) = (bench.clone(), subject.unsaved && subject.online && subject.errors() == 0);
        let is_open = asked.is_some();
        Callback::from(move |key: Key| match key {
            Key::Run if can_run && !is_open => begin.emit(Intent::Run),
            Key::Save if unsaved && !is_open => bench.save(id),
            _ => {}
        })
    });
    let on_answer = {
        let (bench, asked) = (bench.clone(), asked.clone());
        Callback::from(move |consent: Consent| {
            if consent != Consent::None {
                match *asked {
                    Some(Intent::Run) => bench.run(id, consent),
                    Some(Intent::SwitchOn) => bench.set_in(id, true, consent),
                    None => {}
                }
            }
            asked.set(None);
        })
    };
    let words = if subject.is_cyclic() { tr!("run.in_cyclic") } else { tr!("run.in_once") };
    let can_stop = !busy || !subject.may_command();
    let switch = Switch {
        label: "IN",
        on: status.input,
        disabled: if status.input { !subject.may_command() } else { obstacle.is_some() },
        title: obstacle.clone().unwrap_or(words),
        on_switch,
    };
    html! {
        <div class="commands">
            { switch.draw() }
            <button type="button" class="button primary run" disabled={!can_run} title={obstacle.clone()} onclick={on_run} data-test="run">
                { if subject.may_write() { tr!("run.write") } else { tr!("run.run") } }
            </button>
            <button type="button" class="button" disabled={can_stop} onclick={on_cancel} data-test="cancel">{ tr!("run.cancel") }</button>
            <span class="obstacle" data-test="obstacle">{ obstacle.unwrap_or_default() }</span>
            if let Some((intent, plan)) = (*asked).zip(subject.plan.as_ref()) {
                <WriteDialog
                    relay={bench.relay().clone()}
                    stored={id.stored().filter(|_| subject.place == Place::Relay).map(|block| (block, subject.revision))}
                    plan={Rc::new(plan.clone())}
                    repeats={intent == Intent::SwitchOn && subject.is_cyclic()}
                    {on_answer}
                />
            }
        </div>
    }
}

/// Opens the dialog of a write. The relay writes what is stored, so that comes first.
fn ask(bench: &Workbench, asked: &UseStateHandle<Option<Intent>>, subject: &Subject, intent: Intent) {
    if subject.place != Place::Relay || !subject.unsaved {
        return asked.set(Some(intent));
    }
    let (bench, asked, id) = (bench.clone(), asked.clone(), subject.id);
    spawn_local(async move {
        if bench.store_to_write(id, intent).await {
            asked.set(Some(intent));
        }
    });
}

/// What a key asks for.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Key {
    Run,
    Save,
}

/// Hears the page's two keys wherever the focus is.
#[hook]
pub(crate) fn use_keys(heard: Callback<Key>) {
    use_effect(move || {
        let listener = Closure::<dyn Fn(KeyboardEvent)>::new(move |event: KeyboardEvent| {
            let key = match event.key().as_str() {
                "Enter" => Key::Run,
                "s" => Key::Save,
                _ => return,
            };
            if event.ctrl_key() || event.meta_key() {
                event.prevent_default();
                heard.emit(key);
            }
        });
        let document = web_sys::window().and_then(|window| window.document());
        let function = listener.as_ref().unchecked_ref();
        if let Some(document) = &document {
            // Refused only for a listener that is there already.
            let _ = document.add_event_listener_with_callback("keydown", function);
        }
        move || {
            if let Some(document) = document {
                let _ = document
                    .remove_event_listener_with_callback("keydown", listener.as_ref().unchecked_ref());
            }
        }
    });
}
