//! The connection to the relay, always visible.

use yew::prelude::*;

use crate::{
    browser,
    hooks::{use_link, use_second, use_workbench},
    i18n::tr,
    kit::Shape,
    net::Link,
    pages::block::{age_words, whole},
};

/// Word, shape and colour of the connection; a button to try now.
#[component]
pub fn Connection() -> Html {
    let bench = use_workbench();
    let link = use_link();
    let waits = matches!(link, Link::Lost { .. } | Link::None { .. });
    use_second(waits);
    let can_try = waits || bench.relay().is_closed_to_us();
    let onclick = use_callback(bench, |_: MouseEvent, bench| bench.relay().connect());
    let (state, shape, words) = say(&link);
    html! {
        <div class={classes!("connection", state)} data-test="connection" data-state={state}>
            { shape.draw() }
            <span>{ words }</span>
            if can_try {
                <button type="button" class="quiet-button" {onclick}>{ tr!("link.try_now") }</button>
            }
        </div>
    }
}

#[derive(Clone, PartialEq, Properties)]
pub(super) struct StaleNoteProps {
    /// What is shown comes from the relay.
    #[prop_or(true)]
    pub(super) stored: bool,
}

/// Says that what is shown is not live, and since when.
#[component]
pub(super) fn StaleNote(props: &StaleNoteProps) -> Html {
    let lost = match use_link() {
        Link::Lost { since_ms, .. } if props.stored => Some(since_ms),
        _ => None,
    };
    use_second(lost.is_some());
    let Some(since_ms) = lost else { return html! {} };
    let age = age_words((browser::now_ms() - since_ms) / 1_000.0);
    html! { <p class="warning-text" data-test="stale">{ tr!("link.stale", age = age) }</p> }
}

pub(crate) fn say(link: &Link) -> (&'static str, Shape, AttrValue) {
    match link {
        Link::Connecting => ("connecting", Shape::Half, tr!("link.connecting")),
        Link::Online { latency_ms: None } => ("online", Shape::Dot, tr!("link.online")),
        Link::Online { latency_ms: Some(ms) } => {
            let tenths = whole(ms * 10.0);
            ("online", Shape::Dot, tr!("link.online_ms", ms = format!("{}.{}", tenths / 10, tenths % 10)))
        }
        Link::Lost { next_ms, .. } => ("lost", Shape::Cross, tr!("link.lost", seconds = seconds(*next_ms))),
        Link::None { next_ms } => ("none", Shape::Ring, tr!("link.none", seconds = seconds(*next_ms))),
        Link::SetUp => ("refused", Shape::Ring, tr!("link.set_up")),
        Link::SignedOut => ("refused", Shape::Ring, tr!("link.signed_out")),
        Link::Denied => ("refused", Shape::Cross, tr!("link.denied")),
        Link::Foreign { protocol } => ("foreign", Shape::Cross, tr!("link.foreign", protocol = protocol)),
    }
}

fn seconds(next_ms: f64) -> u64 {
    whole(((next_ms - browser::now_ms()) / 1_000.0).ceil().max(1.0))
}
