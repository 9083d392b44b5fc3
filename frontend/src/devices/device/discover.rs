//! Who is on the network: a click fills the form.

use cipdeck_shared::api::{DiscoverRequest, Discovered, DiscoveredDevice};
use yew::prelude::*;

use super::draft::DeviceDraft;
use crate::{
    devices::{answer::problem_note, api, i18n::tr},
    office::{
        fetch::use_action,
        kit::{Entry, note},
    },
};

#[derive(Clone, PartialEq, Properties)]
pub(super) struct DiscoverProps {
    /// Hears what the form shall hold.
    pub(super) on_take: Callback<DeviceDraft>,
}

/// Asks on the relay's networks, or at addresses.
#[component]
pub(super) fn Discover(props: &DiscoverProps) -> Html {
    let action = use_action();
    let addresses = use_state(String::new);
    let found = use_state(|| None::<Discovered>);
    let onsubmit = {
        let (action, addresses, found) = (action.clone(), addresses.clone(), found.clone());
        move |event: SubmitEvent| {
            event.prevent_default();
            let separated = addresses.split(|c: char| c == ',' || c == ';' || c.is_ascii_whitespace());
            let wanted: Vec<_> = separated.filter(|text| !text.is_empty()).map(str::to_owned).collect();
            let addresses = (!wanted.is_empty()).then_some(wanted);
            let found = found.clone();
            found.set(None);
            action.go(api::discover(DiscoverRequest { addresses, timeout_ms: None }), move |answer| {
                found.set(Some(answer));
            });
        }
    };
    html! {
        <section class="panel" data-test="find">
            <h2>{ tr!("find.title") }</h2>
            <p class="hint">{ tr!("find.hint") }</p>
            <form class="inline-form" {onsubmit}>
                { Entry::text("find-addresses", tr!("find.addresses"), &addresses).hint(tr!("find.addresses_hint")).draw() }
                <button type="submit" class="button" disabled={action.is_busy()} data-test="find-do">
                    { if action.is_busy() { tr!("find.asking") } else { tr!("find.do") } }
                </button>
            </form>
            { problem_note(action.problem().as_ref()) }
            { found.as_ref().map(|found| answered(found, &props.on_take)) }
        </section>
    }
}

fn answered(found: &Discovered, on_take: &Callback<DeviceDraft>) -> Html {
    html! { <>
        { for found.errors.iter().map(|error| html! { <p class="finding warning">{ error }</p> }) }
        if found.devices.is_empty() {
            { note(tr!("find.nobody")) }
        } else {
            <ul class="found">{ for found.devices.iter().map(|device| line(device, on_take)) }</ul>
        }
    </> }
}

fn line(device: &DiscoveredDevice, on_take: &Callback<DeviceDraft>) -> Html {
    let draft = DeviceDraft::found(device);
    let onclick = on_take.reform(move |_: MouseEvent| draft.clone());
    html! {
        <li data-test="found">
            <span>
                <b>{ &device.name }</b>{ " " }<span class="mono quiet">{ format!("{}:{}", device.address, device.port) }</span><br />
                <span class="quiet">{ &device.vendor }{ ", " }{ &device.device_type }{ ", " }{ &device.revision }{ ", " }{ &device.status }</span>
            </span>
            <button type="button" class="button" {onclick}>{ tr!("find.take") }</button>
        </li>
    }
}
