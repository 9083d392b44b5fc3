//! Asks before something is written to a device: what, where, the bytes themselves, and through a relay what is there
//! now and what will be.

use std::rc::Rc;

use cipdeck_shared::{
    api::{Problem, ReadValue, WriteTicket},
    config::{BlockId, space_hex, write_hex},
    plan::{MessagePlan, TriggerType},
    table::{self, Access},
    wire::LogicalKind,
};
use yew::{platform::spawn_local, prelude::*};

use super::{notice::words, window_form::window_form};
use crate::{
    browser,
    desk::Consent,
    editor::hexadecimal,
    hooks::{use_link_of, use_second},
    i18n::tr,
    kit::Dialog,
    net::{Relay, rest},
    pages::block::whole,
};

#[derive(Clone, PartialEq, Properties)]
pub(crate) struct WriteDialogProps {
    pub(crate) relay: Relay,
    /// The stored block and its revision; none for one that this browser runs.
    pub(crate) stored: Option<(BlockId, u64)>,
    pub(crate) plan: Rc<MessagePlan>,
    /// It is sent again and again.
    pub(crate) repeats: bool,
    /// What the person has agreed to.
    pub(crate) on_answer: Callback<Consent>,
}

/// What the relay said to the wish.
#[derive(Clone, PartialEq)]
enum Said {
    Nothing,
    /// The ticket, and until when it is good, in ms of [`browser::now_ms`].
    Ticket(Rc<WriteTicket>, f64),
    No(Rc<Problem>),
}

/// Confirmed once; a write that repeats itself, twice. Through a relay it needs an open window and a ticket.
#[component]
pub(crate) fn WriteDialog(props: &WriteDialogProps) -> Html {
    let WriteDialogProps { relay, plan, on_answer, repeats, stored } = props;
    let (repeats, stored) = (*repeats, *stored);
    use_link_of(relay);
    use_second(true);
    let confirmed_once = use_state(|| false);
    let said = use_state(|| Said::Nothing);
    let asked = use_state(|| 0_u32);
    let (node, no_window) = (use_node_ref(), use_state(|| None::<String>));
    let by_relay = stored.is_some();
    let has_window = relay.writing().state.window.is_some();
    use_effect_with((stored.filter(|_| has_window), *asked), {
        let said = said.clone();
        move |(wanted, _)| {
            said.set(Said::Nothing);
            if let Some((id, revision)) = *wanted {
                spawn_local(async move {
                    said.set(match rest::ask_write(id, revision).await {
                        #[expect(clippy::cast_precision_loss, reason = "a minute or so")]
                        Ok(it) => {
                            let ends_ms = browser::now_ms() + it.good_for_ms as f64;
                            Said::Ticket(Rc::new(it), ends_ms)
                        }
                        Err(problem) => Said::No(Rc::new(problem)),
                    });
                });
            }
        }
    });
    let consent = match &*said {
        _ if !by_relay => Some(Consent::Seen),
        Said::Ticket(it, ends_ms) if *ends_ms > browser::now_ms() => Some(Consent::Ticket(it.ticket.clone())),
        _ => None,
    };
    let can_confirm = consent.is_some();
    let onsubmit = {
        let (on_answer, confirmed_once) = (on_answer.clone(), confirmed_once.clone());
        Callback::from(move |event: SubmitEvent| {
            event.prevent_default();
            match &consent {
                Some(_) if repeats && !*confirmed_once => confirmed_once.set(true),
                Some(consent) => on_answer.emit(consent.clone()),
                None => {}
            }
        })
    };
    let no = on_answer.reform(|_: MouseEvent| Consent::None);
    let on_close = on_answer.reform(|()| Consent::None);
    if by_relay && !has_window {
        return html! {
            <Dialog title={tr!("window.title")} test="window-dialog" {on_close}>{ window_form(relay, &node, &no_window, no) }</Dialog>
        };
    }
    let (title, confirm) = match (*confirmed_once, repeats) {
        (true, _) => (tr!("write.cyclic_title"), tr!("write.cyclic_do")),
        (false, true) => (tr!("write.title"), tr!("write.next")),
        (false, false) => (tr!("write.title"), tr!("write.do")),
    };
    let again = move |_: MouseEvent| asked.set(*asked + 1);
    html! {
        <Dialog {title} test="write-dialog" {on_close}>
            <form {onsubmit}>
                if *confirmed_once {
                    <p class="warning-text">{ every(plan) }</p>
                } else {
                    { what(plan, &said) }
                }
                if by_relay {
                    { answer(&said, again) }
                }
                <div class="dialog-buttons">
                    <button type="button" class="button" autofocus=true data-test="write-cancel" onclick={no}>{ tr!("dialog.cancel") }</button>
                    <button type="submit" class="button danger" disabled={!can_confirm} data-test="write-confirm">{ confirm }</button>
                </div>
            </form>
        </Dialog>
    }
}

