//! The groups of a device, and one more.

use std::rc::Rc;

use cipdeck_shared::{
    api::Role,
    config::{DeviceId, Group, GroupConfig},
};
use yew::prelude::*;

use crate::{
    devices::{
        answer::problem_note,
        api,
        fields::Findings,
        i18n::tr,
        live::Tree,
        route::{self, Page, link},
    },
    net::session,
    office::{
        check,
        fetch::use_action,
        kit::{Entry, note},
    },
};

#[derive(Clone, PartialEq, Properties)]
pub(super) struct GroupsProps {
    pub(super) tree: Rc<Tree>,
    pub(super) device: DeviceId,
}

/// The list, and a form for one more, which is gone to.
#[component]
pub(super) fn Groups(props: &GroupsProps) -> Html {
    let action = use_action();
    let (name, period) = (use_state(String::new), use_state(|| "1000".to_owned()));
    let tried = use_state(|| false);
    let (named, wanted) = (check::needed(&name), check::number(&period, 10, 3_600_000));
    let count = props.tree.groups_of(props.device).count();
    let onsubmit = {
        let (action, tried, name) = (action.clone(), tried.clone(), name.clone());
        let (device, wanted, is_named) = (props.device, wanted.clone(), named.is_none());
        move |event: SubmitEvent| {
            event.prevent_default();
            tried.set(true);
            if let (true, Ok(period)) = (is_named, &wanted) {
                let group = GroupConfig {
                    period_ms: i64::from(*period),
                    order: i64::try_from(count).unwrap_or_default(),
                    ..GroupConfig::new(device, name.trim())
                };
                action.go(api::add_group(group), |group| route::go(Page::Group(group.id)));
            }
        }
    };
    let findings = Findings::of(action.problem());
    html! {
        <section class="panel" data-test="groups">
            <h2>{ tr!("groups.title") }</h2>
            if count == 0 {
                { note(tr!("groups.none")) }
            } else {
                <table class="listing" aria-label={tr!("groups.title")}>
                    <thead><tr><th scope="col">{ tr!("group.name") }</th><th scope="col" class="num">{ tr!("group.period") }</th><th scope="col">{ tr!("group.reading") }</th></tr></thead>
                    <tbody>{ for props.tree.groups_of(props.device).map(line) }</tbody>
                </table>
            }
            if session::may(Role::may_edit) {
                <form class="inline-form" {onsubmit}>
                    { Entry::text("new-group", tr!("groups.new_name"), &name).problem(named.filter(|_| *tried).or_else(|| findings.at("name"))).draw() }
                    { Entry::text("new-group-period", tr!("groups.new_period"), &period).problem(wanted.err().or_else(|| findings.at("period_ms"))).draw() }
                    <button type="submit" class="button" disabled={action.is_busy()} data-test="add-group">{ tr!("groups.add") }</button>
                </form>
                { findings.elsewhere(&["name", "period_ms"]) }
                { problem_note(action.problem().as_ref()) }
            }
        </section>
    }
}

fn line(group: &Group) -> Html {
    html! {
        <tr key={group.id.to_string()} data-test="group-line">
            <th scope="row">{ link(Page::Group(group.id), "", html! { &group.config.name }) }</th>
            <td class="num">{ tr!("group.ms", ms = group.config.period_ms) }</td>
            <td>{ if group.config.on { tr!("group.on") } else { tr!("group.off") } }</td>
        </tr>
    }
}
