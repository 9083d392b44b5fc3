//! Who is at this browser, as the relay says.
//!
//! The session itself is a cookie that no script can read. What the page knows of it is kept in memory only, and there
//! is one per document, whoever asks.

use std::{
    cell::{Cell, RefCell},
    rc::Rc,
};

use cipdeck_shared::api::{ActorKind, Caller, Role, SessionState, SessionView};
use wasm_bindgen::{JsCast, closure::Closure};
use yew::{Callback, platform::spawn_local};

use super::rest::{self, Answered};
use crate::{
    browser,
    store::{Watch, Watchers},
};

thread_local! {
    static SESSION: Session = Session::default();
}

#[derive(Default)]
struct Session {
    view: RefCell<Option<Rc<SessionView>>>,
    watchers: Watchers,
    active_ms: Cell<f64>,
}

/// What the relay said last; `None` before it has said anything.
pub fn view() -> Option<Rc<SessionView>> {
    SESSION.with(|session| session.view.borrow().clone())
}

/// Who is signed in.
pub fn caller() -> Option<Caller> {
    view()?.caller.clone()
}

/// Whether the caller's role allows something. Without a caller the relay is asked: it decides in any case.
pub fn may(allows: fn(Role) -> bool) -> bool {
    caller().is_none_or(|caller| allows(caller.role))
}

/// Whether the caller may close the write window, and open it with the right role: a person, not a tablet on a wall.
pub fn is_person() -> bool {
    caller().is_none_or(|caller| matches!(caller.kind, ActorKind::Person | ActorKind::Local))
}

/// Proves that a request comes from this page.
pub fn csrf() -> Option<String> {
    caller()?.csrf
}

/// Asks the relay.
pub async fn ask() -> Answered<Rc<SessionView>> {
    rest::session().await.map(put)
}

/// Keeps what the relay said.
pub fn put(view: SessionView) -> Rc<SessionView> {
    let view = Rc::new(view);
    let before = SESSION.with(|session| session.view.replace(Some(view.clone())));
    if before.as_ref() != Some(&view) {
        SESSION.with(|session| session.watchers.clone()).wake();
    }
    view
}

/// The relay does not know this browser any more.
pub fn lost() {
    if let Some(view) = view().filter(|view| view.state == SessionState::SignedIn) {
        put(SessionView { state: SessionState::SignedOut, caller: None, ..(*view).clone() });
    }
}

/// Ends the session.
pub async fn sign_out() {
    // Whether or not the relay hears it: this page forgets.
    let _ = rest::sign_out().await;
    lost();
}

/// Wakes when something about it changes.
pub fn watch(wake: Callback<()>) -> Watch {
    SESSION.with(|session| session.watchers.watch(wake))
}

/// Tells the relay now and then that a person is there, as long as one is: a session without anybody ends.
pub fn watch_activity() {
    let seen = Closure::<dyn Fn()>::new(|| {
        let now = browser::now_ms();
        let is_due = SESSION.with(|session| {
            let is_due = now - session.active_ms.get() > ACTIVE_MS;
            if is_due {
                session.active_ms.set(now);
            }
            is_due
        });
        if is_due && csrf().is_some() {
            spawn_local(async {
                // Refused only where the session has ended, which is then known.
                let _ = rest::is_active().await;
            });
        }
    });
    for event in ["keydown", "pointerdown"] {
        browser::on_document(event, seen.as_ref().unchecked_ref());
    }
    // Lives as long as the page.
    seen.forget();
}

/// ms between two words that somebody is there.
const ACTIVE_MS: f64 = 60_000.0;
