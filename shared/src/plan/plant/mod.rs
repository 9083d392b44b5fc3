//! Devices, groups and variables: what people have entered → what can be polled, or all findings.

mod csv;
mod finding;

use alloc::collections::BTreeMap;
use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;

use crate::config::{
    Connecting, DeviceConfig, GroupConfig, MAX_DEPTH, NewVariable, Profile, TargetPath, Variable,
    VariableConfig, VariableId, join_address,
};
use crate::tag::{Scale, Structure, TagName, Type, Types, View};

pub use self::csv::{COLUMNS, read_csv, write_csv};
pub use self::finding::{PlantFinding, PlantRule};

/// Characters of a name of a device, a group or a site. Our own limit.
const MAX_NAME: usize = 64;

/// Characters of a variable's name. Our own limit.
const MAX_VARIABLE_NAME: usize = 128;

/// Characters of a unit. Our own limit.
const MAX_UNIT: usize = 16;

/// Named structures of a device. Our own limit.
const MAX_TYPES: usize = 500;

/// Members of a named structure, with those of the structures in it. Our own limit.
const MAX_MEMBERS: usize = 10_000;

/// Words of one variable. Our own limit.
const MAX_CHOICES: usize = 256;

/// Variables that are added at once. Our own limit.
pub const MAX_ADDED: usize = 5_000;

/// Variables of a group. Our own limit.
pub const MAX_IN_GROUP: usize = 10_000;

/// A device that can be asked.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DevicePlan {
    /// Where it is.
    pub path: TargetPath,
    /// What kind of device it is said to be.
    pub profile: Profile,
    /// How its messages go.
    pub connecting: Connecting,
    /// ms from a request to its reply.
    pub timeout_ms: u32,
    /// Requests a second.
    pub max_requests_per_s: u32,
    /// Named structures.
    pub types: Types,
}

/// A variable that can be read.
#[derive(Clone, Debug)]
pub struct VariablePlan {
    /// Its whole name.
    pub name: TagName,
    /// Its type, if it was entered or follows from its parent's.
    pub kind: Option<Type>,
    /// How a person sees it.
    pub view: View,
    /// The unit of what a person sees.
    pub unit: String,
}

/// A variable that may be stored.
#[derive(Clone, Debug, PartialEq)]
pub struct Accepted {
    /// What was entered, in its one spelling.
    pub config: VariableConfig,
    /// The parent's place in the same list, where the parent is new as well.
    pub parent: Option<usize>,
}

/// Everything that is wrong with a device, or what can be asked.
pub fn device(config: &DeviceConfig) -> Result<DevicePlan, Vec<PlantFinding>> {
    let mut checks = Checks::default();
    checks.name("name", &config.name, MAX_NAME);
    checks.text("site", &config.site, MAX_NAME);
    let path: Option<TargetPath> = match config.path.parse() {
        Ok(path) => Some(path),
        Err(error) => checks.add("path", PlantRule::Path(error)),
    };
    let timeout_ms = checks.number("timeout_ms", config.timeout_ms, 250, 10_000);
    let max_requests_per_s = checks.number("max_requests_per_s", config.max_requests_per_s, 1, 1_000);
    let types = checks.types(&config.types);
    let plan = || {
        let (profile, connecting) = (config.profile, config.connection);
        let (timeout_ms, max_requests_per_s) = (timeout_ms?, max_requests_per_s?);
        Some(DevicePlan { path: path?, profile, connecting, timeout_ms, max_requests_per_s, types })
    };
    let plan = plan();
    checks.end(plan)
}

/// Everything that is wrong with a group, or its period in ms.
pub fn group(config: &GroupConfig) -> Result<u32, Vec<PlantFinding>> {
    let mut checks = Checks::default();
    checks.name("name", &config.name, MAX_NAME);
    let period = checks.number("period_ms", config.period_ms, 10, 3_600_000);
    checks.end(period)
}

