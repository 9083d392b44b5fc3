//! The connection to the relay, always visible.

use yew::prelude::*;

use super::{i18n::tr, live::Plant};
use crate::{
    browser,
    net::Link,
    pages::{block::age_words, connection::say},
};

/// Word, shape and colour of the connection; a button to try now. To be drawn anew every second while it is lost.
pub(super) fn connection(plant: &Plant) -> Html {
    let link = plant.link();
    let can_try = matches!(link, Link::Lost { .. } | Link::None { .. }) || plant.is_closed_to_us();
    let onclick = {
        let plant = plant.clone();
        move |_: MouseEvent| plant.connect()
    };
    let (state, shape, words) = say(&link);
    // Without a relay there is nothing here, unlike in the workbench.
    let words = if let Link::None { .. } = link { tr!("frame.no_relay") } else { words };
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

/// Says that what is shown is not live, and since when.
pub(super) fn stale_note(plant: &Plant) -> Html {
    let Link::Lost { since_ms, .. } = plant.link() else { return html! {} };
    let age = age_words((browser::now_ms() - since_ms) / 1_000.0);
    html! { <p class="warning-text" role="status" data-test="stale">{ tr!("link.stale", age = age) }</p> }
}
