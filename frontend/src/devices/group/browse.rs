//! What a device has: listed by itself, searched, ticked and added.

mod found;
mod list;
mod listing;

use std::rc::Rc;

use cipdeck_shared::{
    api::BrowseStep,
    config::{Device, GroupId},
};
use web_sys::HtmlInputElement;
use yew::prelude::*;

use self::{
    found::{Found, flat, new_variables},
    list::FoundList,
    listing::{Listing, use_listing},
};
use super::lines::Lines;
use crate::{
    devices::{answer::problem_note, api, fields::Findings, i18n::tr},
    kit::Dialog,
    office::fetch::use_action,
    store::Shelf,
};

#[derive(Clone, PartialEq, Properties)]
pub(super) struct BrowseProps {
    pub(super) device: Device,
    pub(super) group: GroupId,
    pub(super) lines: Rc<Lines>,
    pub(super) on_close: Callback<()>,
}

/// The addresses that are ticked.
pub(super) type Ticked = Rc<Shelf<String, ()>>;

/// Asks at once; what is found can be ticked while more comes.
#[component]
pub(super) fn BrowseDialog(props: &BrowseProps) -> Html {
    let listing = use_listing(props.device.id);
    let adding = use_action();
    let filter = use_state(String::new);
    let ticked = use_state(Ticked::default);
    let found = use_memo((listing.clone(), (*filter).clone()), |(listing, filter)| flat(listing, filter));
    let known: Rc<[String]> = props.lines.iter().map(|line| line.address.clone()).collect();
    let toggle = {
        let ticked = ticked.clone();
        Callback::from(move |address: String| {
            let mut changed = (**ticked).clone();
            if changed.remove(&address).is_none() {
                changed.insert(address, ());
            }
            ticked.set(Rc::new(changed));
        })
    };
    let oninput = {
        let filter = filter.clone();
        move |event: InputEvent| filter.set(event.target_unchecked_into::<HtmlInputElement>().value())
    };
    let count = ticked.len();
    let onsubmit = {
        let (adding, ticked, known) = (adding.clone(), ticked.clone(), known.clone());
        let (all, group, on_close) = (flat(&listing, ""), props.group, props.on_close.clone());
        move |event: SubmitEvent| {
            event.prevent_default();
            let (on_close, variables) = (on_close.clone(), new_variables(&all, &ticked, &known));
            if !variables.is_empty() {
                adding.go(api::add_variables(group, variables), move |_| on_close.emit(()));
            }
        }
    };
    let members = listing.members.clone();
    html! {
        <Dialog title={tr!("browse.title", name = props.device.config.name)} test="browse-dialog" on_close={props.on_close.clone()}>
            <form {onsubmit} class="wide-form">
                { progress(&listing) }
                <input
                    class="input filter" type="search" placeholder={tr!("browse.search")} aria-label={tr!("browse.search")}
                    value={(*filter).clone()} {oninput} data-test="browse-search"
                />
                <FoundList {found} ticked={(*ticked).clone()} {known} {toggle} {members} />
                { Findings::of(adding.problem()).elsewhere(&[]) }
                { problem_note(adding.problem().as_ref()) }
                <div class="dialog-buttons">
                    <span class="spring" role="status">{ tr!("browse.ticked", count = count) }</span>
                    <button type="button" class="button" onclick={props.on_close.reform(|_: MouseEvent| ())}>{ tr!("dialog.cancel") }</button>
                    <button type="submit" class="button primary" disabled={adding.is_busy() || count == 0} data-test="browse-add">{ tr!("browse.add") }</button>
                </div>
            </form>
        </Dialog>
    }
}

/// How far it is, and a way to end it.
fn progress(listing: &Listing) -> Html {
    let words = match (listing.step, listing.expected) {
        (BrowseStep::Idle, _) => tr!("browse.asking"),
        (BrowseStep::Running, Some(all)) => {
            tr!("browse.running_of", found = listing.symbols.len(), all = all)
        }
        (BrowseStep::Running, None) => tr!("browse.running", found = listing.symbols.len()),
        (BrowseStep::Done, _) => {
            tr!("browse.done", found = listing.symbols.len(), requests = listing.requests)
        }
        (BrowseStep::Failed, _) => tr!("browse.failed", found = listing.symbols.len()),
        (BrowseStep::Cancelled, _) => tr!("browse.cancelled", found = listing.symbols.len()),
    };
    let runs = matches!(listing.step, BrowseStep::Idle | BrowseStep::Running) && listing.problem.is_none();
    html! { <>
        <p class="browse-progress" role="status" data-test="browse-progress">
            { words }
            if runs {
                if let Some(all) = listing.expected {
                    <progress max={all.to_string()} value={listing.symbols.len().to_string()} aria-label={tr!("browse.progress")} />
                }
                <button type="button" class="tool" onclick={listing.cancel.reform(|_: MouseEvent| ())} data-test="browse-cancel">{ tr!("browse.cancel") }</button>
            } else {
                <button type="button" class="tool" onclick={listing.again.reform(|_: MouseEvent| ())} data-test="browse-again">{ tr!("browse.again") }</button>
            }
        </p>
        if let Some(reason) = &listing.reason {
            <p class={if listing.step == BrowseStep::Failed { "warning-text" } else { "hint" }} data-test="browse-reason">{ reason }</p>
        }
        { problem_note(listing.problem.as_ref().or(listing.unknown.as_ref())) }
    </> }
}
