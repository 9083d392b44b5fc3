//! The variables of a group in the order in which they are shown: each part follows what it is a part of.

use std::rc::Rc;

use cipdeck_shared::config::{MAX_DEPTH, Variable, VariableId, join_address};

use crate::store::Shelf;

/// One variable on its line.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Line {
    /// As it is stored.
    pub(super) variable: Variable,
    /// How many variables it is a part of.
    pub(super) depth: usize,
    /// With those of all its parents.
    pub(super) address: String,
    /// Others are parts of it.
    pub(super) has_parts: bool,
}

/// All lines.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Lines {
    by_id: Shelf<VariableId, Rc<Line>>,
    /// In their order.
    pub(super) ids: Rc<[VariableId]>,
}

impl Lines {
    /// Orders the variables of a group.
    pub(super) fn of(variables: &[Variable]) -> Self {
        let mut known = Shelf::default();
        for variable in variables {
            known.insert(variable.id, ());
        }
        let mut parts: Shelf<Option<VariableId>, Vec<&Variable>> = Shelf::default();
        for variable in variables {
            // A part whose parent is gone is shown like any other.
            let parent = variable.config.parent.filter(|id| known.get(id).is_some());
            parts.or_default(parent).push(variable);
        }
        let mut lines = Self::default();
        let mut ids = Vec::with_capacity(variables.len());
        lines.add(None, "", 0, &parts, &mut ids);
        lines.ids = ids.into();
        lines
    }

    fn add(
        &mut self,
        parent: Option<VariableId>,
        above: &str,
        depth: usize,
        parts: &Shelf<Option<VariableId>, Vec<&Variable>>,
        ids: &mut Vec<VariableId>,
    ) {
        let mut here = parts.get(&parent).cloned().unwrap_or_default();
        here.sort_by_key(|variable| (variable.config.order, variable.id));
        for variable in here {
            let address = join_address(above, &variable.config.address);
            let has_parts = depth < MAX_DEPTH && parts.get(&Some(variable.id)).is_some();
            let line = Line { variable: variable.clone(), depth, address: address.clone(), has_parts };
            self.by_id.insert(variable.id, Rc::new(line));
            ids.push(variable.id);
            if has_parts {
                self.add(Some(variable.id), &address, depth + 1, parts, ids);
            }
        }
    }

    /// One of them.
    pub(super) fn line(&self, id: VariableId) -> Option<&Rc<Line>> {
        self.by_id.get(&id)
    }

    /// All of them, in the order of their ids.
    pub(super) fn iter(&self) -> impl Iterator<Item = &Rc<Line>> {
        self.by_id.values()
    }
}

#[cfg(test)]
mod tests {
    use cipdeck_shared::config::{GroupId, VariableConfig};

    use super::*;

    fn variable(id: u32, parent: Option<u32>, address: &str, order: i64) -> Variable {
        let parent = parent.map(VariableId);
        let config = VariableConfig { parent, order, ..VariableConfig::new(address, address) };
        Variable { id: VariableId(id), revision: 1, group: GroupId(1), config }
    }

    #[test]
    fn parts_follow_what_they_are_parts_of() {
        let lines = Lines::of(&[
            variable(1, None, "last", 9),
            variable(2, Some(4), "speed", 0),
            variable(3, Some(5), "[3]", 0),
            variable(4, None, "motor", 0),
            variable(5, Some(4), "hist", -1),
        ]);
        let shown: Vec<_> = lines
            .ids
            .iter()
            .map(|id| lines.line(*id).unwrap())
            .map(|line| (line.address.as_str(), line.depth))
            .collect();
        assert_eq!(
            shown,
            [("motor", 0), ("motor.hist", 1), ("motor.hist[3]", 2), ("motor.speed", 1), ("last", 0)]
        );
    }

    #[test]
    fn a_part_of_nothing_is_shown_all_the_same() {
        let lines = Lines::of(&[variable(7, Some(99), "orphan", 0)]);
        assert_eq!(lines.ids.len(), 1);
        assert_eq!(Lines::of(&[]).ids.len(), 0);
    }
}
