//! Changing a value: what is there, what will be, the window, the ticket, and what became of it.

mod outcome;
mod parts;
mod window;

use std::rc::Rc;

use cipdeck_shared::{
    api::WriteTicket,
    config::{Device, Variable},
};
use yew::prelude::*;

use self::{
    outcome::outcome,
    parts::{change, choices, range},
    window::OpenWindow,
};
use super::{
    answer::problem_note,
    api,
    fields::Findings,
    i18n::tr,
    live::{use_plant, use_value},
};
use crate::{
    browser,
    hooks::use_second,
    kit::Dialog,
    office::{check, fetch::use_action, kit::Entry},
    pages::block::whole,
};

#[derive(Clone, PartialEq, Properties)]
pub(super) struct WriteDialogProps {
    pub(super) variable: Variable,
    /// With those of its parents.
    pub(super) address: String,
    pub(super) device: Device,
    pub(super) on_close: Callback<()>,
}

/// What the relay offers, and until when, in ms of [`browser::now_ms`].
type Offer = Option<(Rc<WriteTicket>, f64)>;

/// Three steps: another value, old and new, the result. Without an open window the window first.
#[component]
pub(super) fn WriteDialog(props: &WriteDialogProps) -> Html {
    let plant = use_plant();
    use_second(true);
    let now = use_value(props.variable.id);
    let (asking, writing) = (use_action(), use_action());
    let typed = use_state(String::new);
    let (offer, done) = (use_state(|| Offer::None), use_state(|| None::<Rc<api::Done>>));
    let config = &props.variable.config;
    let title = tr!("write_value.title", name = config.name);
    let on_close = props.on_close.clone();
    let cancel = on_close.reform(|_: MouseEvent| ());
    if let Some(done) = &*done {
        return html! { <Dialog {title} test="write-result" {on_close}>{ outcome(done, cancel) }</Dialog> };
    }
    if plant.writing().state.window.is_none() {
        return html! { <Dialog title={tr!("window.title")} test="window-dialog" {on_close}><OpenWindow on_close={cancel} /></Dialog> };
    }
    let on_ask = {
        let (asking, typed, offer, id) = (asking.clone(), typed.clone(), offer.clone(), props.variable.id);
        Callback::from(move |event: SubmitEvent| {
            event.prevent_default();
            let offer = offer.clone();
            if check::needed(&typed).is_none() {
                asking.go(api::offer(id, typed.trim().to_owned()), move |ticket: WriteTicket| {
                    #[expect(clippy::cast_precision_loss, reason = "a minute or so")]
                    let ends_ms = browser::now_ms() + ticket.good_for_ms as f64;
                    offer.set(Some((Rc::new(ticket), ends_ms)));
                });
            }
        })
    };
    if let Some((ticket, ends_ms)) = &*offer {
        let on_write = {
            let (writing, ticket, id, done) =
                (writing.clone(), ticket.clone(), props.variable.id, done.clone());
            move |event: SubmitEvent| {
                event.prevent_default();
                let done = done.clone();
                writing.go(api::write(id, ticket.ticket.clone()), move |written| {
                    done.set(Some(Rc::new(written)));
                });
            }
        };
        let back = {
            let offer = offer.clone();
            move |_: MouseEvent| offer.set(None)
        };
        let left_ms = *ends_ms - browser::now_ms();
        return html! {
            <Dialog {title} test="write-dialog" {on_close}>
                <form onsubmit={on_write}>
                    { change(props, ticket) }
                    if left_ms > 0.0 {
                        <p class="hint" data-test="write-left">{ tr!("write.left", seconds = whole(left_ms / 1_000.0)) }</p>
                    } else {
                        <p class="finding error" role="alert">{ tr!("write.late") }</p>
                    }
                    { problem_note(writing.problem().as_ref()) }
                    <div class="dialog-buttons">
                        <button type="button" class="button" autofocus=true onclick={cancel} data-test="write-cancel">{ tr!("dialog.cancel") }</button>
                        <button type="button" class="button" onclick={back}>{ tr!("write_value.other") }</button>
                        <button type="submit" class="button danger" disabled={writing.is_busy() || left_ms <= 0.0} data-test="write-confirm">{ tr!("write.do") }</button>
                    </div>
                </form>
            </Dialog>
        };
    }
    let findings = Findings::of(asking.problem());
    let unit = if config.unit.is_empty() {
        tr!("write_value.new")
    } else {
        tr!("write_value.new_unit", unit = config.unit)
    };
    html! {
        <Dialog {title} test="value-dialog" {on_close}>
            <form onsubmit={on_ask}>
                <dl class="facts">
                    <dt>{ tr!("write_value.where") }</dt><dd class="mono">{ &props.address }{ " @ " }{ &props.device.config.path }</dd>
                    <dt>{ tr!("write_value.now") }</dt><dd data-test="value-now">{ now.map(|now| now.value.text.clone()).unwrap_or_default() }</dd>
                </dl>
                { Entry::text("new-value", unit, &typed).hint(range(&props.variable)).problem(findings.at("text")).draw() }
                { choices(&props.variable, &typed) }
                { findings.elsewhere(&["text"]) }
                { problem_note(asking.problem().as_ref()) }
                <div class="dialog-buttons">
                    <button type="button" class="button" onclick={cancel}>{ tr!("dialog.cancel") }</button>
                    <button type="submit" class="button primary" disabled={asking.is_busy() || typed.trim().is_empty()} data-test="write-ask">{ tr!("write_value.ask") }</button>
                </div>
            </form>
        </Dialog>
    }
}
