//! One more user.

use cipdeck_shared::api::NewUser;
use yew::prelude::*;

use super::{role, roles};
use crate::office::{
    api, check,
    fetch::use_action,
    i18n::tr,
    kit::{Entry, choice, problem_note},
    overview::may,
};

#[derive(Clone, PartialEq, Properties)]
pub(super) struct AddUserProps {
    pub(super) on_added: Callback<()>,
}

/// Name, role and a first password, which the user changes.
#[component]
pub(super) fn AddUser(props: &AddUserProps) -> Html {
    let action = use_action();
    let (name, password) = (use_state(String::new), use_state(String::new));
    let chosen = use_state(|| "viewer".to_owned());
    let (tried, added) = (use_state(|| false), use_state(|| None::<String>));
    let problems = [check::name(&name), check::password(&password)];
    let is_good = problems.iter().all(Option::is_none);
    let onsubmit = {
        let (action, on_added, tried, added) =
            (action.clone(), props.on_added.clone(), tried.clone(), added.clone());
        let (name, chosen, password) = (name.clone(), chosen.clone(), password.clone());
        move |event: SubmitEvent| {
            event.prevent_default();
            tried.set(true);
            added.set(None);
            if is_good {
                let user =
                    NewUser { name: (*name).clone(), role: role(&chosen), password: (*password).clone() };
                let (on_added, tried, added) = (on_added.clone(), tried.clone(), added.clone());
                let (name, password) = (name.clone(), password.clone());
                action.go(api::add_user(user), move |()| {
                    added.set(Some((*name).clone()));
                    name.set(String::new());
                    password.set(String::new());
                    tried.set(false);
                    on_added.emit(());
                });
            }
        }
    };
    let on_choice = {
        let chosen = chosen.clone();
        Callback::from(move |word: String| chosen.set(word))
    };
    let [name_problem, password_problem] = problems.map(|problem| problem.filter(|_| *tried));
    html! {
        <section class="panel narrow">
            <h2>{ tr!("users.add_title") }</h2>
            <form {onsubmit}>
                { Entry::text("user-name", tr!("users.name"), &name).hint(tr!("set_up.name_hint")).problem(name_problem).draw() }
                { choice("user-role", tr!("users.role"), &chosen, &roles(), on_choice) }
                <p class="hint">{ may(role(&chosen)) }</p>
                { Entry::password("user-password", tr!("users.first_password"), &password, "new-password").hint(tr!("set_up.password_hint")).problem(password_problem).draw() }
                { problem_note(action.problem().as_ref()) }
                <button type="submit" class="button primary" disabled={action.is_busy()} data-test="add-user">{ tr!("users.add") }</button>
                if let Some(name) = &*added {
                    <p role="status" class="hint">{ tr!("users.added", name = name) }</p>
                }
            </form>
        </section>
    }
}
