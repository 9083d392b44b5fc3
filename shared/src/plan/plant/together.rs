//! The variables of a group, which may be parts of each other.

use alloc::collections::BTreeMap;
use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;

use super::finding::{PlantFinding, PlantRule};
use super::{VariablePlan, variable};
use crate::config::{MAX_DEPTH, NewVariable, Variable, VariableConfig, VariableId};
use crate::tag::{TagName, Types};

/// Variables that are added at once. Our own limit.
pub const MAX_ADDED: usize = 5_000;

/// Variables of a group. Our own limit.
pub const MAX_IN_GROUP: usize = 10_000;

/// A variable that may be stored.
#[derive(Clone, Debug, PartialEq)]
pub struct Accepted {
    /// What was entered, in its one spelling.
    pub config: VariableConfig,
    /// The parent's place in the same list, where the parent is new as well.
    pub parent: Option<usize>,
}

/// How each variable of a group is read. One whose parent is wrong is wrong itself.
pub fn variables(
    all: &[Variable],
    types: &Types,
) -> BTreeMap<VariableId, Result<VariablePlan, Vec<PlantFinding>>> {
    let by_id: BTreeMap<_, _> = all.iter().map(|variable| (variable.id, variable)).collect();
    let mut plans = BTreeMap::new();
    for variable in all {
        plan_with_parents(variable, &by_id, types, &mut plans, 0);
    }
    plans
}

type Plans = BTreeMap<VariableId, Result<VariablePlan, Vec<PlantFinding>>>;

fn plan_with_parents(
    one: &Variable,
    all: &BTreeMap<VariableId, &Variable>,
    types: &Types,
    plans: &mut Plans,
    depth: usize,
) {
    if plans.contains_key(&one.id) {
        return;
    }
    let parent = one.config.parent;
    let found = parent.and_then(|parent| all.get(&parent));
    let plan = match (parent, found) {
        (None, _) => variable(&one.config, None, types),
        (Some(_), None) => Err(at("parent", PlantRule::NoParent)),
        _ if depth >= MAX_DEPTH => Err(at("parent", PlantRule::ParentLoop)),
        (Some(parent), Some(above)) => {
            plan_with_parents(above, all, types, plans, depth + 1);
            match plans.get(&parent) {
                Some(Ok(above)) => variable(&one.config, Some(above), types),
                _ => Err(at("parent", PlantRule::NoParent)),
            }
        }
    };
    plans.insert(one.id, plan);
}

/// Whether a variable may be changed like this: `all` are those of its group as they are now.
pub fn changed(
    id: VariableId,
    config: &VariableConfig,
    all: &[Variable],
    types: &Types,
) -> Result<VariableConfig, Vec<PlantFinding>> {
    let config = tidy(config.clone());
    let mut after: Vec<Variable> = all.to_vec();
    for variable in after.iter_mut().filter(|variable| variable.id == id) {
        variable.config = config.clone();
    }
    let is_inside = |mut parent: Option<VariableId>| {
        for _ in 0..=MAX_DEPTH {
            let Some(above) = parent else { return false };
            if above == id {
                return true;
            }
            parent = after.iter().find(|variable| variable.id == above).and_then(|found| found.config.parent);
        }
        true
    };
    if is_inside(config.parent) {
        return Err(at("parent", PlantRule::ParentLoop));
    }
    match variables(&after, types).remove(&id) {
        Some(Err(findings)) => Err(findings),
        _ => Ok(config),
    }
}

/// Whether these may be added to what a group has. Findings say which: `place` makes `variables[3]` or `line 4` of the
/// number of the entry, counted from 0.
pub fn added(
    there: &[Variable],
    fresh: &[NewVariable],
    types: &Types,
    place: impl Fn(usize) -> String,
) -> Result<Vec<Accepted>, Vec<PlantFinding>> {
    if fresh.len() > MAX_ADDED {
        return Err(at("variables", PlantRule::TooMany { max: MAX_ADDED }));
    }
    if there.len() + fresh.len() > MAX_IN_GROUP {
        return Err(at("variables", PlantRule::TooMany { max: MAX_IN_GROUP }));
    }
    let mut findings = Vec::new();
    let existing = variables(there, types);
    let mut by_address: BTreeMap<String, Above> = BTreeMap::new();
    for (id, plan) in &existing {
        if let Ok(plan) = plan {
            by_address.entry(plan.name.to_string()).or_insert(Above::There(*id));
        }
    }
    let (mut accepted, mut plans) = (Vec::with_capacity(fresh.len()), Vec::with_capacity(fresh.len()));
    for (number, new) in fresh.iter().enumerate() {
        let config = tidy(new.config.clone());
        let above = match (&new.parent_address, config.parent) {
            (Some(address), _) if !address.trim().is_empty() => {
                by_address.get(&spelled(address)).copied().ok_or("parent_address").map(Some)
            }
            (_, Some(id)) if existing.contains_key(&id) => Ok(Some(Above::There(id))),
            (_, Some(_)) => Err("parent"),
            (_, None) => Ok(None),
        };
        let plan = match above {
            Err(field) => Err(at(field, PlantRule::NoParent)),
            Ok(None) => variable(&config, None, types),
            Ok(Some(above)) => {
                let parent = match above {
                    Above::There(id) => existing.get(&id).and_then(|plan| plan.as_ref().ok()),
                    Above::New(number) => plans.get(number).and_then(Option::as_ref),
                };
                match parent {
                    Some(parent) => variable(&config, Some(parent), types),
                    None => Err(at("parent", PlantRule::NoParent)),
                }
            }
        };
        let (mut config, mut parent) = (config, None);
        match above {
            Ok(Some(Above::There(id))) => config.parent = Some(id),
            Ok(Some(Above::New(number))) => (config.parent, parent) = (None, Some(number)),
            _ => {}
        }
        match plan {
            Ok(plan) => {
                by_address.entry(plan.name.to_string()).or_insert(Above::New(number));
                plans.push(Some(plan));
            }
            Err(found) => {
                plans.push(None);
                let place = place(number);
                findings.extend(found.into_iter().map(|finding| PlantFinding {
                    field: format!("{place}.{}", finding.field),
                    rule: finding.rule,
                }));
            }
        }
        accepted.push(Accepted { config, parent });
    }
    if findings.is_empty() { Ok(accepted) } else { Err(findings) }
}

/// A parent that a new variable names.
#[derive(Clone, Copy)]
enum Above {
    There(VariableId),
    New(usize),
}

/// An address in its one spelling.
fn spelled(address: &str) -> String {
    address.parse().map_or_else(|_| address.trim().into(), |name: TagName| name.to_string())
}

/// As it is stored.
fn tidy(mut config: VariableConfig) -> VariableConfig {
    for text in [&mut config.name, &mut config.address, &mut config.kind, &mut config.unit] {
        if text.trim().len() != text.len() {
            *text = text.trim().into();
        }
    }
    config
}

fn at(field: &str, rule: PlantRule) -> Vec<PlantFinding> {
    alloc::vec![PlantFinding { field: field.into(), rule }]
}
