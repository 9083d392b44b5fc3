//! Site, device, group: always at the left.

use std::rc::Rc;

use cipdeck_shared::{
    api::Role,
    config::{Device, Group},
};
use web_sys::HtmlInputElement;
use yew::prelude::*;

use super::{
    i18n::tr,
    live::{Plant, Tree, use_plant},
    quality::health_mark,
    route::{Page, link},
};
use crate::{browser, hooks::use_session, net::session};

#[derive(Clone, PartialEq, Properties)]
pub(super) struct PlantTreeProps {
    pub(super) page: Page,
}

/// A filter, one heading per site, its devices, and their groups.
#[component]
pub(super) fn PlantTree(props: &PlantTreeProps) -> Html {
    let plant = use_plant();
    use_session();
    let filter = use_state(String::new);
    let oninput = use_callback(filter.clone(), |event: InputEvent, filter| {
        filter.set(event.target_unchecked_into::<HtmlInputElement>().value());
    });
    let tree: Rc<Tree> = plant.tree().unwrap_or_default();
    let shown: Vec<_> = tree.devices.iter().filter(|device| is_found(&tree, device, &filter)).collect();
    let sites = shown.chunk_by(|one, other| one.config.site == other.config.site);
    html! {
        <nav class="plant-tree" aria-label={tr!("tree.label")}>
            if session::may(Role::may_edit) {
                { link(Page::New, "button wide link", html! { tr!("tree.new_device") }) }
            }
            <input
                class="input filter" type="search" placeholder={tr!("tree.filter_short")} aria-label={tr!("tree.filter")}
                value={(*filter).clone()} {oninput} data-test="tree-filter"
            />
            { for sites.map(|devices| site(&plant, &tree, devices, props.page)) }
            if !tree.devices.is_empty() && shown.is_empty() {
                <p class="hint">{ tr!("tree.nothing") }</p>
            }
        </nav>
    }
}

fn site(plant: &Plant, tree: &Tree, devices: &[&Device], page: Page) -> Html {
    let name = devices.first().map(|device| device.config.site.clone()).unwrap_or_default();
    let words = if name.is_empty() { tr!("tree.no_site") } else { name.into() };
    html! {
        <section class="tree-site">
            <h2>{ words }</h2>
            <ul>{ for devices.iter().map(|device| entry(plant, tree, device, page)) }</ul>
        </section>
    }
}

fn entry(plant: &Plant, tree: &Tree, device: &Device, page: Page) -> Html {
    let to = Page::Device(device.id);
    let is_here = to == page;
    html! {
        <li key={device.id.to_string()} data-test="tree-device">
            <div class={classes!("tree-line", is_here.then_some("here"))} aria-current={is_here.then_some("page")}>
                { link(to, "", html! { <>
                    { health_mark(plant.status(device.id).as_deref(), plant.is_live(), true) }
                    <span class="tree-name">{ &device.config.name }</span>
                </> }) }
            </div>
            <ul>{ for tree.groups_of(device.id).map(|group| leaf(group, page)) }</ul>
        </li>
    }
}

fn leaf(group: &Group, page: Page) -> Html {
    let to = Page::Group(group.id);
    let is_here = to == page;
    html! {
        <li key={group.id.to_string()} data-test="tree-group">
            <div class={classes!("tree-line", "leaf", is_here.then_some("here"))} aria-current={is_here.then_some("page")}>
                { link(to, "", html! { <>
                    <span class="tree-name">{ &group.config.name }</span>
                    if !group.config.on {
                        <span class="tree-off">{ tr!("tree.off") }</span>
                    }
                </> }) }
            </div>
        </li>
    }
}

/// Whether a device, its site, its path or one of its groups contains a text.
fn is_found(tree: &Tree, device: &Device, wanted: &str) -> bool {
    let config = &device.config;
    let groups = tree.groups_of(device.id).map(|group| group.config.name.as_str());
    [config.name.as_str(), &config.site, &config.path]
        .into_iter()
        .chain(groups)
        .any(|text| browser::contains(text, wanted))
}
