//! Offers to open the write window, to those who may.

use yew::prelude::*;

use crate::{
    access::window_obstacle,
    devices::{answer::problem_note, i18n::tr, live::use_plant},
    net::rest,
    office::{check, fetch::use_action, kit::Entry},
};

#[derive(Clone, PartialEq, Properties)]
pub(super) struct OpenWindowProps {
    pub(super) on_close: Callback<MouseEvent>,
}

/// Minutes and a button, or why not. That it is open is heard from the relay, as everybody hears it.
#[component]
pub(super) fn OpenWindow(props: &OpenWindowProps) -> Html {
    let plant = use_plant();
    let action = use_action();
    let minutes = use_state(|| "15".to_owned());
    let wanted = check::number(&minutes, 1, 60);
    let obstacle = window_obstacle(&plant.writing().state);
    let onsubmit = {
        let (action, wanted) = (action.clone(), wanted.clone());
        move |event: SubmitEvent| {
            event.prevent_default();
            if let Ok(minutes) = wanted {
                action.go(rest::open_window(minutes), |()| {});
            }
        }
    };
    html! {
        <form {onsubmit}>
            <p>{ tr!("window.text") }</p>
            if let Some(obstacle) = &obstacle {
                <p class="warning-text" data-test="window-obstacle">{ obstacle }</p>
            } else {
                { Entry::text("window-minutes", tr!("window.minutes"), &minutes).problem(wanted.err()).draw() }
            }
            { problem_note(action.problem().as_ref()) }
            <div class="dialog-buttons">
                <button type="button" class="button" onclick={props.on_close.clone()}>{ tr!("dialog.cancel") }</button>
                <button type="submit" class="button danger" disabled={obstacle.is_some() || action.is_busy()} data-test="window-open">{ tr!("window.do") }</button>
            </div>
        </form>
    }
}
