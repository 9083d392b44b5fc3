//! Who holds a buffer, who waits and why; the targets with their sessions and connections; who is on the network.

mod buffers;
pub(crate) mod discover;
pub(crate) mod down;
mod queue;
mod targets;

use gloo_timers::callback::Interval;
use yew::{platform::spawn_local, prelude::*};

use self::{
    buffers::channels,
    discover::Discover,
    down::Down,
    queue::{Queue, Seats},
    targets::targets,
};
use super::connection::StaleNote;
use crate::{
    hooks::{use_rows_now_and_then, use_title, use_workbench},
    i18n::tr,
    net::rest,
};

/// Asks for what counts up in the targets, every other second.
#[hook]
fn use_counters() {
    let bench = use_workbench();
    use_effect_with(bench, |bench| {
        let bench = bench.clone();
        let ticks = Interval::new(2_000, move || {
            let relay = bench.relay().clone();
            if relay.is_online() {
                spawn_local(async move {
                    // Without an answer they stay as they are; the connection says why.
                    if let Ok(targets) = rest::targets().await {
                        relay.targets().refresh(targets);
                    }
                });
            }
        });
        move || drop(ticks)
    });
}

/// Channels, targets, discovery.
#[component]
pub fn ConnectionsPage() -> Html {
    let bench = use_workbench();
    use_title(&tr!("connections.title"));
    use_rows_now_and_then();
    use_counters();
    let seats = use_mut_ref(Seats::default);
    let queue = Queue::of(bench.rows(), &mut seats.borrow_mut());
    html! {
        <section class="connections">
            <h1>{ tr!("connections.title") }</h1>
            <StaleNote />
            <Discover />
            <Down />
            { channels(&queue) }
            { targets(&bench) }
        </section>
    }
}
