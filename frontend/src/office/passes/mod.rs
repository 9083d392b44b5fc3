//! What opens the relay without a password: API tokens for programs, view links for tablets.

mod link_form;
mod token_form;

use cipdeck_shared::api::PassView;
use yew::prelude::*;

use self::{link_form::LinkForm, token_form::TokenForm};
use super::{
    fetch::use_fetched,
    i18n::tr,
    kit::{Confirm, note, waiting},
    when,
};
use crate::{access::role_word, hooks::use_title};

#[derive(Clone, PartialEq, Properties)]
pub(super) struct PassesProps {
    /// View links, or tokens.
    pub(super) links: bool,
}

/// A form for one more, and the list.
#[component]
pub(super) fn PassesPage(props: &PassesProps) -> Html {
    let links = props.links;
    let (title, resource) =
        if links { (tr!("view_links.title"), "view-links") } else { (tr!("tokens.title"), "tokens") };
    use_title(&title);
    let passes = use_fetched::<Vec<PassView>>(resource.to_owned());
    let asked = use_state(|| None::<(u64, String)>);
    let on_close = {
        let (asked, reload) = (asked.clone(), passes.reload.clone());
        Callback::from(move |revoked: bool| {
            asked.set(None);
            if revoked {
                reload.emit(());
            }
        })
    };
    let line = |pass: &PassView| {
        let onclick = {
            let (asked, of) = (asked.clone(), (pass.id, pass.name.clone()));
            move |_: MouseEvent| asked.set(Some(of.clone()))
        };
        html! { <Line key={pass.id} pass={pass.clone()} {links} {onclick} /> }
    };
    html! { <>
        <h1>{ title.clone() }</h1>
        <p class="lead">{ if links { tr!("view_links.lead") } else { tr!("tokens.lead") } }</p>
        if links {
            <LinkForm on_made={passes.reload.clone()} />
        } else {
            <TokenForm on_made={passes.reload.clone()} />
        }
        { waiting(&passes) }
        if let Some(all) = &passes.data {
            if all.is_empty() {
                { note(if links { tr!("view_links.none") } else { tr!("tokens.none") }) }
            } else {
                <div class="scroll"><table class="listing" aria-label={title}>
                    <thead><tr>
                        <th scope="col">{ tr!("users.name") }</th>
                        if !links {
                            <th scope="col">{ tr!("users.role") }</th><th scope="col">{ tr!("tokens.scope") }</th>
                        }
                        <th scope="col">{ tr!("passes.made_by") }</th><th scope="col">{ tr!("sessions.ends") }</th>
                        <th scope="col">{ tr!("passes.used") }</th><th></th>
                    </tr></thead>
                    <tbody>{ for all.iter().map(line) }</tbody>
                </table></div>
            }
        }
        if let Some((id, name)) = &*asked {
            <Confirm
                title={tr!("passes.revoke_title")} text={tr!("passes.revoke_text", name = name)}
                answer={tr!("passes.revoke")} resource={format!("{resource}/{id}")} {on_close}
            />
        }
    </> }
}

#[derive(Clone, PartialEq, Properties)]
struct LineProps {
    pass: PassView,
    links: bool,
    onclick: Callback<MouseEvent>,
}

#[component]
fn Line(props: &LineProps) -> Html {
    let pass = &props.pass;
    let scope =
        if pass.scope.is_empty() { tr!("tokens.everything").to_string() } else { pass.scope.join(", ") };
    let used = pass.last_used.as_deref().map_or_else(|| tr!("users.never").to_string(), when);
    html! {
        <tr data-test="pass">
            <th scope="row">{ &pass.name }</th>
            if !props.links {
                <td>{ role_word(pass.role) }</td><td class="mono">{ scope }</td>
            }
            <td>{ &pass.created_by }</td><td>{ when(&pass.ends_at) }</td><td>{ used }</td>
            <td class="actions">
                <button type="button" class="tool" onclick={props.onclick.clone()}>{ tr!("passes.revoke") }</button>
            </td>
        </tr>
    }
}
