//! All devices at a glance.

use std::rc::Rc;

use cipdeck_shared::{
    api::{DeviceStatus, Role},
    config::Device,
};
use yew::prelude::*;

use super::{
    i18n::tr,
    live::{Plant, Tree, use_plant},
    quality::health_mark,
    route::{Page, link},
};
use crate::{
    hooks::{use_session, use_title},
    net::session,
    office::kit::note,
    pages::connection::stale_note,
};

#[derive(Clone, PartialEq, Properties)]
pub(super) struct AllProps {
    pub(super) tree: Rc<Tree>,
}

/// One line per device; without any, how to begin.
#[component]
pub(super) fn AllPage(props: &AllProps) -> Html {
    use_title(&tr!("nav.devices"));
    let plant = use_plant();
    use_session();
    let tree = &props.tree;
    if tree.devices.is_empty() {
        return empty();
    }
    html! { <>
        <h1>{ tr!("nav.devices") }</h1>
        { stale_note(&plant.link()) }
        <section class="panel">
            <div class="scroll"><table class="listing devices" aria-label={tr!("nav.devices")}>
                <thead><tr>
                    <th scope="col">{ tr!("device.site") }</th><th scope="col">{ tr!("device.name") }</th>
                    <th scope="col">{ tr!("health.title") }</th><th scope="col">{ tr!("device.path") }</th>
                    <th scope="col">{ tr!("device.profile") }</th><th scope="col" class="num">{ tr!("all.items") }</th>
                    <th scope="col" class="num">{ tr!("all.bad") }</th><th scope="col" class="num">{ tr!("all.per_s") }</th>
                </tr></thead>
                <tbody>{ for tree.devices.iter().map(|device| line(&plant, device)) }</tbody>
            </table></div>
        </section>
    </> }
}

fn line(plant: &Plant, device: &Device) -> Html {
    let status = plant.status(device.id);
    let load = status.as_deref().filter(|_| plant.is_live()).map(|status| status.load);
    let number = |of: fn(&cipdeck_shared::api::DeviceLoad) -> u32| load.as_ref().map(of);
    html! {
        <tr key={device.id.to_string()} data-test="device-line">
            <td>{ &device.config.site }</td>
            <th scope="row">{ link(Page::Device(device.id), "", html! { &device.config.name }) }</th>
            <td>{ health_mark(status.as_deref(), plant.is_live(), false) }</td>
            <td class="mono">{ &device.config.path }</td>
            <td>{ profile(device, status.as_deref()) }</td>
            <td class="num">{ number(|load| load.items) }</td>
            <td class={classes!("num", number(|load| load.bad_items).is_some_and(|bad| bad > 0).then_some("bad"))}>
                { number(|load| load.bad_items) }
            </td>
            <td class="num">{ number(|load| load.requests_per_s) }</td>
        </tr>
    }
}

/// What it was said to be, or what it was found to be.
pub(super) fn profile(device: &Device, status: Option<&DeviceStatus>) -> AttrValue {
    let found = status.map(|status| status.profile.as_str()).filter(|profile| !profile.is_empty());
    match (device.config.profile, found) {
        (cipdeck_shared::config::Profile::Auto, Some(found)) => tr!("device.found_profile", profile = found),
        (profile, _) => profile.word().into(),
    }
}

fn empty() -> Html {
    html! {
        <div class="empty" data-test="no-devices">
            <h1>{ tr!("all.empty") }</h1>
            if session::may(Role::may_edit) {
                <p>{ tr!("all.begin") }</p>
                <p class="empty-do">{ link(Page::New, "button primary link", html! { tr!("tree.new_device") }) }</p>
            } else {
                { note(tr!("all.not_you")) }
            }
        </div>
    }
}
