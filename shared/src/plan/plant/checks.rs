//! The rules, member by member. Every rule adds its finding and goes on.

use alloc::collections::BTreeMap;
use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;

use super::VariablePlan;
use super::finding::{PlantFinding, PlantRule};
use crate::config::{VariableConfig, join_address};
use crate::tag::{NameError, Scale, Structure, TagName, Type, Types};

/// Named structures of a device. Our own limit.
const MAX_TYPES: usize = 500;

/// Members of a named structure, with those of the structures in it. Our own limit.
const MAX_MEMBERS: usize = 10_000;

/// Collects what is wrong.
#[derive(Default)]
pub(super) struct Checks {
    findings: Vec<PlantFinding>,
}

impl Checks {
    pub(super) fn add<T>(&mut self, field: &str, rule: PlantRule) -> Option<T> {
        self.findings.push(PlantFinding { field: field.into(), rule });
        None
    }

    pub(super) fn name(&mut self, field: &str, text: &str, max: usize) {
        if text.trim().is_empty() {
            self.add::<()>(field, PlantRule::Missing);
        }
        self.text(field, text, max);
    }

    pub(super) fn text(&mut self, field: &str, text: &str, max: usize) {
        if text.chars().count() > max {
            self.add::<()>(field, PlantRule::TextTooLong { max });
        }
    }

    pub(super) fn number<T: TryFrom<i64>>(
        &mut self,
        field: &str,
        value: i64,
        min: i64,
        max: i64,
    ) -> Option<T> {
        let number = T::try_from(value).ok().filter(|_| (min..=max).contains(&value));
        number.or_else(|| self.add(field, PlantRule::OutOfRange { value, min, max }))
    }

    pub(super) fn scale(&mut self, scale: Scale) -> bool {
        let is_good = scale.factor.is_finite() && scale.factor != 0.0 && scale.offset.is_finite();
        if !is_good {
            self.add::<()>("scale", PlantRule::Factor);
        }
        is_good
    }

    pub(super) fn address(&mut self, address: &str, parent: Option<&VariablePlan>) -> Option<TagName> {
        if address.trim().is_empty() {
            return self.add("address", PlantRule::Missing);
        }
        let name = match parent {
            Some(parent) => join_address(&parent.name.to_string(), address).parse(),
            None => address.parse(),
        };
        name.map_err(|error: NameError| self.add::<()>("address", PlantRule::Address(error.to_string()))).ok()
    }

    /// The type that was entered, or that the parent's has at this place.
    pub(super) fn kind(
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
    pub(super) fn types(&mut self, entered: &BTreeMap<String, String>) -> Types {
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

    pub(super) fn end<T>(self, plan: Option<T>) -> Result<T, Vec<PlantFinding>> {
        match plan {
            Some(plan) if self.findings.is_empty() => Ok(plan),
            _ => Err(self.findings),
        }
    }
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
