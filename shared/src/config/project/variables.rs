//! The variables of a group name their parents by address: ids mean nothing outside of a relay.

use alloc::collections::{BTreeMap, BTreeSet};
use alloc::string::{String, ToString};
use alloc::vec::Vec;

use super::super::variable::{MAX_DEPTH, join_address};
use super::ProjectVariable;
use super::error::ProjectErrorKind;

/// The place of each variable's parent in the list; what is wrong, by the place of the variable.
pub fn parents(variables: &[ProjectVariable]) -> Result<Vec<Option<usize>>, Vec<(usize, ProjectErrorKind)>> {
    let mut wrong = Vec::new();
    let mut found: Vec<Option<usize>> = alloc::vec![None; variables.len()];
    let mut known: BTreeMap<String, usize> = BTreeMap::new();
    let named = |variable: &ProjectVariable| {
        variable
            .parent_address
            .as_deref()
            .map(str::trim)
            .filter(|address| !address.is_empty())
            .map(ToString::to_string)
    };
    let mut open: Vec<(usize, String)> = Vec::new();
    for (place, variable) in variables.iter().enumerate() {
        match named(variable) {
            None => {
                known.entry(variable.config.address.trim().into()).or_insert(place);
            }
            Some(address) => open.push((place, address)),
        }
    }
    // Parts of parts: each round finds those whose parents the round before has found.
    for _ in 0..MAX_DEPTH {
        let (ready, waiting): (Vec<_>, Vec<_>) =
            open.into_iter().partition(|(_, address)| known.contains_key(address));
        for (place, address) in &ready {
            if let (Some(slot), Some(parent)) = (found.get_mut(*place), known.get(address)) {
                *slot = Some(*parent);
            }
        }
        for (place, address) in ready {
            if let Some(variable) = variables.get(place) {
                known.entry(join_address(&address, &variable.config.address)).or_insert(place);
            }
        }
        open = waiting;
    }
    let all: BTreeSet<String> = addresses(variables).into_iter().collect();
    // Parts of what has no parent are not told of: they are right as soon as it is.
    let is_loop = open.iter().all(|(_, address)| all.contains(address));
    for (place, address) in open {
        if is_loop {
            wrong.push((place, ProjectErrorKind::ParentLoop));
        } else if !all.contains(&address) {
            wrong.push((place, ProjectErrorKind::NoParent(address)));
        }
    }
    if wrong.is_empty() { Ok(found) } else { Err(wrong) }
}

/// The full address of each variable.
pub fn addresses(variables: &[ProjectVariable]) -> Vec<String> {
    let full = |variable: &ProjectVariable| match &variable.parent_address {
        Some(parent) => join_address(parent, &variable.config.address),
        None => variable.config.address.trim().into(),
    };
    variables.iter().map(full).collect()
}
