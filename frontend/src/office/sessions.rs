//! Who is signed in now.

use cipdeck_shared::api::{ActorKind, SessionEntry};
use yew::prelude::*;

use super::{
    fetch::use_fetched,
    i18n::tr,
    kit::{Confirm, note, waiting},
    when,
};
use crate::{access::role_word, hooks::use_title};

/// All sessions; each can be ended, and then acts no more from that moment on.
#[component]
pub(super) fn SessionsPage() -> Html {
    use_title(&tr!("sessions.title"));
    let sessions = use_fetched::<Vec<SessionEntry>>("sessions".to_owned());
    let asked = use_state(|| None::<(u64, String)>);
    let on_close = {
        let (asked, reload) = (asked.clone(), sessions.reload.clone());
        Callback::from(move |ended: bool| {
            asked.set(None);
            if ended {
                reload.emit(());
            }
        })
    };
    let line = |session: &SessionEntry| {
        let onclick = {
            let (asked, of) = (asked.clone(), (session.id, session.name.clone()));
            move |_: MouseEvent| asked.set(Some(of.clone()))
        };
        let kind = match session.kind {
            ActorKind::ViewLink => tr!("sessions.view_link"),
            ActorKind::Token => tr!("sessions.token"),
            _ => tr!("sessions.person"),
        };
        html! {
            <tr key={session.id} data-test="session">
                <th scope="row">{ &session.name }</th>
                <td>{ kind }{ ", " }{ role_word(session.role) }</td>
                <td class="mono">{ &session.from }</td>
                <td>{ when(&session.started_at) }</td>
                <td>{ when(&session.active_at) }</td>
                <td>{ when(&session.ends_at) }</td>
                <td class="actions"><button type="button" class="tool" {onclick}>{ tr!("sessions.end") }</button></td>
            </tr>
        }
    };
    html! { <>
        <h1>{ tr!("sessions.title") }</h1>
        { waiting(&sessions) }
        if let Some(all) = &sessions.data {
            if all.is_empty() {
                { note(tr!("sessions.none")) }
            } else {
                <div class="scroll"><table class="listing" aria-label={tr!("sessions.title")}>
                    <thead><tr>
                        <th scope="col">{ tr!("users.name") }</th><th scope="col">{ tr!("overview.kind") }</th>
                        <th scope="col">{ tr!("sessions.from") }</th><th scope="col">{ tr!("sessions.started") }</th>
                        <th scope="col">{ tr!("sessions.active") }</th><th scope="col">{ tr!("sessions.ends") }</th><th></th>
                    </tr></thead>
                    <tbody>{ for all.iter().map(line) }</tbody>
                </table></div>
            }
        }
        <button type="button" class="button" onclick={sessions.reload.reform(|_: MouseEvent| ())}>{ tr!("fetch.again") }</button>
        if let Some((id, name)) = &*asked {
            <Confirm
                title={tr!("sessions.end_title")} text={tr!("sessions.end_text", name = name)}
                answer={tr!("sessions.end")} resource={format!("sessions/{id}")} {on_close}
            />
        }
    </> }
}
