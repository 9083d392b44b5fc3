//! The variables of a file → those that are stored.

use std::collections::BTreeMap;

use cipdeck_shared::config::project::{ProjectGroup, addresses, parents};
use cipdeck_shared::config::{GroupId, Variable, VariableConfig, VariableId, full_addresses};
use rusqlite::Connection;

use crate::store::{StoreError, StoredGroup, Table};

/// The variables of a group become those of its file.
pub(super) fn variables(
    connection: &Connection,
    id: GroupId,
    group: &ProjectGroup,
    found: Option<&StoredGroup>,
) -> Result<Counts, StoreError> {
    let there = found.map_or(&[][..], |found| found.variables.as_slice());
    let all: Vec<Variable> = there.iter().map(|(variable, _)| variable.clone()).collect();
    let mut by_address: BTreeMap<String, Vec<usize>> = BTreeMap::new();
    for (place, address) in full_addresses(&all).into_iter().enumerate().rev() {
        by_address.entry(address).or_default().push(place);
    }
    let addresses = addresses(&group.variables);
    let matches: Vec<_> =
        addresses.iter().map(|address| by_address.get_mut(address).and_then(Vec::pop)).collect();
    // What is wrong with them was told when the file was read; such a part stands alone then.
    let parents = parents(&group.variables).unwrap_or_else(|_| vec![None; group.variables.len()]);
    let mut ids: Vec<Option<VariableId>> = vec![None; group.variables.len()];
    let mut counts = Counts::default();
    for place in parents_first(&parents) {
        let Some(wanted) = group.variables.get(place) else { continue };
        let parent = parents.get(place).copied().flatten();
        let parent = parent.and_then(|parent| ids.get(parent).copied().flatten());
        let config = VariableConfig { parent, ..wanted.config.clone() };
        let found = matches.get(place).copied().flatten().and_then(|place| there.get(place));
        let variable = match found {
            None => {
                counts.created += 1;
                Table::Variable.insert(connection, Some(id.0), &config)?
            }
            Some((found, extra)) => {
                if found.config != config {
                    Table::Variable.update(connection, found.id.0, &config)?;
                }
                counts.changed += usize::from(found.config != config || *extra != wanted.extra);
                found.id.0
            }
        };
        if found.map_or(!wanted.extra.is_empty(), |(_, extra)| *extra != wanted.extra) {
            Table::Variable.set_extra(connection, variable, &wanted.extra)?;
        }
        if let Some(slot) = ids.get_mut(place) {
            *slot = Some(VariableId(variable));
        }
    }
    for (gone, _) in by_address.values().flatten().filter_map(|place| there.get(*place)) {
        counts.removed += 1;
        Table::Variable.delete(connection, gone.id.0)?;
    }
    Ok(counts)
}

/// The places of all, each after its parent, otherwise as they were.
fn parents_first(parents: &[Option<usize>]) -> Vec<usize> {
    let (mut order, mut is_in) = (Vec::with_capacity(parents.len()), vec![false; parents.len()]);
    for place in 0..parents.len() {
        let mut chain = Vec::new();
        let mut next = Some(place);
        while let Some(place) = next {
            match is_in.get_mut(place) {
                Some(is_in) if !*is_in => *is_in = true,
                _ => break,
            }
            chain.push(place);
            next = parents.get(place).copied().flatten();
        }
        order.extend(chain.into_iter().rev());
    }
    order
}

/// What has become of variables.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Counts {
    created: usize,
    changed: usize,
    removed: usize,
}

impl Counts {
    pub(super) const fn is_nothing(self) -> bool {
        self.created == 0 && self.changed == 0 && self.removed == 0
    }

    pub(super) fn words(self) -> Option<String> {
        let Self { created, changed, removed } = self;
        let words = || format!("variables: {created} created, {changed} changed, {removed} removed");
        (!self.is_nothing()).then(words)
    }
}
