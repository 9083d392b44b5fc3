//! The write window and the read-only switch, for those who manage; everybody sees them.

use std::rc::Rc;

use cipdeck_shared::api::Role;
use yew::prelude::*;

use super::{
    api, check,
    fetch::use_action,
    i18n::tr,
    kit::{Entry, problem_note},
};
use crate::net::{Writing, rest, session};

/// What the relay says about writing.
#[derive(Clone, Debug, PartialEq, Properties)]
pub(super) struct WritingCardProps {
    /// As it was heard last.
    pub(super) writing: Rc<Writing>,
    /// Asks again.
    pub(super) on_changed: Callback<()>,
}

/// Open, close, and switch to read-only.
#[component]
pub(super) fn WritingCard(props: &WritingCardProps) -> Html {
    let action = use_action();
    let minutes = use_state(|| "15".to_owned());
    let state = &props.writing.state;
    let can_open =
        state.window.is_none() && !state.read_only && session::is_person() && session::may(Role::may_write);
    let wanted = check::number(&minutes, 1, 60);
    let on_open = {
        let (action, done, wanted) = (action.clone(), props.on_changed.clone(), wanted.clone());
        move |event: SubmitEvent| {
            event.prevent_default();
            if let Ok(minutes) = wanted {
                let done = done.clone();
                action.go(rest::open_window(minutes), move |()| done.emit(()));
            }
        }
    };
    let on_read_only = {
        let (action, done) = (action.clone(), props.on_changed.clone());
        move |_: MouseEvent| {
            let done = done.clone();
            action.go(api::set_read_only(), move |()| done.emit(()));
        }
    };
    let words = match (&state.window, state.read_only) {
        (_, true) => tr!("writing.read_only"),
        (Some(window), false) => tr!("writing_card.open", owner = window.owner),
        (None, false) => tr!("writing_card.closed"),
    };
    html! {
        <section class="panel" data-test="writing">
            <h2>{ tr!("writing_card.title") }</h2>
            <p>{ words }</p>
            if let Some(why) = &state.stopped {
                <p class="warning-text">{ tr!("writing.stopped", why = why) }</p>
            }
            if can_open {
                <form class="inline-form" onsubmit={on_open}>
                    { Entry::text("minutes", tr!("window.minutes"), &minutes).problem(wanted.err()).draw() }
                    <button type="submit" class="button danger" disabled={action.is_busy()} data-test="window-open">{ tr!("window.do") }</button>
                </form>
            } else if state.window.is_none() && !state.read_only {
                <p class="hint">{ tr!("window.not_you") }</p>
            }
            if !state.read_only && session::is_person() && session::may(Role::may_send) {
                <button type="button" class="button" onclick={on_read_only} disabled={action.is_busy()} data-test="switch-read-only">
                    { tr!("writing_card.read_only") }
                </button>
                <p class="hint">{ tr!("writing_card.read_only_hint") }</p>
            }
            { problem_note(action.problem().as_ref()) }
        </section>
    }
}
