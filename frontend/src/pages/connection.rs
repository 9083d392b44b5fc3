//! The connection to the relay, always visible.

use yew::prelude::*;

use crate::{
    browser,
    hooks::{use_link, use_second, use_workbench},
    i18n::tr,
    kit::Shape,
    net::{Carried, Line, Link},
    pages::block::{age_words, whole},
};

/// The connection of the workbench.
#[component]
pub fn Connection() -> Html {
    let bench = use_workbench();
    let link = use_link();
    use_second(link.waits());
    connection(bench.relay(), None)
}

/// Word, shape and colour of a connection; a button to try now. To be drawn anew every second while it waits. Without a
/// relay there is less in some documents than in the workbench: they say so in their own words.
pub(crate) fn connection<T: Carried>(line: &Line<T>, no_relay: Option<AttrValue>) -> Html {
    let state = line.link();
    let can_try = state.waits() || line.is_closed_to_us();
    let onclick = {
        let line = line.clone();
        move |_: MouseEvent| line.connect()
    };
    let (word, shape, words) = say(&state);
    let words = no_relay.filter(|_| matches!(state, Link::None { .. })).unwrap_or(words);
    html! {
        <div class={classes!("connection", word)} data-test="connection" data-state={word}>
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

/// The note of the workbench.
#[component]
pub(super) fn StaleNote(props: &StaleNoteProps) -> Html {
    let link = use_link();
    let is_lost = props.stored && matches!(link, Link::Lost { .. });
    use_second(is_lost);
    if is_lost {
        stale_note(&link)
    } else {
        html! {}
    }
}

/// Says that what is shown is not live, and since when. To be drawn anew every second while the connection is lost.
pub(crate) fn stale_note(link: &Link) -> Html {
    let Link::Lost { since_ms, .. } = link else { return html! {} };
    let age = age_words((browser::now_ms() - since_ms) / 1_000.0);
    html! {
        <p class="warning-text" data-test="stale">
            // Only this is read out: the age changes every second.
            <span role="status">{ tr!("link.not_live") }</span>{ " " }{ tr!("link.stale", age = age) }
        </p>
    }
}

fn say(link: &Link) -> (&'static str, Shape, AttrValue) {
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