/// Everything that is wrong with a variable, or how it is read. `parent` is what it is a part of.
pub fn variable(
    config: &VariableConfig,
    parent: Option<&VariablePlan>,
    types: &Types,
) -> Result<VariablePlan, Vec<PlantFinding>> {
    let mut checks = Checks::default();
    checks.name("name", &config.name, MAX_VARIABLE_NAME);
    checks.text("unit", &config.unit, MAX_UNIT);
    let digits = config.digits.map(|digits| checks.number("digits", digits, 0, 9));
    let scale = config.scale.filter(|scale| checks.scale(*scale));
    let limits = (config.min, config.max);
    if matches!(limits, (Some(min), Some(max)) if min > max) {
        checks.add::<()>("min", PlantRule::MinOverMax);
    }
    if config.choices.len() > MAX_CHOICES {
        checks.add::<()>("choices", PlantRule::TooMany { max: MAX_CHOICES });
    }
    for choice in &config.choices {
        checks.name("choices", &choice.text, MAX_NAME);
    }
    let name = checks.address(&config.address, parent);
    let kind = checks.kind(config, name.as_ref(), parent, types);
    let view = View {
        display: config.display,
        scale,
        digits: digits.flatten(),
        choices: config.choices.iter().map(|choice| (choice.value, choice.text.clone())).collect(),
    };
    let unit = config.unit.trim().into();
    let plan = name.map(|name| VariablePlan { name, kind, view, unit });
    checks.end(plan)
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

/// Whether a type has at most so many members in all. Takes no longer than that.
fn is_small(kind: &Type, left: &mut usize) -> bool {
    let Some(less) = left.checked_sub(1) else { return false };
    *left = less;
    match kind {
        Type::Elementary(_) | Type::String(_) => true,
        Type::Array(element, _) => is_small(element, left),
        Type::Structure(structure) => {
            let Structure { members, .. } = &**structure;
            members.iter().all(|member| is_small(&member.kind, left))
        }
    }
}

fn at(field: &str, rule: PlantRule) -> Vec<PlantFinding> {
    alloc::vec![PlantFinding { field: field.into(), rule }]
}

/// Collects what is wrong.
#[derive(Default)]
struct Checks {
    findings: Vec<PlantFinding>,
}

impl Checks {
    fn add<T>(&mut self, field: &str, rule: PlantRule) -> Option<T> {
        self.findings.push(PlantFinding { field: field.into(), rule });
        None
    }

    fn name(&mut self, field: &str, text: &str, max: usize) {
        if text.trim().is_empty() {
            self.add::<()>(field, PlantRule::Missing);
        }
        self.text(field, text, max);
    }

    fn text(&mut self, field: &str, text: &str, max: usize) {
        if text.chars().count() > max {
            self.add::<()>(field, PlantRule::TextTooLong { max });
        }
    }

    fn number<T: TryFrom<i64>>(&mut self, field: &str, value: i64, min: i64, max: i64) -> Option<T> {
        let number = T::try_from(value).ok().filter(|_| (min..=max).contains(&value));
        number.or_else(|| self.add(field, PlantRule::OutOfRange { value, min, max }))
    }

    fn scale(&mut self, scale: Scale) -> bool {
        let is_good = scale.factor.is_finite() && scale.factor != 0.0 && scale.offset.is_finite();
        if !is_good {
            self.add::<()>("scale", PlantRule::Factor);
        }
        is_good
    }

    fn address(&mut self, address: &str, parent: Option<&VariablePlan>) -> Option<TagName> {
        if address.trim().is_empty() {
            return self.add("address", PlantRule::Missing);
        }
        let name = match parent {
            Some(parent) => join_address(&parent.name.to_string(), address).parse(),
            None => address.parse(),
        };
        name.map_err(|error: crate::tag::NameError| {
            self.add::<()>("address", PlantRule::Address(error.to_string()))
        })
        .ok()
    }

    /// The type that was entered, or that the parent's has at this place.
    fn kind(
        &mut self,
        config: &VariableConfig,
        name: Option<&TagName>,
        parent: Option<&VariablePlan>,
        types: &Types,
    ) -> Option<Type> {
        let inherited = parent.and_then(|parent| Some((parent.kind.as_ref()?, name?.within(&parent.name)?)));
        let inherited = match inherited.map(|(kind, steps)| kind.step(steps)) {
            Some(None) => return self.add("address", PlantRule::NotInParent),
            found => found.flatten().cloned(),
        };
        if config.kind.trim().is_empty() {
            return inherited;
        }
        match types.read(&config.kind) {
            Ok(kind) => Some(kind),
            Err(error) => self.add("type", PlantRule::Type(error.to_string())),
        }
    }

    /// Structures may be made of each other, in any order.
    fn types(&mut self, entered: &BTreeMap<String, String>) -> Types {
        let mut types = Types::default();
        if entered.len() > MAX_TYPES {
            self.add::<()>("types", PlantRule::TooMany { max: MAX_TYPES });
            return types;
        }
        let mut open: Vec<_> = entered.iter().collect();
        loop {
            let mut failed = Vec::new();
            let before = open.len();
            for (name, text) in open {
                if let Err(error) = types.add(name, text) {
                    failed.push((name, text, error));
                    continue;
                }
                // Structures of structures double with every line.
                if types.get(name).is_some_and(|kind| !is_small(kind, &mut MAX_MEMBERS.clone())) {
                    self.add::<()>(&format!("types.{name}"), PlantRule::TooMany { max: MAX_MEMBERS });
                    return Types::default();
                }
            }
            if failed.is_empty() {
                return types;
            }
            if failed.len() == before {
                for (name, _, error) in failed {
                    self.add::<()>(&format!("types.{name}"), PlantRule::Type(error.to_string()));
                }
                return types;
            }
            open = failed.into_iter().map(|(name, text, _)| (name, text)).collect();
        }
    }

    fn end<T>(self, plan: Option<T>) -> Result<T, Vec<PlantFinding>> {
        match plan {
            Some(plan) if self.findings.is_empty() => Ok(plan),
            _ => Err(self.findings),
        }
    }
}

#[cfg(test)]
mod tests;
