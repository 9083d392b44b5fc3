//! Who is signed in, always visible.

use cipdeck_shared::api::{ActorKind, Role, SessionState, SessionView};
use yew::{platform::spawn_local, prelude::*};

use super::refused::sign_in_link;
use crate::{i18n::tr, net::session};

/// Name and role, and the way out. `read_only`: the relay writes nothing, whoever asks.
pub fn who(view: Option<&SessionView>, read_only: bool) -> Html {
    let Some(view) = view else { return html! {} };
    let words = match &view.caller {
        Some(caller) => match caller.kind {
            ActorKind::Local => tr!("who.local"),
            ActorKind::ViewLink => tr!("who.view_link", name = caller.name),
            _ => tr!("who.person", name = caller.name, role = role_word(caller.role)),
        },
        None => AttrValue::default(),
    };
    let can_leave = view.caller.as_ref().is_some_and(|caller| caller.csrf.is_some());
    let onclick = |_: MouseEvent| spawn_local(session::sign_out());
    html! {
        <div class="who" data-test="who">
            if read_only {
                <span class="pill" title={tr!("writing.read_only")} data-test="read-only">{ tr!("who.read_only") }</span>
            }
            <span>{ words }</span>
            if can_leave {
                <button type="button" class="quiet-button" {onclick} data-test="sign-out">{ tr!("who.sign_out") }</button>
            } else if view.state == SessionState::SignedOut {
                { sign_in_link("") }
            }
        </div>
    }
}

/// A role in words.
pub fn role_word(role: Role) -> AttrValue {
    match role {
        Role::Viewer => tr!("role.viewer"),
        Role::Operator => tr!("role.operator"),
        Role::Engineer => tr!("role.engineer"),
        Role::Admin => tr!("role.admin"),
    }
}
