//! Targets that may be reached.

use cipdeck_shared::api::{AllowedTarget, NewAllowedTarget, Role};
use yew::prelude::*;

use crate::{
    net::session,
    office::{
        api, check,
        fetch::{use_action, use_fetched},
        i18n::tr,
        kit::{Confirm, Entry, note, problem_note, waiting},
    },
};

/// The list, and a form for one more.
#[component]
pub(super) fn Targets() -> Html {
    let targets = use_fetched::<Vec<AllowedTarget>>("allow/targets".to_owned());
    let action = use_action();
    let (target, why) = (use_state(String::new), use_state(String::new));
    let asked = use_state(|| None::<(u64, String)>);
    let may = session::may(Role::may_manage);
    let on_close = {
        let (asked, reload) = (asked.clone(), targets.reload.clone());
        Callback::from(move |removed: bool| {
            asked.set(None);
            if removed {
                reload.emit(());
            }
        })
    };
    let onsubmit = {
        let (action, target, why, reload) =
            (action.clone(), target.clone(), why.clone(), targets.reload.clone());
        move |event: SubmitEvent| {
            event.prevent_default();
            if check::needed(&target).is_none() {
                let new = NewAllowedTarget { target: target.trim().to_owned(), note: why.trim().to_owned() };
                let (target, why, reload) = (target.clone(), why.clone(), reload.clone());
                action.go(api::add_target(new), move |()| {
                    target.set(String::new());
                    why.set(String::new());
                    reload.emit(());
                });
            }
        }
    };
    let line = |entry: &AllowedTarget| {
        let asked = asked.clone();
        let of = entry.id.map(|id| (id, entry.target.clone()));
        html! {
            <tr key={format!("{:?} {}", entry.id, entry.target)} data-test="allowed-target">
                <th scope="row" class="mono">{ &entry.target }</th>
                <td>{ &entry.note }</td>
                <td class="mono">{ entry.pinned.join(", ") }</td>
                <td class="actions">{ match of {
                    None => html! { <span class="quiet">{ tr!("allowed.fixed") }</span> },
                    Some(of) if may => html! {
                        <button type="button" class="tool" onclick={move |_: MouseEvent| asked.set(Some(of.clone()))}>{ tr!("allowed.remove") }</button>
                    },
                    Some(_) => html! {},
                } }</td>
            </tr>
        }
    };
    html! {
        <section class="panel">
            <h2>{ tr!("allowed.targets") }</h2>
            { waiting(&targets) }
            if let Some(all) = &targets.data {
                if all.is_empty() {
                    { note(tr!("allowed.no_targets")) }
                } else {
                    <div class="scroll"><table class="listing" aria-label={tr!("allowed.targets")}>
                        <thead><tr>
                            <th scope="col">{ tr!("allowed.target") }</th><th scope="col">{ tr!("allowed.why") }</th>
                            <th scope="col">{ tr!("allowed.pinned") }</th><th></th>
                        </tr></thead>
                        <tbody>{ for all.iter().map(line) }</tbody>
                    </table></div>
                }
            }
            if may {
                <form class="inline-form" {onsubmit}>
                    { Entry::text("new-target", tr!("allowed.target"), &target).hint(tr!("allowed.target_hint")).draw() }
                    { Entry::text("new-target-note", tr!("allowed.why"), &why).draw() }
                    <button type="submit" class="button primary" disabled={action.is_busy()} data-test="add-target">{ tr!("allowed.add") }</button>
                </form>
                { problem_note(action.problem().as_ref()) }
            } else {
                { note(tr!("allowed.not_you")) }
            }
            if let Some((id, name)) = &*asked {
                <Confirm
                    title={tr!("allowed.remove_title")} text={tr!("allowed.remove_target", name = name)}
                    answer={tr!("allowed.remove")} resource={format!("allow/targets/{id}")} {on_close}
                />
            }
        </section>
    }
}
