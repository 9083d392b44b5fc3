//! Another role, another password, locked or not.

use std::rc::Rc;

use cipdeck_shared::api::{UserChange, UserView};
use web_sys::HtmlInputElement;
use yew::prelude::*;

use super::{role, roles};
use crate::{
    kit::Dialog,
    office::{
        api, check,
        fetch::use_action,
        i18n::tr,
        kit::{Entry, choice, problem_note},
    },
};

#[derive(Clone, PartialEq, Properties)]
pub(super) struct ChangeUserProps {
    pub(super) user: Rc<UserView>,
    /// Whether something has changed.
    pub(super) on_close: Callback<bool>,
}

/// What is left as it is stays.
#[component]
pub(super) fn ChangeUser(props: &ChangeUserProps) -> Html {
    let action = use_action();
    let user = &props.user;
    let chosen = use_state(|| user.role.word().to_owned());
    let disabled = use_state(|| user.disabled);
    let password = use_state(String::new);
    let problem = check::password(&password).filter(|_| !password.is_empty());
    let change = UserChange {
        role: Some(role(&chosen)).filter(|role| *role != user.role),
        disabled: Some(*disabled).filter(|disabled| *disabled != user.disabled),
        password: Some((*password).clone()).filter(|password| !password.is_empty()),
    };
    let is_good = problem.is_none() && change != UserChange::default();
    let onsubmit = {
        let (action, name, on_close) = (action.clone(), user.name.clone(), props.on_close.clone());
        move |event: SubmitEvent| {
            event.prevent_default();
            if is_good {
                let on_close = on_close.clone();
                action.go(api::change_user(name.clone(), change.clone()), move |()| on_close.emit(true));
            }
        }
    };
    let on_choice = {
        let chosen = chosen.clone();
        Callback::from(move |word: String| chosen.set(word))
    };
    let on_lock = {
        let disabled = disabled.clone();
        move |event: Event| disabled.set(event.target_unchecked_into::<HtmlInputElement>().checked())
    };
    html! {
        <Dialog title={tr!("users.change_title", name = user.name)} test="user-dialog" on_close={props.on_close.reform(|()| false)}>
            <form {onsubmit}>
                { choice("change-role", tr!("users.role"), &chosen, &roles(), on_choice) }
                <label class="check-line" for="change-disabled">
                    <input id="change-disabled" type="checkbox" class="check" checked={*disabled} onchange={on_lock} />
                    { tr!("users.lock") }
                </label>
                { Entry::password("change-password", tr!("users.new_password"), &password, "new-password").hint(tr!("users.new_password_hint")).problem(problem).draw() }
                <p class="hint">{ tr!("users.change_hint") }</p>
                { problem_note(action.problem().as_ref()) }
                <div class="dialog-buttons">
                    <button type="button" class="button" onclick={props.on_close.reform(|_: MouseEvent| false)}>{ tr!("dialog.cancel") }</button>
                    <button type="submit" class="button primary" disabled={!is_good || action.is_busy()} data-test="change-user">{ tr!("users.do_change") }</button>
                </div>
            </form>
        </Dialog>
    }
}
