//! A device: how it is, what asking it costs, its groups, its form, and what was written to it.

mod copy;
mod discover;
mod draft;
mod form;
mod groups;
mod state;
mod writes;

use cipdeck_shared::{
    api::Role,
    config::{Device, DeviceId},
};
use yew::prelude::*;

use self::{
    copy::CopyDialog, discover::Discover, draft::DeviceDraft, form::DeviceForm, groups::Groups, state::state,
    writes::Writes,
};
use super::{
    i18n::tr,
    live::{use_device_status, use_plant, use_tree},
    route::{self, Page},
};
use crate::{
    hooks::{use_session, use_title},
    net::session,
    office::kit::{Confirm, note},
    pages::connection::stale_note,
};

#[derive(Clone, PartialEq, Properties)]
pub(super) struct DevicePageProps {
    pub(super) id: DeviceId,
}

#[derive(Clone, Copy, PartialEq)]
enum Asked {
    Copy,
    Delete,
}

/// One device.
#[component]
pub(super) fn DevicePage(props: &DevicePageProps) -> Html {
    let plant = use_plant();
    let (tree, status) = (use_tree(), use_device_status(props.id));
    use_session();
    let asked = use_state(|| None::<Asked>);
    let device = tree.as_ref().and_then(|tree| tree.device(props.id)).cloned();
    use_title(device.as_ref().map_or("", |device| device.config.name.as_str()));
    let (Some(tree), Some(device)) = (tree, device) else { return html! {} };
    let may = session::may(Role::may_edit);
    let ask = |question: Asked| {
        let asked = asked.clone();
        Callback::from(move |_: MouseEvent| asked.set(Some(question)))
    };
    html! { <>
        <div class="page-head">
            <h1>{ &device.config.name }</h1>
            <span class="quiet mono">{ &device.config.path }</span>
            if may {
                <span class="page-do">
                    <button type="button" class="button" onclick={ask(Asked::Copy)} data-test="copy-device">{ tr!("device.copy") }</button>
                    <button type="button" class="button" onclick={ask(Asked::Delete)} data-test="delete-device">{ tr!("device.delete") }</button>
                </span>
            }
        </div>
        { stale_note(&plant.link()) }
        <div class="cards">
            { state(&device, status.as_deref(), plant.is_live()) }
            <Groups {tree} device={device.id} />
        </div>
        <section class="panel">
            <h2>{ tr!("device.settings") }</h2>
            if may {
                <DeviceForm stored={Some(device.clone())} draft={DeviceDraft::of(&device.config)} />
            } else {
                { note(tr!("device.not_you")) }
            }
        </section>
        <Writes device={device.id} />
        { question(*asked, &device, &asked) }
    </> }
}

fn question(question: Option<Asked>, device: &Device, asked: &UseStateHandle<Option<Asked>>) -> Html {
    let close = {
        let asked = asked.clone();
        Callback::from(move |()| asked.set(None))
    };
    match question {
        None => html! {},
        Some(Asked::Copy) => html! { <CopyDialog device={device.clone()} on_close={close} /> },
        Some(Asked::Delete) => {
            let on_close = Callback::from(move |gone: bool| {
                close.emit(());
                if gone {
                    route::go(Page::All);
                }
            });
            html! {
                <Confirm
                    title={tr!("device.delete_title")} text={tr!("device.delete_text", name = device.config.name)}
                    answer={tr!("device.delete")} resource={format!("devices/{}?revision={}", device.id, device.revision)} {on_close}
                />
            }
        }
    }
}

/// The form for one more device, and who answers on the network.
#[component]
pub(super) fn NewDevicePage() -> Html {
    use_title(&tr!("tree.new_device"));
    use_session();
    // Counts up with each device that is taken over: the form begins anew.
    let taken = use_state(|| (0_u32, DeviceDraft::default()));
    let on_take = {
        let taken = taken.clone();
        Callback::from(move |draft: DeviceDraft| taken.set((taken.0 + 1, draft)))
    };
    if !session::may(Role::may_edit) {
        return note(tr!("device.not_you"));
    }
    html! { <>
        <h1>{ tr!("tree.new_device") }</h1>
        <div class="cards wide">
            <section class="panel">
                <h2>{ tr!("device.settings") }</h2>
                <DeviceForm key={taken.0} stored={None::<Device>} draft={taken.1.clone()} />
            </section>
            <Discover {on_take} />
        </div>
    </> }
}
