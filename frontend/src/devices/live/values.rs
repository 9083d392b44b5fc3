//! The newest value of each variable, outside the virtual DOM.
//!
//! Values come as often as they like; the page hears of it once per animation frame, and only those rows hear of it
//! whose value has changed.

use std::{cell::RefCell, fmt, rc::Rc};

use cipdeck_shared::{
    api::Quality,
    config::{GroupId, VariableId},
};
use yew::Callback;

use super::heard::Newest;
use crate::{
    devices::trend::Series,
    store::{AskForFrame, Shelf, Watch, Watchers},
};

/// A value, and what was seen of it here.
#[derive(Clone, Debug, PartialEq)]
pub struct Shown {
    /// As the relay said it.
    pub value: Newest,
    /// When, in ms of [`crate::browser::now_ms`].
    pub heard_ms: f64,
    /// The smallest and the biggest number since the page watches.
    pub range: Option<(f64, f64)>,
}

/// A handle to the values. Clones are the same store.
#[derive(Clone)]
pub struct ValueStore(Rc<Inner>);

struct Inner {
    ask_for_frame: AskForFrame,
    state: RefCell<State>,
    frame_watchers: Watchers,
}

#[derive(Default)]
struct State {
    values: Shelf<VariableId, (GroupId, Rc<Shown>)>,
    watchers: Shelf<VariableId, Watchers>,
    series: Shelf<VariableId, Series>,
    dirty: Shelf<VariableId, ()>,
    frame_asked: bool,
}

impl ValueStore {
    /// An empty store.
    pub fn new(ask_for_frame: AskForFrame) -> Self {
        let (state, frame_watchers) = (RefCell::default(), Watchers::default());
        Self(Rc::new(Inner { ask_for_frame, state, frame_watchers }))
    }

    /// The value as it is now.
    pub fn value(&self, id: VariableId) -> Option<Rc<Shown>> {
        self.0.state.borrow().values.get(&id).map(|(_, shown)| shown.clone())
    }

    /// Wakes after frames in which this value has changed.
    pub fn watch(&self, id: VariableId, wake: Callback<()>) -> Watch {
        self.0.state.borrow_mut().watchers.or_default(id).watch(wake)
    }

    /// Wakes after every frame in which any value has changed.
    pub fn watch_frames(&self, wake: Callback<()>) -> Watch {
        self.0.frame_watchers.watch(wake)
    }

    /// Newer values.
    pub fn put(&self, group: GroupId, values: Vec<Newest>, now_ms: f64) {
        let mut state = self.0.state.borrow_mut();
        for value in values {
            state.put(group, value, now_ms);
        }
        drop(state);
        self.ask();
    }

    /// Forgets the values of a group that nobody looks at any more.
    pub fn forget(&self, group: GroupId) {
        self.0.state.borrow_mut().values.retain(|_, (of, _)| *of != group);
    }

    /// Forgets everything: whoever is here now shall not see it.
    pub fn clear(&self) {
        let mut state = self.0.state.borrow_mut();
        (state.values, state.series) = (Shelf::default(), Shelf::default());
    }

    /// The smallest and biggest numbers of a group are counted anew.
    pub fn reset_ranges(&self, group: GroupId) {
        let mut state = self.0.state.borrow_mut();
        let mut reset = Vec::new();
        for (id, (of, shown)) in state.values.iter_mut() {
            if *of == group {
                let range = shown.value.number.map(|number| (number, number));
                Rc::make_mut(shown).range = range;
                reset.push(*id);
            }
        }
        for id in reset {
            state.dirty.insert(id, ());
        }
        drop(state);
        self.ask();
    }

    /// Keeps the numbers of exactly these variables from now on.
    pub fn trace(&self, ids: &[VariableId]) {
        let mut state = self.0.state.borrow_mut();
        state.series.retain(|id, _| ids.contains(id));
        for id in ids {
            state.series.or_default(*id);
        }
    }

    /// The kept numbers of a variable.
    pub fn series<T>(&self, id: VariableId, look: impl FnOnce(&Series) -> T) -> Option<T> {
        self.0.state.borrow().series.get(&id).map(look)
    }

    fn ask(&self) {
        let mut state = self.0.state.borrow_mut();
        if state.frame_asked {
            return;
        }
        state.frame_asked = true;
        drop(state);
        let store = self.clone();
        (self.0.ask_for_frame)(Box::new(move || store.flush()));
    }

    fn flush(&self) {
        let mut state = self.0.state.borrow_mut();
        state.frame_asked = false;
        let dirty = std::mem::take(&mut state.dirty);
        state.watchers.retain(|_, watchers| !watchers.is_empty());
        let woken: Vec<_> = dirty.keys().filter_map(|id| state.watchers.get(id).cloned()).collect();
        drop(state);
        for watchers in woken {
            watchers.wake();
        }
        self.0.frame_watchers.wake();
    }
}

impl State {
    fn put(&mut self, group: GroupId, value: Newest, now_ms: f64) {
        let id = value.variable;
        let number = value.number.filter(|number| number.is_finite());
        if let Some(series) = self.series.get_mut(&id) {
            series.push(now_ms, number.filter(|_| is_fresh(&value)));
        }
        let before = self.values.get(&id).and_then(|(_, shown)| shown.range);
        let range = match (before, number) {
            (Some((low, high)), Some(number)) => Some((low.min(number), high.max(number))),
            (before, number) => before.or(number.map(|number| (number, number))),
        };
        self.values.insert(id, (group, Rc::new(Shown { value, heard_ms: now_ms, range })));
        self.dirty.insert(id, ());
    }
}

/// Whether a value is one of now.
fn is_fresh(value: &Newest) -> bool {
    value.quality == Quality::Good
}

impl PartialEq for ValueStore {
    fn eq(&self, other: &Self) -> bool {
        Rc::ptr_eq(&self.0, &other.0)
    }
}

impl fmt::Debug for ValueStore {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "ValueStore({} values)", self.0.state.borrow().values.len())
    }
}

#[cfg(test)]
mod tests;
