//! What went wrong with a command, until the next one.

use std::{cell::RefCell, fmt, rc::Rc};

use cipdeck_shared::{api::Problem, config::Block};
use yew::Callback;

use crate::store::{DeckId, Shelf, Watch, Watchers};

/// Something to tell about an entry.
#[derive(Clone, Debug, PartialEq)]
pub enum Notice {
    /// A command was not carried out.
    Problem(Rc<Problem>),
    /// Somebody else has changed the block: this is what the relay has now.
    Conflict(Rc<Block>),
}

/// The newest notice of each entry. Clones are the same store.
#[derive(Clone, Default)]
pub struct NoticeStore(Rc<Inner>);

#[derive(Default)]
struct Inner {
    notices: RefCell<Shelf<DeckId, Notice>>,
    watchers: Watchers,
}

impl NoticeStore {
    /// What is to be told about an entry.
    pub fn notice(&self, id: DeckId) -> Option<Notice> {
        self.0.notices.borrow().get(&id).cloned()
    }

    /// Tells something new.
    pub fn put(&self, id: DeckId, notice: Notice) {
        self.0.notices.borrow_mut().insert(id, notice);
        self.0.watchers.wake();
    }

    /// There is nothing to tell any more.
    pub fn clear(&self, id: DeckId) {
        if self.0.notices.borrow_mut().remove(&id).is_some() {
            self.0.watchers.wake();
        }
    }

    /// Wakes when any notice comes or goes.
    pub fn watch(&self, wake: Callback<()>) -> Watch {
        self.0.watchers.watch(wake)
    }
}

impl fmt::Debug for NoticeStore {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "NoticeStore({} notices)", self.0.notices.borrow().len())
    }
}
