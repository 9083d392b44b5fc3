//! What is to become of files.

use std::collections::BTreeMap;

use cipdeck_shared::config::project::{self as files, ProjectGroup, ProjectVariable};

use super::Touched;
use super::folder::Changes;

/// What is to become of files, and whose they are then.
#[derive(Debug, Default)]
pub(super) struct Wanted {
    pub(super) files: Changes,
    pub(super) places: BTreeMap<Touched, Option<String>>,
}

impl Wanted {
    /// One file as it should be, at its place: `changed`, or as it is `known`.
    pub(super) fn put(
        &mut self,
        key: Touched,
        old: Option<String>,
        path: String,
        changed: Option<String>,
        known: Option<&str>,
    ) {
        let has_moved = old.as_ref().is_some_and(|old| *old != path);
        if let Some(old) = old.filter(|_| has_moved) {
            self.files.insert(old, None);
        }
        if let Some(text) = changed.or_else(|| known.filter(|_| has_moved).map(str::to_owned)) {
            self.files.insert(path.clone(), Some(text));
        }
        self.places.insert(key, Some(path));
    }
}

/// Variables stay where they are in the file; new ones follow. So that a change is seen as what it is.
pub(super) fn in_the_order_of(before: &ProjectGroup, group: &mut ProjectGroup) {
    let mut places: BTreeMap<String, Vec<usize>> = BTreeMap::new();
    for (place, address) in files::addresses(&before.variables).into_iter().enumerate().rev() {
        places.entry(address).or_default().push(place);
    }
    let addresses = files::addresses(&group.variables);
    let mut next = before.variables.len();
    let mut ordered: Vec<(usize, ProjectVariable)> = Vec::with_capacity(group.variables.len());
    for (variable, address) in std::mem::take(&mut group.variables).into_iter().zip(addresses) {
        let place = places.get_mut(&address).and_then(Vec::pop).unwrap_or_else(|| {
            next += 1;
            next
        });
        ordered.push((place, variable));
    }
    ordered.sort_by_key(|(place, _)| *place);
    group.variables = ordered.into_iter().map(|(_, variable)| variable).collect();
}

/// The name of a file without folders and ending.
pub(super) fn stem(path: &str) -> Option<&str> {
    path.rsplit('/').next()?.strip_suffix(".json")
}
