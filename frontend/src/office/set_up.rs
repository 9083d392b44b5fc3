//! The first administrator.

use std::rc::Rc;

use cipdeck_shared::api::{Problem, SessionState, SessionView, SetUp};
use yew::prelude::*;

use super::{
    api, check,
    fetch::use_action,
    i18n::tr,
    kit::{Entry, problem_note},
    overview::fingerprint,
    route::{Page, link},
};
use crate::{
    address,
    hooks::{use_session, use_title},
};

/// Code, name and password; then where the relay is found from now on.
#[component]
pub(super) fn SetUpPage() -> Html {
    use_title(&tr!("set_up.title"));
    let view = use_session();
    let action = use_action();
    let done = use_state(|| None::<Rc<SessionView>>);
    let (code, name, password) = (use_state(String::new), use_state(String::new), use_state(String::new));
    let tried = use_state(|| false);
    if let Some(before) = &*done {
        return moved(before);
    }
    let Some(view) = view else { return html! {} };
    if view.state != SessionState::SetUp {
        return html! {
            <section class="card">
                <h1>{ tr!("set_up.title") }</h1>
                <p>{ tr!("set_up.done_already") }</p>
                <p>{ link(Page::SignIn, "", html! { tr!("who.sign_in") }) }</p>
            </section>
        };
    }
    let problems = [check::code(&code), check::name(&name), check::password(&password)];
    let is_good = problems.iter().all(Option::is_none);
    let onsubmit = {
        let (code, name, password) = (code.clone(), name.clone(), password.clone());
        let (action, view, tried) = (action.clone(), view.clone(), tried.clone());
        move |event: SubmitEvent| {
            event.prevent_default();
            tried.set(true);
            if !is_good {
                return;
            }
            let form = SetUp { code: (*code).clone(), name: (*name).clone(), password: (*password).clone() };
            let (done, view) = (done.clone(), view.clone());
            action.go(api::set_up(form), move |()| match view.moves_to {
                Some(_) => done.set(Some(view)),
                None => address::load("/office/users"),
            });
        }
    };
    let refused = action.problem();
    let (wrong_code, other) = place(refused);
    let [code_problem, name_problem, password_problem] = problems.map(|problem| problem.filter(|_| *tried));
    html! {
        <section class="card">
            <h1>{ tr!("set_up.title") }</h1>
            <p class="lead">{ tr!("set_up.lead") }</p>
            <form {onsubmit}>
                { Entry::text("code", tr!("set_up.code"), &code).hint(tr!("set_up.code_hint")).problem(code_problem.or(wrong_code)).draw() }
                { Entry { autocomplete: "username", ..Entry::text("name", tr!("set_up.name"), &name).hint(tr!("set_up.name_hint")).problem(name_problem) }.draw() }
                { Entry::password("password", tr!("set_up.password"), &password, "new-password").hint(tr!("set_up.password_hint")).problem(password_problem).draw() }
                { problem_note(other.as_ref()) }
                if let Some(to) = &view.moves_to {
                    <p class="hint" data-test="moves-to">{ tr!("set_up.moves_to", address = to) }</p>
                }
                { fingerprint(view.fingerprint.as_deref()) }
                <button type="submit" class="button primary wide" disabled={action.is_busy()} data-test="set-up">{ tr!("set_up.do") }</button>
            </form>
        </section>
    }
}

/// A refusal belongs to the code, or to the whole form.
fn place(refused: Option<Rc<Problem>>) -> (Option<AttrValue>, Option<Rc<Problem>>) {
    match refused {
        Some(problem) if problem.status == FORBIDDEN => (Some(problem.detail.clone().into()), None),
        other => (None, other),
    }
}

/// HTTP.
const FORBIDDEN: u16 = 403;

/// The relay has an administrator, and answers elsewhere.
fn moved(before: &SessionView) -> Html {
    let to = before.moves_to.clone().unwrap_or_default();
    html! {
        <section class="card" data-test="moved">
            <h1>{ tr!("set_up.done") }</h1>
            <p>{ tr!("set_up.moved") }</p>
            <p><a class="moved-to" href={to.clone()}>{ to }</a></p>
            { fingerprint(before.fingerprint.as_deref()) }
            if before.fingerprint.is_some() {
                <p class="hint">{ tr!("set_up.compare") }</p>
            }
        </section>
    }
}
