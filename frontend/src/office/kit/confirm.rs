//! Asks before something is removed, ended or revoked.

use yew::prelude::*;

use super::problem_note;
use crate::{
    kit::Dialog,
    office::{api, fetch::use_action, i18n::tr},
};

/// A question with one way back.
#[derive(Clone, Debug, PartialEq, Properties)]
pub struct ConfirmProps {
    /// What it is about.
    pub title: AttrValue,
    /// What will happen.
    pub text: AttrValue,
    /// The button that does it.
    pub answer: AttrValue,
    /// The address of what goes.
    pub resource: AttrValue,
    /// Closes it; TRUE when it is gone.
    pub on_close: Callback<bool>,
}

/// The dialog; it does what it asks about.
#[component]
pub fn Confirm(props: &ConfirmProps) -> Html {
    let action = use_action();
    let onsubmit = {
        let (action, resource, on_close) =
            (action.clone(), props.resource.to_string(), props.on_close.clone());
        move |event: SubmitEvent| {
            event.prevent_default();
            let on_close = on_close.clone();
            action.go(api::remove(resource.clone()), move |()| on_close.emit(true));
        }
    };
    html! {
        <Dialog title={props.title.clone()} test="confirm-dialog" on_close={props.on_close.reform(|()| false)}>
            <form {onsubmit}>
                <p>{ &props.text }</p>
                { problem_note(action.problem().as_ref()) }
                <div class="dialog-buttons">
                    <button type="button" class="button" autofocus=true onclick={props.on_close.reform(|_: MouseEvent| false)}>
                        { tr!("dialog.cancel") }
                    </button>
                    <button type="submit" class="button danger" disabled={action.is_busy()} data-test="confirm">{ &props.answer }</button>
                </div>
            </form>
        </Dialog>
    }
}
