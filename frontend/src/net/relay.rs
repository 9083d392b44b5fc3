//! The connection to the relay: keeps the rows up to date, carries commands, and comes back by itself.

use std::{
    cell::{Cell, RefCell},
    fmt,
    rc::Rc,
};

use cipdeck_shared::{
    api::{ClientMessage, PROTOCOL_VERSION, Problem, SessionState, WriteState},
    config::BlockId,
};
use gloo_timers::callback::{Interval, Timeout};
use yew::{Callback, platform::spawn_local};

use super::{
    heard::Heard,
    reconnect::{Action, Input, Phase, Reconnect},
    rest::{self, unreachable},
    sequence::Sequence,
    session,
    socket::Socket,
};
use crate::{
    browser,
    i18n::tr,
    store::{DeckId, RowStore, Shelf, TargetStore, Watch, Watchers},
};

/// What the page says about the connection.
#[derive(Clone, Debug, PartialEq)]
pub enum Link {
    /// The first try.
    Connecting,
    /// Connected; the time of a small request and its answer, once it is known.
    Online {
        /// Milliseconds.
        latency_ms: Option<f64>,
    },
    /// Lost. Both times are of [`browser::now_ms`].
    Lost {
        /// When the next try is due, in milliseconds.
        next_ms: f64,
        /// When it was lost, in milliseconds.
        since_ms: f64,
    },
    /// There has never been a relay behind this page.
    None {
        /// As in `Lost`.
        next_ms: f64,
    },
    /// The relay speaks another protocol than this page.
    Foreign {
        /// The relay's.
        protocol: u32,
    },
    /// There is no administrator yet.
    SetUp,
    /// Nobody is signed in, or not any more.
    SignedOut,
    /// Who is signed in may not watch.
    Denied,
}

/// What the relay says about writing.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Writing {
    /// As it was heard.
    pub state: WriteState,
    /// When the window closes, in ms of [`browser::now_ms`].
    pub ends_ms: f64,
}

impl Writing {
    /// What was heard just now, of a window that closes in so many ms.
    pub fn heard(state: WriteState, left_ms: u64) -> Self {
        #[expect(clippy::cast_precision_loss, reason = "an hour at most")]
        let ends_ms = browser::now_ms() + left_ms as f64;
        Self { state, ends_ms }
    }
}

/// A handle to the connection. Clones are the same connection.
#[derive(Clone)]
pub struct Relay(Rc<Inner>);

struct Inner {
    rows: RowStore,
    targets: TargetStore,
    machine: RefCell<Reconnect>,
    sequence: RefCell<Sequence>,
    socket: RefCell<Option<Socket>>,
    wait: RefCell<Option<Timeout>>,
    probe: RefCell<Option<Interval>>,
    pending: RefCell<Shelf<String, Callback<Problem>>>,
    last_command: Cell<u64>,
    link: RefCell<Link>,
    writing: RefCell<Rc<Writing>>,
    has_snapshot: Cell<bool>,
    lost_ms: Cell<f64>,
    watchers: Watchers,
    session: RefCell<Option<Watch>>,
    spent: Callback<f64>,
}

impl Relay {
    /// A connection that is not opened yet. `spent` hears how many ms of script each message took.
    pub fn new(rows: RowStore, spent: Callback<f64>) -> Self {
        Self(Rc::new(Inner {
            rows,
            targets: TargetStore::default(),
            machine: RefCell::default(),
            sequence: RefCell::default(),
            socket: RefCell::default(),
            wait: RefCell::default(),
            probe: RefCell::default(),
            pending: RefCell::default(),
            last_command: Cell::default(),
            link: RefCell::new(Link::Connecting),
            writing: RefCell::default(),
            has_snapshot: Cell::default(),
            lost_ms: Cell::default(),
            watchers: Watchers::default(),
            session: RefCell::default(),
            spent,
        }))
    }

    /// Connects, or tries again at once. From then on it also follows the session of this browser.
    pub fn connect(&self) {
        let relay = self.clone();
        self.0.session.replace(Some(session::watch(Callback::from(move |()| {
            if let Some(view) = session::view() {
                relay.follow(view.state);
            }
        }))));
        self.input(Input::Try);
    }

