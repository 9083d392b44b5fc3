//! The connection that carries blocks: keeps the rows up to date, and takes commands.

use std::cell::{Cell, RefCell};

use cipdeck_shared::{
    api::{ClientMessage, PROTOCOL_VERSION, Problem, WriteState},
    config::BlockId,
};
use yew::Callback;

use super::{
    heard::Heard,
    line::{Carried, Line},
    link::Link,
    rest::unreachable,
    sequence::Sequence,
};
use crate::{
    i18n::tr,
    store::{DeckId, RowStore, Shelf, TargetStore},
};

/// A handle to the connection. Clones are the same connection.
pub type Relay = Line<Deck>;

/// What is known of blocks and their targets, and the commands without an answer.
#[derive(Debug)]
pub struct Deck {
    rows: RowStore,
    targets: TargetStore,
    sequence: RefCell<Sequence>,
    pending: RefCell<Shelf<String, Callback<Problem>>>,
    last_command: Cell<u64>,
}

impl Line<Deck> {
    /// A connection that is not opened yet. `spent` hears how many ms of script each message took.
    pub fn new(rows: RowStore, spent: Callback<f64>) -> Self {
        let deck = Deck {
            rows,
            targets: TargetStore::default(),
            sequence: RefCell::default(),
            pending: RefCell::default(),
            last_command: Cell::default(),
        };
        Self::carrying(deck, spent)
    }

    /// What the relay knows of its targets.
    pub fn targets(&self) -> &TargetStore {
        &self.carried().targets
    }

    /// Whether commands reach the relay.
    pub fn is_online(&self) -> bool {
        self.is_live() && self.is_complete()
    }

    /// Whether the first try is still open: nobody knows yet what the relay has.
    pub fn is_undecided(&self) -> bool {
        match self.link() {
            Link::Connecting => true,
            Link::Online { .. } => !self.is_complete(),
            _ => false,
        }
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
        let deck = self.carried();
        let number = deck.last_command.get() + 1;
        deck.last_command.set(number);
        let id = format!("c{number}");
        if self.say(&message(id.clone())) {
            deck.pending.borrow_mut().insert(id, refused);
        } else {
            refused.emit(unreachable(tr!("problem.not_connected").to_string()));
        }
    }

    fn take(&self, message: Heard) {
        let deck = self.carried();
        match message.kind.as_str() {
            "hello" => {
                self.greeted(message.protocol, PROTOCOL_VERSION);
            }
            "access" => {
                let (window, read_only, stopped) = (message.window, message.read_only, message.stopped);
                self.heard_access(WriteState { window, read_only, stopped });
            }
            "snapshot" => {
                deck.sequence.borrow_mut().snapshot(message.seq);
                deck.targets.snapshot(message.targets);
                deck.rows.snapshot(message.blocks, message.statuses);
                if self.complete() {
                    self.wake();
                }
            }
            "changes" if deck.sequence.borrow_mut().changes(message.seq) => {
                deck.targets.changes(message.targets, &message.targets_removed);
                deck.rows.changes(message.statuses, message.blocks, &message.removed);
            }
            "answer" => deck.answered(message),
            // A message of a newer relay that we do not know is none of our business.
            _ => {}
        }
    }
}

impl Deck {
    fn answered(&self, message: Heard) {
        let refused = self.pending.borrow_mut().remove(&message.id);
        if let Some((status, written)) =
            message.status.and_then(|mut status| status.written.take().map(|it| (status, it)))
        {
            self.rows.put_written(DeckId::Stored(status.block), status.runs, written);
        }
        if let (Some(refused), Some(problem)) = (refused, message.problem) {
            refused.emit(problem);
        }
    }
}

impl Carried for Deck {
    const PATH: &'static str = "/api/v1/ws";

    fn hear(line: &Line<Self>, text: &str, _: f64) {
        // A message of a newer relay that we do not know is none of our business.
        if let Ok(message) = serde_json::from_str(text) {
            line.take(message);
        }
    }

    fn dropped(&self) {
        *self.sequence.borrow_mut() = Sequence::default();
        let pending = std::mem::take(&mut *self.pending.borrow_mut());
        for refused in pending.values() {
            refused.emit(unreachable(tr!("problem.connection_lost").to_string()));
        }
    }

    fn forget(&self) {
        self.rows.snapshot(Vec::new(), Vec::new());
        self.targets.snapshot(Vec::new());
    }
}
