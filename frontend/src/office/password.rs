//! One's own password.

use cipdeck_shared::api::PasswordChange;
use yew::prelude::*;

use super::{
    api, check,
    fetch::use_action,
    i18n::tr,
    kit::{Entry, problem_note},
};

/// The present one and the new one.
#[component]
pub(super) fn PasswordForm() -> Html {
    let action = use_action();
    let (old, new) = (use_state(String::new), use_state(String::new));
    let (tried, done) = (use_state(|| false), use_state(|| false));
    let problems = [check::needed(&old), check::password(&new)];
    let is_good = problems.iter().all(Option::is_none);
    let onsubmit = {
        let (action, old, new, tried, done) =
            (action.clone(), old.clone(), new.clone(), tried.clone(), done.clone());
        move |event: SubmitEvent| {
            event.prevent_default();
            tried.set(true);
            done.set(false);
            if is_good {
                let change = PasswordChange { old: (*old).clone(), new: (*new).clone() };
                let (old, new, tried, done) = (old.clone(), new.clone(), tried.clone(), done.clone());
                action.go(api::change_password(change), move |()| {
                    old.set(String::new());
                    new.set(String::new());
                    tried.set(false);
                    done.set(true);
                });
            }
        }
    };
    let [old_problem, new_problem] = problems.map(|problem| problem.filter(|_| *tried));
    html! {
        <section class="panel">
            <h2>{ tr!("password.title") }</h2>
            <form {onsubmit}>
                { Entry::password("old-password", tr!("password.old"), &old, "current-password").problem(old_problem).draw() }
                { Entry::password("new-password", tr!("password.new"), &new, "new-password").hint(tr!("set_up.password_hint")).problem(new_problem).draw() }
                { problem_note(action.problem().as_ref()) }
                <button type="submit" class="button" disabled={action.is_busy()}>{ tr!("password.do") }</button>
                if *done {
                    <p role="status" class="hint">{ tr!("password.done") }</p>
                }
            </form>
        </section>
    }
}
