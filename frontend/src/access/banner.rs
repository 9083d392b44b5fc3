//! While the write window is open everybody sees it; who can open it.

use cipdeck_shared::api::{Role, WriteState};
use yew::{platform::spawn_local, prelude::*};

use crate::{
    browser,
    i18n::tr,
    kit::Shape,
    net::{Writing, rest, session},
    pages::block::whole,
};

/// Who has opened it, how long it stays open, and one button that closes it. To be drawn anew every second.
pub fn write_banner(writing: &Writing) -> Html {
    let state = &writing.state;
    let Some(window) = &state.window else { return html! {} };
    let onclick = |_: MouseEvent| {
        spawn_local(async {
            // Whether it has closed is seen here; a refusal leaves it open and the button where it is.
            let _ = rest::close_window().await;
        });
    };
    let left = time_left(writing.ends_ms);
    html! {
        <section class="write-banner" aria-label={tr!("writing.label")} data-test="write-banner">
            { Shape::Dot.draw() }
            <p>
                <b>{ tr!("writing.open") }</b>{ " " }
                { tr!("writing.by", owner = window.owner, time = browser::time_of_day(&window.opened_at)) }{ " " }
                if let Some(why) = &state.stopped {
                    <b>{ tr!("writing.stopped", why = why) }</b>
                }
            </p>
            <span class="write-left mono" data-test="window-left">{ tr!("writing.left", time = left) }</span>
            if session::is_person() {
                <button type="button" class="button" {onclick} data-test="window-close">{ tr!("writing.close") }</button>
            }
        </section>
    }
}

/// Why the caller cannot open it.
pub fn window_obstacle(state: &WriteState) -> Option<AttrValue> {
    match &state.stopped {
        _ if state.read_only => Some(tr!("writing.read_only")),
        Some(why) => Some(tr!("writing.stopped", why = why)),
        None if !session::is_person() || !session::may(Role::may_write) => Some(tr!("window.not_you")),
        None => None,
    }
}

/// `14:59`
fn time_left(ends_ms: f64) -> String {
    let seconds = whole(((ends_ms - browser::now_ms()) / 1_000.0).max(0.0));
    format!("{}:{:02}", seconds / 60, seconds % 60)
}
