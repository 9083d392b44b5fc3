//! The connection to the relay: keeps tree, statuses and values up to date, and comes back by itself.

use std::{
    cell::{Cell, RefCell},
    fmt,
    rc::Rc,
};

use cipdeck_shared::{
    api::{DeviceStatus, LIVE_PROTOCOL, LiveClientMessage, SessionState, Tree as Listed},
    config::{DeviceId, GroupId},
};
use gloo_timers::callback::Timeout;
use yew::{Callback, platform::spawn_local};

use super::{heard::Heard, tree::Tree, values::ValueStore};
use crate::{
    browser,
    net::{Action, Input, Link, Reconnect, Socket, Writing, session},
    store::{Shelf, Watch, Watchers},
};

/// A handle to all of it. Clones are the same connection.
#[derive(Clone)]
pub struct Plant(Rc<Inner>);

struct Inner {
    values: ValueStore,
    tree: RefCell<Option<Rc<Tree>>>,
    statuses: RefCell<Shelf<DeviceId, Rc<DeviceStatus>>>,
    /// How often the variables of a group have changed; watched groups only.
    watched: RefCell<Shelf<GroupId, u32>>,
    machine: RefCell<Reconnect>,
    socket: RefCell<Option<Socket>>,
    wait: RefCell<Option<Timeout>>,
    link: RefCell<Link>,
    writing: RefCell<Rc<Writing>>,
    lost_ms: Cell<f64>,
    watchers: Watchers,
    session: RefCell<Option<Watch>>,
    spent: Callback<f64>,
}

impl Plant {
    /// A connection that is not opened yet. `spent` hears how many ms of script each message took.
    pub fn new(values: ValueStore, spent: Callback<f64>) -> Self {
        Self(Rc::new(Inner {
            values,
            tree: RefCell::default(),
            statuses: RefCell::default(),
            watched: RefCell::default(),
            machine: RefCell::default(),
            socket: RefCell::default(),
            wait: RefCell::default(),
            link: RefCell::new(Link::Connecting),
            writing: RefCell::default(),
            lost_ms: Cell::default(),
            watchers: Watchers::default(),
            session: RefCell::default(),
            spent,
        }))
    }

    /// Connects, or tries again at once. From then on it also follows the session of this browser.
    pub fn connect(&self) {
        let plant = self.clone();
        self.0.session.replace(Some(session::watch(Callback::from(move |()| {
            if let Some(view) = session::view() {
                plant.follow(view.state);
            }
        }))));
        self.input(Input::Try);
    }

    /// The newest values.
    pub fn values(&self) -> &ValueStore {
        &self.0.values
    }

    /// The tree; `None` before the relay has said it.
    pub fn tree(&self) -> Option<Rc<Tree>> {
        self.0.tree.borrow().clone()
    }

    /// What a device says of itself.
    pub fn status(&self, id: DeviceId) -> Option<Rc<DeviceStatus>> {
        self.0.statuses.borrow().get(&id).cloned()
    }

    /// The connection.
    pub fn link(&self) -> Link {
        self.0.link.borrow().clone()
    }

    /// Whether what is shown is what is.
    pub fn is_live(&self) -> bool {
        matches!(*self.0.link.borrow(), Link::Online { .. })
    }

    /// What the relay says about writing.
    pub fn writing(&self) -> Rc<Writing> {
        self.0.writing.borrow().clone()
    }

    /// Whether the relay has to do with somebody else first.
    pub fn is_closed_to_us(&self) -> bool {
        matches!(*self.0.link.borrow(), Link::SetUp | Link::SignedOut | Link::Denied)
    }

    /// Wakes when anything but a value changes.
    pub fn watch(&self, wake: Callback<()>) -> Watch {
        self.0.watchers.watch(wake)
    }

    /// Asks for the values of a group.
    pub fn want(&self, group: GroupId) {
        self.0.watched.borrow_mut().insert(group, 0);
        self.tell_watched();
    }

    /// Nobody looks at a group any more.
    pub fn leave(&self, group: GroupId) {
        self.0.watched.borrow_mut().remove(&group);
        self.0.values.forget(group);
        self.tell_watched();
    }

    /// How often the variables of a watched group have changed.
    pub fn edition(&self, group: GroupId) -> u32 {
        self.0.watched.borrow().get(&group).copied().unwrap_or(0)
    }

