//! How a device is, and what asking it costs.

use cipdeck_shared::{
    api::{DeviceHealth, DeviceLoad, DeviceStatus, HealthState},
    config::Device,
};
use yew::prelude::*;

use crate::{
    devices::{all::profile, i18n::tr, quality::health_mark},
    office::kit::note,
    pages::block::duration,
};

/// Health and load. Not `live`: what was known is not shown as if it still held.
pub(super) fn state(device: &Device, status: Option<&DeviceStatus>, live: bool) -> Html {
    html! {
        <section class="panel" data-test="device-state">
            <h2>{ tr!("health.title") }</h2>
            <p class="health">
                { health_mark(status, live, false) }
                if let Some(status) = status.filter(|_| live) {
                    <span data-test="health-words">{ &status.health.words }</span>
                }
            </p>
            if let Some(status) = status.filter(|_| live) {
                { for status.errors.iter().map(|error| html! { <p class="finding warning">{ error }</p> }) }
                { facts(device, &status.health, status) }
                <h2>{ tr!("load.title") }</h2>
                { load(&status.load) }
                if status.load.is_limited {
                    <p class="warning-text" data-test="limited">{ tr!("load.limited", limit = device.config.max_requests_per_s) }</p>
                }
                if status.health.state == HealthState::Idle {
                    { note(tr!("health.idle_hint")) }
                }
            } else {
                { note(tr!("health.nothing")) }
            }
        </section>
    }
}

fn facts(device: &Device, health: &DeviceHealth, status: &DeviceStatus) -> Html {
    html! {
        <dl class="facts">
            if let Some(identity) = &health.identity {
                <dt>{ tr!("health.product") }</dt><dd>{ &identity.name }</dd>
                <dt>{ tr!("health.vendor") }</dt><dd>{ &identity.vendor }{ ", " }{ &identity.device_type }</dd>
                <dt>{ tr!("health.revision") }</dt>
                <dd class="mono">{ tr!("health.revision_serial", revision = identity.revision, serial = identity.serial) }</dd>
            }
            if let Some(word) = health.status_word {
                <dt>{ tr!("health.status_word") }</dt><dd class="mono">{ format!("0x{word:04X}") }</dd>
            }
            <dt>{ tr!("device.profile") }</dt><dd>{ profile(device, Some(status)) }</dd>
        </dl>
    }
}

fn load(load: &DeviceLoad) -> Html {
    let line =
        |words: AttrValue, value: String| html! { <><dt>{ words }</dt><dd class="mono">{ value }</dd></> };
    html! {
        <dl class="facts numbers-right">
            { line(tr!("load.per_s"), load.requests_per_s.to_string()) }
            { line(tr!("load.per_cycle"), load.requests_per_cycle.to_string()) }
            { line(tr!("load.cycle"), duration(load.cycle_us)) }
            { line(tr!("load.lateness"), duration(load.lateness_us)) }
            { line(tr!("load.skipped"), load.skipped_periods.to_string()) }
            { line(tr!("load.items"), load.items.to_string()) }
            { line(tr!("load.bad"), load.bad_items.to_string()) }
            { line(tr!("load.requests"), load.requests.to_string()) }
        </dl>
    }
}
