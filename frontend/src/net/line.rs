//! A WebSocket to the relay, and what is the same whatever it carries: it is opened for whom the relay wants to talk to,
//! it says how it is, and it comes back by itself.

use std::{
    cell::{Cell, RefCell},
    fmt,
    rc::Rc,
};

use cipdeck_shared::api::{SessionState, WriteState};
use gloo_timers::callback::{Interval, Timeout};
use serde::Serialize;
use yew::{Callback, platform::spawn_local};

use super::{
    link::{Link, Writing},
    pulse::{LOOK_MS, Pulse},
    reconnect::{Action, Input, Phase, Reconnect},
    rest, session,
    socket::Socket,
};
use crate::{
    browser,
    store::{Watch, Watchers},
};

/// What one of the relay's WebSockets carries: what is known from it, and how it is heard.
pub trait Carried: Sized + 'static {
    /// Where the relay has it.
    const PATH: &'static str;

    /// Takes in a message, which came at this time of [`browser::now_ms`].
    fn hear(line: &Line<Self>, text: &str, now_ms: f64);

    /// The socket is gone, and with it whatever waits for an answer.
    fn dropped(&self) {}

    /// Whoever is here now may not see it.
    fn forget(&self);
}

/// A handle to a connection. Clones are the same connection.
pub struct Line<T>(Rc<Inner<T>>);

struct Inner<T> {
    carried: T,
    machine: RefCell<Reconnect>,
    socket: RefCell<Option<Socket>>,
    wait: RefCell<Option<Timeout>>,
    looks: RefCell<Option<Interval>>,
    pulse: Cell<Pulse>,
    link: RefCell<Link>,
    writing: RefCell<Rc<Writing>>,
    is_complete: Cell<bool>,
    lost_ms: Cell<f64>,
    watchers: Watchers,
    session: RefCell<Option<Watch>>,
    spent: Callback<f64>,
}

impl<T: Carried> Line<T> {
    /// A connection that is not opened yet. `spent` hears how many ms of script each message took.
    pub fn carrying(carried: T, spent: Callback<f64>) -> Self {
        Self(Rc::new(Inner {
            carried,
            machine: RefCell::default(),
            socket: RefCell::default(),
            wait: RefCell::default(),
            looks: RefCell::default(),
            pulse: Cell::new(Pulse::new(browser::now_ms())),
            link: RefCell::new(Link::Connecting),
            writing: RefCell::default(),
            is_complete: Cell::default(),
            lost_ms: Cell::default(),
            watchers: Watchers::default(),
            session: RefCell::default(),
            spent,
        }))
    }

    /// Connects, or tries again at once. From then on it also follows the session of this browser.
    pub fn connect(&self) {
        let line = self.clone();
        self.0.session.replace(Some(session::watch(Callback::from(move |()| {
            if let Some(view) = session::view() {
                line.follow(view.state);
            }
        }))));
        self.input(Input::Try);
    }

    /// What to show.
    pub fn link(&self) -> Link {
        self.0.link.borrow().clone()
    }

    /// Whether the relay talks to us.
    pub fn is_live(&self) -> bool {
        matches!(*self.0.link.borrow(), Link::Online { .. })
    }

    /// Whether the relay has to do with somebody else first, before anything of it can be shown.
    pub fn is_closed_to_us(&self) -> bool {
        matches!(*self.0.link.borrow(), Link::SetUp | Link::SignedOut | Link::Denied)
    }

    /// What the relay says about writing; [`Self::watch`] tells when that changes, too.
    pub fn writing(&self) -> Rc<Writing> {
        self.0.writing.borrow().clone()
    }

    /// Wakes when [`Self::link`] changes, and whenever what it carries does.
    pub fn watch(&self, wake: Callback<()>) -> Watch {
        self.0.watchers.watch(wake)
    }

    /// What is known from it.
    pub(crate) fn carried(&self) -> &T {
        &self.0.carried
    }

    /// Tells everybody that something has changed.
    pub(crate) fn wake(&self) {
        self.0.watchers.wake();
    }

    /// Whether a message was handed to the browser.
    pub(crate) fn say(&self, message: &impl Serialize) -> bool {
        let text = serde_json::to_string(message).unwrap_or_default();
        self.0.socket.borrow().as_ref().is_some_and(|socket| socket.send(&text))
    }

    /// Whether there has ever been a relay.
    pub(crate) fn was_online(&self) -> bool {
        self.0.machine.borrow().was_online()
    }

    /// Whether everything has been heard that the relay says at first.
    pub(crate) fn is_complete(&self) -> bool {
        self.0.is_complete.get()
    }

    /// Everything has been heard now; whether that is new.
    pub(crate) fn complete(&self) -> bool {
        !self.0.is_complete.replace(true)
    }

    /// The relay's first word: whether it speaks the protocol that this page speaks.
    pub(crate) fn greeted(&self, theirs: u32, ours: u32) -> bool {
        self.0.wait.take();
        if theirs != ours {
            self.show(Link::Foreign { protocol: theirs });
            return false;
        }
        self.input(Input::Hello);
        self.show(Link::Online { latency_ms: None });
        self.0.pulse.set(Pulse::new(browser::now_ms()));
        self.ask();
        let line = self.clone();
        self.0.looks.replace(Some(Interval::new(LOOK_MS, move || line.look())));
        true
    }

