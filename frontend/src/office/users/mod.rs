//! Users: who they are, what they may do, and when they were here last.

mod add;
mod change;

use std::rc::Rc;

use cipdeck_shared::api::{Role, UserView};
use yew::prelude::*;

use self::{add::AddUser, change::ChangeUser};
use super::{
    fetch::use_fetched,
    i18n::tr,
    kit::{Confirm, waiting},
    when,
};
use crate::{access::role_word, hooks::use_title};

/// What is asked about a user.
#[derive(Clone, PartialEq)]
enum Asked {
    Change(Rc<UserView>),
    Remove(Rc<UserView>),
}

/// The list, and a form for one more.
#[component]
pub(super) fn UsersPage() -> Html {
    use_title(&tr!("users.title"));
    let users = use_fetched::<Vec<UserView>>("users".to_owned());
    let asked = use_state(|| None::<Asked>);
    let on_close = {
        let (asked, reload) = (asked.clone(), users.reload.clone());
        Callback::from(move |changed: bool| {
            asked.set(None);
            if changed {
                reload.emit(());
            }
        })
    };
    let line = |user: &UserView| {
        let user = Rc::new(user.clone());
        let ask = |question: fn(Rc<UserView>) -> Asked| {
            let (asked, user) = (asked.clone(), user.clone());
            move |_: MouseEvent| asked.set(Some(question(user.clone())))
        };
        let state = if user.disabled { tr!("users.disabled") } else { tr!("users.enabled") };
        html! {
            <tr key={user.name.clone()} data-test="user">
                <th scope="row">{ &user.name }</th>
                <td>{ role_word(user.role) }</td>
                <td class={user.disabled.then_some("bad")}>{ state }</td>
                <td>{ user.last_sign_in.as_deref().map_or_else(|| tr!("users.never").to_string(), when) }</td>
                <td class="num">{ user.sessions }</td>
                <td class="actions">
                    <button type="button" class="tool" onclick={ask(Asked::Change)}>{ tr!("users.change") }</button>
                    <button type="button" class="tool" onclick={ask(Asked::Remove)}>{ tr!("users.remove") }</button>
                </td>
            </tr>
        }
    };
    html! { <>
        <h1>{ tr!("users.title") }</h1>
        { waiting(&users) }
        if let Some(users) = &users.data {
            <div class="scroll"><table class="listing" aria-label={tr!("users.title")}>
                <thead><tr>
                    <th scope="col">{ tr!("users.name") }</th><th scope="col">{ tr!("users.role") }</th>
                    <th scope="col">{ tr!("users.state") }</th><th scope="col">{ tr!("users.last") }</th>
                    <th scope="col" class="num">{ tr!("users.sessions") }</th><th></th>
                </tr></thead>
                <tbody>{ for users.iter().map(line) }</tbody>
            </table></div>
        }
        <AddUser on_added={users.reload.clone()} />
        { match &*asked {
            None => html! {},
            Some(Asked::Change(user)) => html! { <ChangeUser user={user.clone()} {on_close} /> },
            Some(Asked::Remove(user)) => html! {
                <Confirm
                    title={tr!("users.remove_title")} text={tr!("users.remove_text", name = user.name)}
                    answer={tr!("users.remove")} resource={format!("users/{}", user.name)} {on_close}
                />
            },
        } }
    </> }
}

/// The roles that a user can have, for a choice.
fn roles() -> Vec<(AttrValue, AttrValue)> {
    Role::ALL.iter().map(|role| (role.word().into(), role_word(*role))).collect()
}

/// The role of a word; the one that may least for any other.
pub(super) fn role(word: &str) -> Role {
    Role::ALL.into_iter().find(|role| role.word() == word).unwrap_or(Role::Viewer)
}
