//! Who wants to know that something has changed. Dropping the [`Watch`] ends the interest.

use std::{
    cell::RefCell,
    fmt,
    rc::{Rc, Weak},
};

use yew::Callback;

use super::shelf::Shelf;

/// The watchers of one thing.
#[derive(Clone, Default)]
pub struct Watchers(Rc<RefCell<List>>);

#[derive(Default)]
struct List {
    next: u64,
    wakes: Shelf<u64, Callback<()>>,
}

impl Watchers {
    /// Calls `wake` at every change until the returned guard is dropped.
    #[must_use = "dropping the watch ends it"]
    pub fn watch(&self, wake: Callback<()>) -> Watch {
        let mut list = self.0.borrow_mut();
        let number = list.next;
        list.next += 1;
        list.wakes.insert(number, wake);
        Watch { list: Rc::downgrade(&self.0), number }
    }

    /// Tells everybody. A watcher may start and end watches while it is told.
    pub fn wake(&self) {
        let wakes: Vec<_> = self.0.borrow().wakes.values().cloned().collect();
        for wake in wakes {
            wake.emit(());
        }
    }

    /// Whether nobody watches.
    pub fn is_empty(&self) -> bool {
        self.0.borrow().wakes.is_empty()
    }
}

impl fmt::Debug for Watchers {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Watchers({})", self.0.borrow().wakes.len())
    }
}

/// Keeps an interest alive.
pub struct Watch {
    list: Weak<RefCell<List>>,
    number: u64,
}

impl Drop for Watch {
    fn drop(&mut self) {
        if let Some(list) = self.list.upgrade() {
            list.borrow_mut().wakes.remove(&self.number);
        }
    }
}

impl fmt::Debug for Watch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Watch({})", self.number)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::cell::Cell;

    #[test]
    fn a_dropped_watch_is_not_told_again() {
        let told = Rc::new(Cell::new(0));
        let watchers = Watchers::default();
        let count = told.clone();
        let watch = watchers.watch(Callback::from(move |()| count.set(count.get() + 1)));
        watchers.wake();
        drop(watch);
        watchers.wake();
        assert_eq!(told.get(), 1);
        assert!(watchers.is_empty());
    }
}