    fn tell_watched(&self) {
        let groups = self.0.watched.borrow().keys().copied().collect();
        let text = serde_json::to_string(&LiveClientMessage::Watch { groups }).unwrap_or_default();
        if let Some(socket) = &*self.0.socket.borrow() {
            // Without a connection it is said after the next hello.
            socket.send(&text);
        }
    }

    fn input(&self, input: Input) {
        let action = self.0.machine.borrow_mut().step(input);
        match action {
            Some(Action::Open) => {
                self.0.wait.take();
                let plant = self.clone();
                spawn_local(async move {
                    match session::ask().await {
                        Ok(view) if view.state != SessionState::SignedIn => plant.follow(view.state),
                        // Without an answer the socket will not open either, and says so.
                        _ => plant.open(),
                    }
                });
            }
            Some(Action::Wait(ms)) => self.wait(ms),
            None => {}
        }
    }

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
        let url = browser::websocket_url("/api/v1/live");
        let socket = url.and_then(|url| Socket::open(&url, on_text, on_close));
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

    /// Nothing of the relay is shown to whom it does not want to show it.
    fn refused(&self, link: Link) {
        self.drop_socket();
        self.input(Input::Refused);
        self.0.tree.take();
        self.0.statuses.take();
        self.0.values.clear();
        self.show(link);
    }

    fn drop_socket(&self) {
        // The socket may be in the middle of calling us: it goes after it has returned.
        let old = self.0.socket.take();
        spawn_local(async move { drop(old) });
        if self.is_live() {
            self.0.lost_ms.set(browser::now_ms());
        }
        self.0.writing.replace(Rc::default());
    }

    fn wait(&self, ms: u32) {
        let plant = self.clone();
        self.0.wait.replace(Some(Timeout::new(ms, move || plant.input(Input::Due))));
        let next_ms = browser::now_ms() + f64::from(ms);
        let known = self.0.machine.borrow().was_online();
        let since_ms = self.0.lost_ms.get();
        self.show(if known { Link::Lost { next_ms, since_ms } } else { Link::None { next_ms } });
    }

    fn hear(&self, text: &str) {
        let start = browser::now_ms();
        if let Some(message) = Heard::read(text) {
            self.take(message, start);
        }
        self.0.spent.emit(browser::now_ms() - start);
    }

    fn take(&self, message: Heard, now_ms: f64) {
        match message {
            Heard::Values(group, values) => return self.0.values.put(group, values, now_ms),
            Heard::Hello(protocol) if protocol != LIVE_PROTOCOL => {
                return self.show(Link::Foreign { protocol });
            }
            Heard::Hello(_) => {
                if self.0.machine.borrow().was_online() {
                    // Nobody has told what has changed in between.
                    self.0.watched.borrow_mut().iter_mut().for_each(|(_, edition)| *edition += 1);
                }
                self.input(Input::Hello);
                self.tell_watched();
                return self.show(Link::Online { latency_ms: None });
            }
            Heard::Tree(Listed { devices, groups }) => {
                self.0.tree.replace(Some(Rc::new(Tree::sorted(devices, groups))));
            }
            Heard::Variables(group) => {
                if let Some(edition) = self.0.watched.borrow_mut().get_mut(&group) {
                    *edition += 1;
                }
            }
            Heard::Status(devices) => {
                for status in devices {
                    self.0.statuses.borrow_mut().insert(status.device, Rc::new(status));
                }
            }
            Heard::Access(state) => {
                let left_ms = state.window.as_ref().map_or(0, |window| window.left_ms);
                self.0.writing.replace(Rc::new(Writing::heard(state, left_ms)));
            }
        }
        self.0.watchers.wake();
    }

    fn show(&self, link: Link) {
        let is_new = *self.0.link.borrow() != link;
        *self.0.link.borrow_mut() = link;
        if is_new {
            self.0.watchers.wake();
        }
    }
}

impl PartialEq for Plant {
    fn eq(&self, other: &Self) -> bool {
        Rc::ptr_eq(&self.0, &other.0)
    }
}

impl fmt::Debug for Plant {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Plant({:?})", self.0.link.borrow())
    }
}

/// Close codes of the WebSocket: docs/WEBSOCKET.md.
const CLOSE_SIGNED_OUT: u16 = 4401;
const CLOSE_DENIED: u16 = 4403;
