//! The devices: sites, devices, groups and variables, with their live values, in a document of its own.
//!
//! | module | job |
//! | --- | --- |
//! | [`route`] | the addresses of its pages |
//! | [`live`] | the connection to the relay, the tree and the newest values |
//! | `tree` | site, device, group |
//! | `device` | a device: its form, its health, its load, its writes, what it lists of itself |
//! | `group` | a group: its variables as a live table, and everything that is done with them |
//! | [`trend`] | numbers over time |
//! | [`write`] | changing a value: old and new, the ticket, the result |
//! | [`api`] | what is asked of the relay |

mod all;
mod answer;
pub mod api;
mod device;
mod fields;
mod group;
mod i18n;
pub mod live;
mod quality;
pub mod route;
mod tree;
pub mod trend;
mod write;

use yew::prelude::*;

use self::{
    all::AllPage,
    device::{DevicePage, NewDevicePage},
    group::GroupPage,
    i18n::tr,
    live::{Plant, ValueStore, use_plant},
    route::{Page, link, use_page},
    tree::PlantTree,
};
use crate::{
    access::{refused, who, write_banner},
    address,
    frame_stats::FrameStats,
    hooks::{use_second, use_session},
    net::session,
    pages::connection::connection,
    theme::ThemeToggle,
};

/// The whole document.
#[component]
pub fn Devices() -> Html {
    let plant = use_memo((), |()| open());
    html! {
        <ContextProvider<Plant> context={(*plant).clone()}>
            <Frame />
        </ContextProvider<Plant>>
    }
}

/// Starts to connect.
fn open() -> Plant {
    let stats = FrameStats::default();
    stats.offer();
    let values = ValueStore::new(stats.ask_for_frame());
    let plant = Plant::new(values, Callback::from(move |ms| stats.spend(ms)));
    plant.connect();
    session::watch_activity();
    address::listen();
    plant
}

#[component]
fn Frame() -> Html {
    let page = use_page();
    let plant = use_plant();
    let writing = plant.writing();
    let view = use_session();
    let state = plant.link();
    use_second(writing.state.window.is_some() || state.waits());
    html! { <>
        <header class="bar">
            <a class="brand" href="/">{ "cipdeck" }</a>
            <span class="bar-place">{ tr!("nav.devices") }</span>
            <nav aria-label={tr!("frame.elsewhere")}><ul>
                <li><a href="/">{ tr!("frame.workbench") }</a></li>
                <li><a href="/monitor">{ tr!("nav.monitor") }</a></li>
                <li><a href="/office">{ tr!("nav.office") }</a></li>
            </ul></nav>
            { connection(&plant, Some(tr!("frame.no_relay"))) }
            { who(view.as_deref(), writing.state.read_only) }
            <ThemeToggle />
        </header>
        { write_banner(&writing) }
        if plant.is_closed_to_us() {
            <main>{ refused(&state) }</main>
        } else {
            <div class="plant">
                <PlantTree {page} />
                <main class="plant-page">{ body(&plant, page) }</main>
            </div>
        }
    </> }
}

fn body(plant: &Plant, page: Page) -> Html {
    let Some(tree) = plant.tree() else {
        return html! { <p class="waiting" role="status">{ tr!("deck.connecting") }</p> };
    };
    match page {
        Page::All => html! { <AllPage {tree} /> },
        Page::New => html! { <NewDevicePage /> },
        Page::Device(id) if tree.device(id).is_some() => html! { <DevicePage key={id.to_string()} {id} /> },
        Page::Group(id) if tree.group(id).is_some() => html! { <GroupPage key={id.to_string()} {id} /> },
        Page::Device(_) | Page::Group(_) | Page::NotFound => html! {
            <div class="empty">
                <h1>{ tr!("not_found.title") }</h1>
                <p>{ link(Page::All, "", html! { tr!("frame.to_all") }) }</p>
            </div>
        },
    }
}
