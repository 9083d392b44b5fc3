//! Blocks that run in the browser alone, against the demo device behind `0,0`.

mod bench;

use std::{cell::RefCell, fmt, rc::Rc};

use cipdeck_shared::{
    api::{BlockStatus, ExchangeView, LastSuccess},
    config::{BlockId, write_hex},
    engine::{BlockView, CommandError, Instant},
    plan::MessagePlan,
};
use gloo_timers::callback::Timeout;

pub use self::bench::{Bench, News};
use crate::{
    browser,
    store::{DeckId, RowStore, Shelf},
};

/// A handle to the browser's engine. Clones are the same engine.
#[derive(Clone)]
pub struct Demo(Rc<Inner>);

struct Inner {
    rows: RowStore,
    bench: RefCell<Bench>,
    names: RefCell<Shelf<DeckId, BlockId>>,
    /// The last success, and after which run.
    last: RefCell<Shelf<BlockId, (u64, LastSuccess)>>,
    timer: RefCell<Option<Timeout>>,
}

impl Demo {
    /// Without blocks. What happens to them goes to the rows.
    pub fn new(rows: RowStore) -> Self {
        Self(Rc::new(Inner {
            rows,
            bench: RefCell::new(Bench::new(now)),
            names: RefCell::default(),
            last: RefCell::default(),
            timer: RefCell::default(),
        }))
    }

    /// Runs a block once.
    pub fn run(&self, id: DeckId, plan: MessagePlan, confirmed: bool) -> Result<(), CommandError> {
        let block = self.put(id, plan, confirmed);
        self.command(|bench| bench.run(block))
    }

    /// Sets IN to TRUE.
    pub fn start(&self, id: DeckId, plan: MessagePlan, confirmed: bool) -> Result<(), CommandError> {
        let block = self.put(id, plan, confirmed);
        self.command(|bench| bench.set_in(block, true))
    }

    /// Sets IN to FALSE.
    pub fn stop(&self, id: DeckId) -> Result<(), CommandError> {
        let block = self.name(id);
        self.command(|bench| bench.set_in(block, false))
    }

    /// Cancels what is running.
    pub fn cancel(&self, id: DeckId) -> Result<(), CommandError> {
        let block = self.name(id);
        self.command(|bench| bench.cancel(block))
    }

    /// Forgets a block.
    pub fn remove(&self, id: DeckId) {
        let block = self.0.names.borrow_mut().remove(&id);
        if let Some(block) = block {
            self.0.bench.borrow_mut().remove(block);
            self.0.last.borrow_mut().remove(&block);
            self.settle();
        }
    }

    fn command(
        &self,
        command: impl FnOnce(&mut Bench) -> Result<(), CommandError>,
    ) -> Result<(), CommandError> {
        let done = command(&mut self.0.bench.borrow_mut());
        self.settle();
        done
    }

    fn settle(&self) {
        let news = self.0.bench.borrow_mut().settle();
        for news in news {
            match news {
                News::Changed(block, view) => self.changed(block, &view),
                News::Finished(block, exchange) => {
                    if let Some(id) = self.id(block) {
                        self.0.rows.put_exchange(id, ExchangeView::new(browser::wall_clock(), &exchange));
                    }
                }
            }
        }
        self.arm();
    }

    /// Gives the engine a block's message. The last good value of another message says nothing about it.
    fn put(&self, id: DeckId, plan: MessagePlan, confirmed: bool) -> BlockId {
        let block = self.name(id);
        let request = write_hex(plan.bytes());
        self.0.last.borrow_mut().retain(|name, (_, last)| *name != block || last.request == request);
        self.0.bench.borrow_mut().put(block, plan, confirmed);
        block
    }

    fn changed(&self, block: BlockId, view: &BlockView) {
        let at = browser::wall_clock();
        let mut status = BlockStatus::new(block, view, Some(at.clone()), None);
        let mut all = self.0.last.borrow_mut();
        // A status changes after its success, too: when IN falls.
        let is_new = all.get(&block).is_none_or(|(runs, _)| *runs != status.runs);
        if status.q && is_new {
            all.insert(block, (status.runs, LastSuccess::of(&status, at)));
        }
        status.last = all.get(&block).map(|(_, last)| last.clone());
        drop(all);
        if let Some(id) = self.id(block) {
            self.0.rows.put_status(id, status);
        }
    }

    fn arm(&self) {
        let due = self.0.bench.borrow().poll_timeout();
        let timer = due.map(|due| {
            let demo = self.clone();
            let wait = due.micros_since(now()).div_ceil(1_000);
            Timeout::new(u32::try_from(wait).unwrap_or(u32::MAX), move || demo.settle())
        });
        self.0.timer.replace(timer);
    }

    fn name(&self, id: DeckId) -> BlockId {
        let mut names = self.0.names.borrow_mut();
        let next = names.values().map(|name| name.0).max().unwrap_or(0) + 1;
        if let Some(name) = names.get(&id) {
            return *name;
        }
        names.insert(id, BlockId(next));
        BlockId(next)
    }

    fn id(&self, block: BlockId) -> Option<DeckId> {
        self.0.names.borrow().iter().find(|(_, name)| **name == block).map(|(id, _)| *id)
    }
}

impl fmt::Debug for Demo {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Demo({} blocks)", self.0.names.borrow().len())
    }
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "µs since the page was opened, never negative"
)]
fn now() -> Instant {
    Instant((browser::now_ms() * 1_000.0) as u64)
}
