//! The channels: their buffers, and who waits for one.

use cipdeck_shared::{config::Channel, engine::Phase};
use yew::prelude::*;

use super::queue::{Busy, Line, Queue};
use crate::{
    browser,
    i18n::tr,
    kit::{Shape, state_mark},
    pages::block::whole,
    route::{Route, link},
};

/// One section a channel.
pub(super) fn channels(queue: &Queue) -> Html {
    queue.channels.iter().map(|(channel, line)| section(*channel, line, queue)).collect()
}

fn section(channel: Channel, line: &Line, queue: &Queue) -> Html {
    let held = line.buffers.iter().flatten().count();
    let count = match channel.of_controller() {
        Some(_) => {
            tr!("connections.held", held = held, all = line.buffers.len(), waiting = line.waiting.len())
        }
        None => tr!("connections.under_way", count = held),
    };
    let name = String::from(channel);
    html! {
        <section key={name.clone()} class="channel" data-test={format!("channel-{name}")}>
            <h2>{ tr!("connections.channel", name = name) }<span class="count">{ count }</span></h2>
            if !line.buffers.is_empty() {
                <ol class="buffers">
                    { for line.buffers.iter().take(MOST).enumerate().map(|(number, busy)| buffer(number, busy.as_ref(), queue)) }
                </ol>
            }
            if !line.waiting.is_empty() {
                <h3>{ tr!("connections.waiting") }</h3>
                <ol class="queue" data-test="waiting">
                    { for line.waiting.iter().take(MOST).map(|busy| waiting(busy, line)) }
                </ol>
            }
            { more(line) }
        </section>
    }
}

/// Messages that are listed; of a thousand nobody reads all.
const MOST: usize = 40;

fn more(line: &Line) -> Html {
    match line.buffers.len().saturating_sub(MOST) + line.waiting.len().saturating_sub(MOST) {
        0 => html! {},
        more => html! { <p class="quiet">{ tr!("connections.more", count = more) }</p> },
    }
}

fn buffer(number: usize, busy: Option<&Busy>, queue: &Queue) -> Html {
    let body = match busy {
        None => {
            html! { <p class="state">{ Shape::Ring.draw() }<span class="state-word">{ tr!("connections.free") }</span></p> }
        }
        Some(busy) => html! { <>
            <p class="buffer-name">{ name(busy) }</p>
            <p>{ state_mark(busy.row.status.phase, false) }<span class="age">{ since(busy) }</span></p>
            <p class="mono">{ &busy.target }</p>
            <p class="quiet">{ reason(busy, queue) }</p>
        </> },
    };
    html! {
        <li key={number} class={classes!("buffer", busy.is_some().then_some("held"))} data-test="buffer" data-held={busy.is_some().to_string()}>
            <h3>{ tr!("connections.buffer", number = number + 1) }</h3>
            { body }
        </li>
    }
}

fn waiting(busy: &Busy, line: &Line) -> Html {
    let holders: Vec<_> = line.buffers.iter().flatten().map(|busy| busy.row.config.name()).collect();
    html! {
        <li key={busy.row.id.to_string()} class="queued">
            { name(busy) }
            <span class="mono">{ &busy.target }</span>
            <span class="age">{ since(busy) }</span>
            <span class="quiet">{ tr!("connections.waits_for_buffer", holders = holders.join(", ")) }</span>
        </li>
    }
}

fn name(busy: &Busy) -> Html {
    link(Route::Block(busy.row.id), "", html! { busy.row.config.name() })
}

/// `for 3 s`: since its phase has changed.
fn since(busy: &Busy) -> AttrValue {
    let age = busy.row.status.at.as_deref().and_then(browser::age_s);
    age.map_or_else(AttrValue::default, |age| tr!("connections.for", seconds = whole(age.floor())))
}

/// What it waits for.
fn reason(busy: &Busy, queue: &Queue) -> AttrValue {
    let other = queue.busy_with(busy).map(|other| other.row.config.name());
    match (busy.row.status.phase, other) {
        (Phase::Sent, _) => tr!("connections.sent"),
        (Phase::Connecting, _) => tr!("connections.connecting"),
        (_, Some(other)) => tr!("connections.waits_for_target", other = other),
        (_, None) => tr!("connections.waits"),
    }
}