    /// What to show.
    pub fn link(&self) -> Link {
        self.0.link.borrow().clone()
    }

    /// What the relay says about writing; [`Self::watch`] tells when that changes, too.
    pub fn writing(&self) -> Rc<Writing> {
        self.0.writing.borrow().clone()
    }

    /// Whether the relay has to do with somebody else first, before anything of it can be shown.
    pub fn is_closed_to_us(&self) -> bool {
        matches!(*self.0.link.borrow(), Link::SetUp | Link::SignedOut | Link::Denied)
    }

    /// What the relay knows of its targets.
    pub fn targets(&self) -> &TargetStore {
        &self.0.targets
    }

    /// Whether commands reach the relay.
    pub fn is_online(&self) -> bool {
        matches!(*self.0.link.borrow(), Link::Online { .. }) && self.0.has_snapshot.get()
    }

    /// Whether the first try is still open: nobody knows yet what the relay has.
    pub fn is_undecided(&self) -> bool {
        match *self.0.link.borrow() {
            Link::Connecting => true,
            Link::Online { .. } => !self.0.has_snapshot.get(),
            _ => false,
        }
    }

    /// Wakes when [`Self::link`] changes.
    pub fn watch(&self, wake: Callback<()>) -> Watch {
        self.0.watchers.watch(wake)
    }

    /// Runs a block once.
    pub fn run(&self, block: BlockId, ticket: Option<String>, refused: Callback<Problem>) {
        self.command(|id| ClientMessage::Run { id, block, ticket }, refused);
    }

    /// Sets IN.
    pub fn set_in(&self, block: BlockId, input: bool, ticket: Option<String>, refused: Callback<Problem>) {
        self.command(|id| ClientMessage::In { id, block, input, ticket }, refused);
    }

    /// Cancels what is running.
    pub fn cancel(&self, block: BlockId, refused: Callback<Problem>) {
        self.command(|id| ClientMessage::Cancel { id, block }, refused);
    }

    fn command(&self, message: impl FnOnce(String) -> ClientMessage, refused: Callback<Problem>) {
        let number = self.0.last_command.get() + 1;
        self.0.last_command.set(number);
        let id = format!("c{number}");
        let text = serde_json::to_string(&message(id.clone())).unwrap_or_default();
        let sent = self.0.socket.borrow().as_ref().is_some_and(|socket| socket.send(&text));
        if sent {
            self.0.pending.borrow_mut().insert(id, refused);
        } else {
            refused.emit(unreachable(tr!("problem.not_connected").to_string()));
        }
    }

