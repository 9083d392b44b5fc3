//! IN, Run and Cancel. A write is asked for before anything is sent.

use std::rc::Rc;

use cipdeck_shared::api::BlockStatus;
use wasm_bindgen::{JsCast, closure::Closure};
use yew::prelude::*;

use super::{
    subject::Subject,
    write_dialog::{Intent, WriteDialog},
};
use crate::{hooks::use_workbench, i18n::tr, kit::Switch};

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
    let asked = use_state(|| None::<(Intent, Rc<Subject>)>);
    let obstacle = subject.obstacle();
    let busy = status.phase.is_busy();
    let can_run = obstacle.is_none() && !busy && !status.input;
    let begin = {
        let (bench, asked, subject) = (bench.clone(), asked.clone(), subject.clone());
        Callback::from(move |intent: Intent| match intent {
            _ if subject.may_write() => asked.set(Some((intent, subject.clone()))),
            Intent::Run => bench.run(id, None),
            Intent::SwitchOn => bench.set_in(id, true, None),
        })
    };
    let on_run = begin.reform(|_: MouseEvent| Intent::Run);
    let on_switch = {
        let (bench, begin) = (bench.clone(), begin.clone());
        Callback::from(
            move |on: bool| if on { begin.emit(Intent::SwitchOn) } else { bench.set_in(id, false, None) },
        )
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
        let asked = asked.clone();
        Callback::from(move |confirmed: bool| {
            if let (true, Some((intent, subject))) = (confirmed, &*asked) {
                match intent {
                    Intent::Run => bench.run(id, Some(subject.revision)),
                    Intent::SwitchOn => bench.set_in(id, true, Some(subject.revision)),
                }
            }
            asked.set(None);
        })
    };
    let switch = Switch {
        label: "IN",
        on: status.input,
        disabled: obstacle.is_some() && !status.input,
        title: if subject.is_cyclic() { tr!("run.in_cyclic") } else { tr!("run.in_once") },
        on_switch,
    };
    html! {
        <div class="commands">
            { switch.draw() }
            <button type="button" class="button primary run" disabled={!can_run} onclick={on_run} data-test="run">
                { if subject.may_write() { tr!("run.write") } else { tr!("run.run") } }
            </button>
            <button type="button" class="button" disabled={!busy} onclick={on_cancel} data-test="cancel">{ tr!("run.cancel") }</button>
            <span class="obstacle" data-test="obstacle">{ obstacle.unwrap_or_default() }</span>
            if let Some((intent, subject)) = &*asked {
                <WriteDialog intent={*intent} subject={subject.clone()} {on_answer} />
            }
        </div>
    }
}

#[derive(Clone, Copy, PartialEq)]
enum Key {
    Run,
    Save,
}

/// Hears the page's two keys wherever the focus is.
#[hook]
fn use_keys(heard: Callback<Key>) {
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