    /// What the relay says about writing now.
    pub(crate) fn heard_access(&self, state: WriteState) {
        self.0.writing.replace(Rc::new(Writing::heard(state)));
        self.wake();
    }

    fn input(&self, input: Input) {
        let action = self.0.machine.borrow_mut().step(input);
        match action {
            Some(Action::Open) => {
                let line = self.clone();
                self.0.wait.replace(Some(Timeout::new(OPENING_MS, move || line.gave_up(Phase::Connecting))));
                let line = self.clone();
                spawn_local(async move {
                    match session::ask().await {
                        Ok(view) if view.state != SessionState::SignedIn => line.follow(view.state),
                        // Without an answer the socket will not open either, and says so.
                        _ => line.open(),
                    }
                });
            }
            Some(Action::Wait(ms)) => self.wait(ms),
            None => {}
        }
    }

    /// What the session of this browser means for the connection.
    fn follow(&self, state: SessionState) {
        match state {
            SessionState::SignedIn => {}
            SessionState::SetUp => self.refused(Link::SetUp),
            SessionState::SignedOut => self.refused(Link::SignedOut),
        }
    }

    fn open(&self) {
        // Refused, or given up, while the relay was asked who is here.
        if self.0.machine.borrow().phase() != Phase::Connecting {
            return;
        }
        let (talking, closing) = (self.clone(), self.clone());
        let on_text = Callback::from(move |text: String| talking.hear(&text));
        let on_close = Callback::from(move |code| closing.closed(code));
        let socket = browser::websocket_url(T::PATH).and_then(|url| Socket::open(&url, on_text, on_close));
        let failed = socket.is_none();
        self.0.socket.replace(socket);
        if failed {
            self.input(Input::Closed);
        }
    }

    fn hear(&self, text: &str) {
        let start = browser::now_ms();
        self.seen(start);
        T::hear(self, text, start);
        self.0.spent.emit(browser::now_ms() - start);
    }

    fn closed(&self, code: u16) {
        match code {
            CLOSE_SIGNED_OUT => {
                session::lost();
                self.refused(Link::SignedOut);
            }
            CLOSE_DENIED => self.refused(Link::Denied),
            _ => self.lost(),
        }
    }

    /// Whether the relay is still there; if nobody knows, it is asked.
    fn look(&self) {
        let mut pulse = self.0.pulse.get();
        let is_lost = pulse.is_lost(browser::now_ms());
        self.0.pulse.set(pulse);
        if is_lost { self.gave_up(Phase::Online) } else { self.ask() }
    }

    /// A small request: its answer is a sign of life, and measures how far away the relay is.
    fn ask(&self) {
        let line = self.clone();
        spawn_local(async move {
            let start = browser::now_ms();
            if rest::is_there().await && line.0.machine.borrow().phase() == Phase::Online {
                let now = browser::now_ms();
                line.seen(now);
                line.show(Link::Online { latency_ms: Some(now - start) });
            }
        });
    }

    fn seen(&self, now_ms: f64) {
        let mut pulse = self.0.pulse.get();
        pulse.seen(now_ms);
        self.0.pulse.set(pulse);
    }

    /// The relay has been silent in this phase for longer than anybody waits.
    fn gave_up(&self, phase: Phase) {
        if self.0.machine.borrow().phase() == phase {
            self.lost();
        }
    }

    fn lost(&self) {
        self.drop_socket();
        self.input(Input::Closed);
    }

    /// Nothing of the relay is shown to whom it does not want to show it; drafts stay where they are.
    fn refused(&self, link: Link) {
        self.drop_socket();
        self.input(Input::Refused);
        self.0.carried.forget();
        self.show(link);
    }

    fn drop_socket(&self) {
        // One of them may be in the middle of calling us: they go after it has returned.
        let old = (self.0.socket.take(), self.0.looks.take());
        spawn_local(async move { drop(old) });
        if self.0.is_complete.replace(false) {
            self.0.lost_ms.set(browser::now_ms());
        }
        self.0.writing.replace(Rc::default());
        self.0.carried.dropped();
    }

    fn wait(&self, ms: u32) {
        let line = self.clone();
        self.0.wait.replace(Some(Timeout::new(ms, move || line.input(Input::Due))));
        let next_ms = browser::now_ms() + f64::from(ms);
        self.show(if self.was_online() {
            Link::Lost { next_ms, since_ms: self.0.lost_ms.get() }
        } else {
            Link::None { next_ms }
        });
    }

    fn show(&self, link: Link) {
        let is_new = *self.0.link.borrow() != link;
        *self.0.link.borrow_mut() = link;
        if is_new {
            self.wake();
        }
    }
}

impl<T> Clone for Line<T> {
    fn clone(&self) -> Self {
        Self(self.0.clone())
    }
}

impl<T> PartialEq for Line<T> {
    fn eq(&self, other: &Self) -> bool {
        Rc::ptr_eq(&self.0, &other.0)
    }
}

impl<T> fmt::Debug for Line<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Line({:?})", self.0.link.borrow())
    }
}

/// Close codes of the WebSocket: docs/WEBSOCKET.md.
const CLOSE_SIGNED_OUT: u16 = 4401;
const CLOSE_DENIED: u16 = 4403;

/// ms for the relay to say its first word.
const OPENING_MS: u32 = 10_000;