    fn input(&self, input: Input) {
        let action = self.0.machine.borrow_mut().step(input);
        match action {
            Some(Action::Open) => {
                self.0.wait.take();
                let relay = self.clone();
                spawn_local(async move {
                    match session::ask().await {
                        Ok(view) if view.state != SessionState::SignedIn => relay.follow(view.state),
                        // Without an answer the socket will not open either, and says so.
                        _ => relay.open(),
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
        let (talking, closing) = (self.clone(), self.clone());
        let on_text = Callback::from(move |text: String| talking.hear(&text));
        let on_close = Callback::from(move |code| closing.closed(code));
        let socket =
            browser::websocket_url("/api/v1/ws").and_then(|url| Socket::open(&url, on_text, on_close));
        let failed = socket.is_none();
        self.0.socket.replace(socket);
        if failed {
            self.input(Input::Closed);
        }
    }

    fn closed(&self, code: u16) {
        match code {
            CLOSE_SIGNED_OUT => {
                session::lost();
                self.refused(Link::SignedOut);
            }
            CLOSE_DENIED => self.refused(Link::Denied),
            _ => {
                self.drop_socket();
                self.input(Input::Closed);
            }
        }
    }

    /// Nothing of the relay is shown to whom it does not want to show it; drafts stay where they are.
    fn refused(&self, link: Link) {
        self.drop_socket();
        self.input(Input::Refused);
        self.0.rows.snapshot(Vec::new(), Vec::new());
        self.0.targets.snapshot(Vec::new());
        self.show(link);
    }

    fn drop_socket(&self) {
        // The socket may be in the middle of calling us: it goes after it has returned.
        let old = self.0.socket.take();
        spawn_local(async move { drop(old) });
        self.0.probe.take();
        if self.0.has_snapshot.replace(false) {
            self.0.lost_ms.set(browser::now_ms());
        }
        *self.0.sequence.borrow_mut() = Sequence::default();
        self.0.writing.replace(Rc::default());
        let pending = std::mem::take(&mut *self.0.pending.borrow_mut());
        for refused in pending.values() {
            refused.emit(unreachable(tr!("problem.connection_lost").to_string()));
        }
    }

    fn wait(&self, ms: u32) {
        let relay = self.clone();
        self.0.wait.replace(Some(Timeout::new(ms, move || relay.input(Input::Due))));
        let next_ms = browser::now_ms() + f64::from(ms);
        let known = self.0.machine.borrow().was_online();
        self.show(if known {
            Link::Lost { next_ms, since_ms: self.0.lost_ms.get() }
        } else {
            Link::None { next_ms }
        });
    }

    fn hear(&self, text: &str) {
        let start = browser::now_ms();
        // A message of a newer relay that we do not know is none of our business.
        if let Ok(message) = serde_json::from_str(text) {
            self.take(message);
        }
        self.0.spent.emit(browser::now_ms() - start);
    }

    fn take(&self, message: Heard) {
        match message.kind.as_str() {
            "hello" if message.protocol != PROTOCOL_VERSION => {
                self.show(Link::Foreign { protocol: message.protocol });
            }
            "hello" => self.greeted(),
            "access" => {
                let left_ms = message.window.as_ref().map_or(0, |window| window.left_ms);
                let (window, read_only, stopped) = (message.window, message.read_only, message.stopped);
                let state = WriteState { window, read_only, stopped };
                self.0.writing.replace(Rc::new(Writing::heard(state, left_ms)));
                self.0.watchers.wake();
            }
            "snapshot" => {
                self.0.sequence.borrow_mut().snapshot(message.seq);
                self.0.targets.snapshot(message.targets);
                self.0.rows.snapshot(message.blocks, message.statuses);
                if !self.0.has_snapshot.replace(true) {
                    self.0.watchers.wake();
                }
            }
            "changes" if self.0.sequence.borrow_mut().changes(message.seq) => {
                self.0.targets.changes(message.targets, &message.targets_removed);
                self.0.rows.changes(message.statuses, message.blocks, &message.removed);
            }
            "answer" => {
                let refused = self.0.pending.borrow_mut().remove(&message.id);
                if let Some((status, written)) =
                    message.status.and_then(|mut status| status.written.take().map(|it| (status, it)))
                {
                    self.0.rows.put_written(DeckId::Stored(status.block), status.runs, written);
                }
                if let (Some(refused), Some(problem)) = (refused, message.problem) {
                    refused.emit(problem);
                }
            }
            // A message of a newer relay that we do not know is none of our business.
            _ => {}
        }
    }

    fn greeted(&self) {
        self.input(Input::Hello);
        self.show(Link::Online { latency_ms: None });
        self.probe();
        let relay = self.clone();
        self.0.probe.replace(Some(Interval::new(PROBE_MS, move || relay.probe())));
    }

    /// Measures how long a small request takes.
    fn probe(&self) {
        let relay = self.clone();
        spawn_local(async move {
            let start = browser::now_ms();
            let answered = rest::health().await.is_ok();
            if answered && relay.0.machine.borrow().phase() == Phase::Online {
                relay.show(Link::Online { latency_ms: Some(browser::now_ms() - start) });
            }
        });
    }

    fn show(&self, link: Link) {
        let is_new = *self.0.link.borrow() != link;
        *self.0.link.borrow_mut() = link;
        if is_new {
            self.0.watchers.wake();
        }
    }
}

impl PartialEq for Relay {
    fn eq(&self, other: &Self) -> bool {
        Rc::ptr_eq(&self.0, &other.0)
    }
}

impl fmt::Debug for Relay {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Relay({:?})", self.0.link.borrow())
    }
}

/// Close codes of the WebSocket: docs/WEBSOCKET.md.
const CLOSE_SIGNED_OUT: u16 = 4401;
const CLOSE_DENIED: u16 = 4403;

/// ms between two measurements of the latency.
const PROBE_MS: u32 = 5_000;