/// What the relay said, and how long that holds.
fn answer(said: &Said, again: impl Fn(MouseEvent) + 'static) -> Html {
    let words: AttrValue = match said {
        Said::Nothing => return html! { <p role="status" class="hint">{ tr!("write.asking") }</p> },
        Said::Ticket(_, ends_ms) if *ends_ms > browser::now_ms() => {
            let seconds = whole((ends_ms - browser::now_ms()) / 1_000.0);
            return html! { <p class="hint" data-test="write-left">{ tr!("write.left", seconds = seconds) }</p> };
        }
        Said::Ticket(..) => tr!("write.late"),
        Said::No(problem) => words(problem).into(),
    };
    html! {
        <p class="finding error" role="alert" data-test="write-refused">
            { words }{ " " }
            <button type="button" class="tool" onclick={again}>{ tr!("write.again") }</button>
        </p>
    }
}

fn every(plan: &MessagePlan) -> AttrValue {
    match plan.trigger() {
        TriggerType::Every(ms) => tr!("write.cyclic", ms = ms),
        TriggerType::Once | TriggerType::Fast => tr!("write.fast"),
    }
}

fn what(plan: &MessagePlan, said: &Said) -> Html {
    let request = plan.request();
    let of_path = |kind| request.path().logical(kind).unwrap_or_default();
    let class = u16::try_from(of_path(LogicalKind::Class)).unwrap_or_default();
    let service = request.service();
    let name = table::service(class, service).map_or("", |entry| entry.name);
    let class_name = table::class(class).map_or("", |entry| entry.name);
    let access = match plan.access() {
        Access::Write => tr!("write.access_write"),
        Access::Unknown | Access::Read => tr!("write.access_unknown"),
    };
    let ticket = if let Said::Ticket(it, _) = said { Some(it) } else { None };
    // Through a relay: the very bytes that it will send.
    let bytes = ticket.map_or_else(|| write_hex(plan.bytes()), |it| it.request.clone());
    let number = |value: u32| format!("{value} = {}", hexadecimal(value.into()));
    let [instance, attribute] =
        [LogicalKind::Instance, LogicalKind::Attribute].map(|kind| number(of_path(kind)));
    html! { <>
        <p>{ access }</p>
        <dl class="facts">
            <dt>{ tr!("write.target") }</dt><dd>{ plan.target().to_string() }</dd>
            <dt>{ tr!("write.service") }</dt><dd>{ number(service.0.into()) }{ " " }{ name }</dd>
            <dt>{ tr!("write.path") }</dt>
            <dd>
                { tr!("write.object", class = number(class.into()), name = class_name, instance = instance, attribute = attribute) }
            </dd>
            <dt>{ tr!("write.bytes") }</dt><dd class="mono" data-test="write-bytes">{ spaced(&bytes) }</dd>
            if let Some(it) = ticket {
                { change(it) }
            }
        </dl>
    </> }
}

/// What is there now, and what will be.
fn change(it: &WriteTicket) -> Html {
    let old = it.old.as_ref().map_or_else(
        || html! { <span class="quiet">{ tr!("write.no_old", why = it.no_old.as_deref().unwrap_or_default()) }</span> },
        value,
    );
    html! { <>
        <dt>{ tr!("write.old") }</dt><dd data-test="write-old">{ old }</dd>
        if let Some(new) = &it.new {
            <dt>{ tr!("write.new") }</dt><dd data-test="write-new"><b>{ value(new) }</b></dd>
        }
    </> }
}

/// A value in words, and its bytes.
pub(super) fn value(value: &ReadValue) -> Html {
    html! { <>{ &value.text }{ " " }<span class="quiet mono">{ spaced(&value.data) }</span></> }
}

/// `10 03 20 04`
fn spaced(hex: &str) -> String {
    space_hex(hex).to_ascii_uppercase()
}
