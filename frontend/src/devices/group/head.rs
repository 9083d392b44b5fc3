//! The group's name, where it belongs, and whether it is read.

use cipdeck_shared::{
    api::{DeviceStatus, HealthState, Role},
    config::{Device, Group, GroupConfig},
};
use yew::prelude::*;

use super::asked::Asked;
use crate::{
    devices::{
        answer::problem_note,
        api,
        i18n::tr,
        live::use_plant,
        quality::health_mark,
        route::{Page, link},
    },
    net::session,
    office::fetch::use_action,
};

#[derive(Clone, PartialEq, Properties)]
pub(super) struct HeadProps {
    pub(super) group: Group,
    pub(super) device: Device,
    pub(super) ask: Callback<Asked>,
}

/// Name, device, period, the switch, and the group's form.
#[component]
pub(super) fn Head(props: &HeadProps) -> Html {
    let HeadProps { group, device, ask } = props;
    let action = use_action();
    let plant = use_plant();
    let status = plant.status(device.id);
    let (on, may) = (group.config.on, session::may(Role::may_edit));
    let onclick = {
        let (action, group) = (action.clone(), group.clone());
        move |_: MouseEvent| {
            let config = GroupConfig { on: !group.config.on, ..group.config.clone() };
            action.go(api::change_group(Group { config, ..group.clone() }), |_| {});
        }
    };
    let trouble = status.as_deref().filter(|_| on && plant.is_live()).and_then(trouble);
    let wish = |asked: Asked| ask.reform(move |_: MouseEvent| asked);
    html! { <>
        <div class="page-head">
            <h1>{ &group.config.name }</h1>
            <span class="page-of">
                { link(Page::Device(device.id), "", html! { &device.config.name }) }
                { health_mark(status.as_deref(), plant.is_live(), false) }
            </span>
            <span class="quiet">{ tr!("group.every", ms = group.config.period_ms) }</span>
            <span class="page-do">
                <button
                    type="button" class="switch" role="switch" aria-checked={if on { "true" } else { "false" }}
                    disabled={!may || action.is_busy()} title={tr!("group.switch_title")} data-test="group-switch" {onclick}
                >
                    <span class="switch-label">{ if on { tr!("group.on") } else { tr!("group.off") } }</span>
                    <span class="switch-track" aria-hidden="true"><span class="switch-knob" /></span>
                </button>
                if may {
                    <button type="button" class="button" onclick={wish(Asked::Settings)} data-test="group-settings">{ tr!("group.settings") }</button>
                    <button type="button" class="button" onclick={wish(Asked::Delete)} data-test="group-delete">{ tr!("group.delete") }</button>
                }
            </span>
        </div>
        if let Some(words) = trouble {
            <p class="finding error" role="status" data-test="device-trouble">{ words.to_owned() }</p>
        }
        { problem_note(action.problem().as_ref()) }
    </> }
}

/// Why there are no values, in words; nothing while the device is well.
fn trouble(status: &DeviceStatus) -> Option<&str> {
    let health = &status.health;
    matches!(health.state, HealthState::Lost | HealthState::Denied | HealthState::Fault)
        .then_some(health.words.as_str())
}
