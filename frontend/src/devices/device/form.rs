//! What people enter about a device.

use cipdeck_shared::config::{Connecting, Device, Profile};
use yew::prelude::*;

use super::draft::{DeviceDraft, DeviceProblems};
use crate::{
    devices::{
        answer::problem_note,
        api,
        fields::{Findings, Said, area, bound, text},
        i18n::tr,
        route::{self, Page},
    },
    office::{fetch::use_action, kit::choice},
};

#[derive(Clone, PartialEq, Properties)]
pub(super) struct DeviceFormProps {
    /// The device that is changed; without one a new one is made.
    pub(super) stored: Option<Device>,
    /// What the form begins with.
    pub(super) draft: DeviceDraft,
}

/// Name, site, path, kind, connection and limits. A new device is gone to; a changed one comes back from the relay.
#[component]
pub(super) fn DeviceForm(props: &DeviceFormProps) -> Html {
    let action = use_action();
    let draft = use_state(|| props.draft.clone());
    // What the form began with: a change names the revision that was seen.
    let seen = use_state(|| (props.stored.clone(), props.draft.clone()));
    let tried = use_state(|| false);
    let is_changed = *draft != seen.1;
    use_effect_with((props.stored.clone(), props.draft.clone()), {
        let (draft, seen) = (draft.clone(), seen.clone());
        move |newer| {
            // What somebody is typing stays.
            if !is_changed && *seen != *newer {
                draft.set(newer.1.clone());
                seen.set(newer.clone());
            }
        }
    });
    let read = draft.read();
    let wrong = read.as_ref().err().filter(|_| *tried).cloned().unwrap_or_default();
    let onsubmit = {
        let (action, tried, stored) = (action.clone(), tried.clone(), seen.0.clone());
        let (draft, seen) = (draft.clone(), seen.clone());
        move |event: SubmitEvent| {
            event.prevent_default();
            tried.set(true);
            match (&read, &stored) {
                (Ok(config), Some(old)) => {
                    action.go(api::change_device(Device { config: config.clone(), ..old.clone() }), {
                        let (draft, seen) = (draft.clone(), seen.clone());
                        move |device| {
                            let stored = DeviceDraft::of(&device.config);
                            draft.set(stored.clone());
                            seen.set((Some(device), stored));
                        }
                    });
                }
                (Ok(config), None) => {
                    action.go(api::add_device(config.clone()), |device| route::go(Page::Device(device.id)));
                }
                (Err(_), _) => {}
            }
        }
    };
    let is_new = props.stored.is_none();
    let words = if is_new { tr!("device.add") } else { tr!("form.store") };
    html! {
        <form class="grid-form" {onsubmit} data-test="device-form">
            { fields(&draft, &wrong, &Findings::of(action.problem())) }
            { problem_note(action.problem().as_ref()) }
            <button type="submit" class="button primary" disabled={action.is_busy() || !(is_changed || is_new)} data-test="store-device">{ words }</button>
        </form>
    }
}

/// The members that have a field here.
const FIELDS: [&str; 8] =
    ["name", "site", "path", "profile", "connection", "timeout_ms", "max_requests_per_s", "types"];

fn fields(draft: &UseStateHandle<DeviceDraft>, wrong: &DeviceProblems, findings: &Findings) -> Html {
    let (profile, on_profile) = bound(draft, |draft| &mut draft.profile);
    let (connection, on_connection) = bound(draft, |draft| &mut draft.connection);
    let (types, on_types) = bound(draft, |draft| &mut draft.types);
    let profiles = Profile::ALL.map(|profile| (profile.word().into(), profile_words(profile)));
    let connections = Connecting::ALL.map(|it| (it.word().into(), connection_words(it)));
    let said = |wrong: &Option<AttrValue>, field: &str| wrong.clone().or_else(|| findings.at(field));
    html! { <>
        { text(draft, "device-name", tr!("device.name"), |draft| &mut draft.name).problem(said(&wrong.name, "name")).draw() }
        { text(draft, "device-site", tr!("device.site"), |draft| &mut draft.site).hint(tr!("device.site_hint")).problem(findings.at("site")).draw() }
        { text(draft, "device-path", tr!("device.path"), |draft| &mut draft.path).hint(tr!("device.path_hint")).problem(said(&wrong.path, "path")).draw() }
        { choice("device-profile", tr!("device.profile"), &profile, &profiles, on_profile) }
        { choice("device-connection", tr!("device.connection"), &connection, &connections, on_connection) }
        { text(draft, "device-timeout", tr!("device.timeout"), |draft| &mut draft.timeout).problem(said(&wrong.timeout, "timeout_ms")).draw() }
        { text(draft, "device-limit", tr!("device.limit"), |draft| &mut draft.limit).hint(tr!("device.limit_hint")).problem(said(&wrong.limit, "max_requests_per_s")).draw() }
        <details class="field-more" open={wrong.types.is_some() || findings.at("types").is_some()}>
            <summary>{ tr!("device.types") }</summary>
            { area("device-types", tr!("device.types_label"), 3, &types, Said::of(said(&wrong.types, "types"), tr!("device.types_hint")), on_types) }
        </details>
        { findings.elsewhere(&FIELDS) }
    </> }
}

fn profile_words(profile: Profile) -> AttrValue {
    match profile {
        Profile::Auto => tr!("kind.auto"),
        Profile::Generic => tr!("kind.generic"),
        Profile::Micro800 => tr!("kind.micro800"),
        Profile::Logix => tr!("kind.logix"),
        Profile::Omron => tr!("kind.omron"),
    }
}

fn connection_words(connecting: Connecting) -> AttrValue {
    match connecting {
        Connecting::Auto => tr!("connecting.auto"),
        Connecting::Unconnected => tr!("connecting.unconnected"),
        Connecting::Connected => tr!("connecting.connected"),
    }
}
