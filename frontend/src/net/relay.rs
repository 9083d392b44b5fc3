//! The connection to the relay: keeps the rows up to date, carries commands, and comes back by itself.

use std::{
    cell::{Cell, RefCell},
    fmt,
    rc::Rc,
};

use cipdeck_shared::{
    api::{ClientMessage, PROTOCOL_VERSION, Problem},
    config::BlockId,
};
use gloo_timers::callback::{Interval, Timeout};
use yew::{Callback, platform::spawn_local};

use super::{
    heard::Heard,
    reconnect::{Action, Input, Phase, Reconnect},
    rest::{self, unreachable},
    sequence::Sequence,
    socket::Socket,
};
use crate::{
    browser,
    i18n::tr,
    store::{RowStore, Shelf, TargetStore, Watch, Watchers},
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
    has_snapshot: Cell<bool>,
    lost_ms: Cell<f64>,
    watchers: Watchers,
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
            has_snapshot: Cell::default(),
            lost_ms: Cell::default(),
            watchers: Watchers::default(),
            spent,
        }))
    }

    /// Connects, or tries again at once.
    pub fn connect(&self) {
        self.input(Input::Try);
    }

    /// What to show.
    pub fn link(&self) -> Link {
        self.0.link.borrow().clone()
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
    pub fn run(&self, block: BlockId, confirm_write: Option<u64>, refused: Callback<Problem>) {
        self.command(
            |id| ClientMessage::Run { id, block, ticket: confirm_write.map(|revision| revision.to_string()) },
            refused,
        );
    }

    /// Sets IN.
    pub fn set_in(
        &self,
        block: BlockId,
        input: bool,
        confirm_write: Option<u64>,
        refused: Callback<Problem>,
    ) {
        self.command(
            |id| ClientMessage::In {
                id,
                block,
                input,
                ticket: confirm_write.map(|revision| revision.to_string()),
            },
            refused,
        );
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
            Some(Action::Open) => self.open(),
            Some(Action::Wait(ms)) => self.wait(ms),
            None => {}
        }
    }

    fn open(&self) {
        self.0.wait.take();
        let (talking, closing) = (self.clone(), self.clone());
        let on_text = Callback::from(move |text: String| talking.hear(&text));
        let on_close = Callback::from(move |()| closing.closed());
        let socket =
            browser::websocket_url("/api/v1/ws").and_then(|url| Socket::open(&url, on_text, on_close));
        let failed = socket.is_none();
        self.0.socket.replace(socket);
        if failed {
            self.input(Input::Closed);
        }
    }

    fn closed(&self) {
        // The socket is in the middle of calling us: it goes after it has returned.
        let old = self.0.socket.take();
        spawn_local(async move { drop(old) });
        self.0.probe.take();
        if self.0.has_snapshot.replace(false) {
            self.0.lost_ms.set(browser::now_ms());
        }
        *self.0.sequence.borrow_mut() = Sequence::default();
        let pending = std::mem::take(&mut *self.0.pending.borrow_mut());
        for refused in pending.values() {
            refused.emit(unreachable(tr!("problem.connection_lost").to_string()));
        }
        self.input(Input::Closed);
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

/// ms between two measurements of the latency.
const PROBE_MS: u32 = 5_000;
