//! The relay's targets: sessions, connections, and who does not answer.

use std::{cell::RefCell, fmt, rc::Rc};

use cipdeck_shared::{
    api::TargetStatus,
    config::{Profile, TargetPath},
    engine::TargetState,
};
use yew::Callback;

use super::{
    shelf::Shelf,
    watch::{Watch, Watchers},
};

/// A handle to the targets. Clones are the same store.
#[derive(Clone, Default)]
pub struct TargetStore(Rc<Inner>);

#[derive(Default)]
struct Inner {
    targets: RefCell<Shelf<String, Rc<TargetStatus>>>,
    watchers: Watchers,
}

impl TargetStore {
    /// All targets, by name.
    pub fn all(&self) -> Vec<Rc<TargetStatus>> {
        self.0.targets.borrow().values().cloned().collect()
    }

    /// Those that do not answer.
    pub fn down(&self) -> Vec<Rc<TargetStatus>> {
        self.all().into_iter().filter(|target| target.state == TargetState::Down).collect()
    }

    /// What kind of device is at the end of a path's first hop, if it has said so.
    pub fn profile(&self, path: &str) -> Option<Profile> {
        self.0.targets.borrow().get(&target_of(path)?)?.profile
    }

    /// The relay's whole state.
    pub fn snapshot(&self, targets: Vec<TargetStatus>) {
        *self.0.targets.borrow_mut() = Shelf::default();
        self.put(targets);
    }

    /// What has changed in the relay.
    pub fn changes(&self, targets: Vec<TargetStatus>, removed: &[String]) {
        if targets.is_empty() && removed.is_empty() {
            return;
        }
        self.0.targets.borrow_mut().retain(|name, _| !removed.contains(name));
        self.put(targets);
    }

    /// What counts up in the targets: the WebSocket tells other changes only.
    pub fn refresh(&self, targets: Vec<TargetStatus>) {
        let known = self.0.targets.borrow();
        let targets = targets.into_iter().filter(|target| known.get(&target.target).is_some()).collect();
        drop(known);
        self.put(targets);
    }

    /// Wakes when any target looks different.
    pub fn watch(&self, wake: Callback<()>) -> Watch {
        self.0.watchers.watch(wake)
    }

    fn put(&self, targets: Vec<TargetStatus>) {
        for status in targets {
            self.0.targets.borrow_mut().insert(status.target.clone(), Rc::new(status));
        }
        self.0.watchers.wake();
    }
}

/// The name under which the relay knows the target of a path.
pub fn target_of(path: &str) -> Option<String> {
    Some(path.parse::<TargetPath>().ok()?.target.to_string())
}

impl fmt::Debug for TargetStore {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "TargetStore({} targets)", self.0.targets.borrow().len())
    }
}
