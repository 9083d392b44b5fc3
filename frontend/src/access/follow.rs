//! Follows who is here and whether something may be written, without a WebSocket: for documents that are no live view.

use std::rc::Rc;

use cipdeck_shared::api::{SessionState, WriteState};
use gloo_net::http::Method;
use gloo_timers::callback::Interval;
use yew::{platform::spawn_local, prelude::*};

use crate::{
    hooks::use_session,
    net::{Writing, rest, session},
};

/// What the relay says about writing, and a way to ask at once. The first answer of all is who is here.
#[hook]
pub fn use_writing() -> (Rc<Writing>, Callback<()>) {
    let writing = use_state(Rc::<Writing>::default);
    let view = use_session();
    let ask = {
        let writing = writing.setter();
        use_callback((), move |(), ()| {
            let writing = writing.clone();
            spawn_local(async move {
                if let Some(heard) = heard().await {
                    writing.set(Rc::new(heard));
                }
            });
        })
    };
    use_effect_with((), |()| {
        spawn_local(async {
            // Without an answer the page says that it waits; it asks again with its next round.
            let _ = session::ask().await;
        });
    });
    let known = view.as_ref().map(|view| view.state);
    use_effect_with((known, ask.clone()), |(known, ask)| {
        let known = *known;
        let signed_in = known == Some(SessionState::SignedIn);
        if signed_in {
            ask.emit(());
        }
        let ask = ask.clone();
        let rounds = Interval::new(ROUND_MS, move || match known {
            Some(SessionState::SignedIn) => ask.emit(()),
            Some(_) => {}
            None => spawn_local(async {
                let _ = session::ask().await;
            }),
        });
        move || drop(rounds)
    });
    ((*writing).clone(), ask)
}

async fn heard() -> Option<Writing> {
    let text = rest::ask(Method::GET, "window", None).await.ok()?;
    rest::parse::<WriteState>(&text).ok().map(Writing::heard)
}

/// ms between two questions: somebody who is locked out sees it soon.
const ROUND_MS: u32 = 1_000;
