//! What is sent for what a person has typed.

use cipdeck_shared::config::Variable;
use cipdeck_shared::engine::poll::{Quality, Reading};
use cipdeck_shared::plan::plant::VariablePlan;
use cipdeck_shared::tag::{Elementary, Type, Value};
use cipdeck_shared::wire::MessageRouterRequest;

use super::reason;
use crate::desk::{self, Desk};

/// A message, and the new value with its type.
pub(super) type Message = (MessageRouterRequest, (Type, Value));

/// Everything that has the variable's name.
pub(super) fn whole(desk: &Desk, plan: &VariablePlan, old: &Reading, text: &str) -> Result<Message, String> {
    let kind = old.kind.as_ref().or(plan.kind.as_ref()).ok_or_else(|| match old.quality {
        Quality::Good => "nobody knows its type: enter it where the variable is configured".to_owned(),
        _ => reason(old),
    })?;
    let value = plan.view.parse(kind, text).map_err(|error| error.to_string())?;
    let message = desk::whole(desk.dialect(), &plan.name, kind, None, &value)?;
    Ok((message, (kind.clone(), value)))
}

/// A bit of a whole number.
pub(super) fn one_bit(
    desk: &Desk,
    plan: &VariablePlan,
    number: &Reading,
    bit: u8,
    text: &str,
) -> Result<Message, String> {
    let kind = Type::Elementary(Elementary::Bool);
    let value = plan.view.parse(&kind, text).map_err(|error| error.to_string())?;
    let number = number.kind.as_ref().ok_or_else(|| reason(number))?;
    let on = value == Value::Bool(true);
    Ok((desk::one_bit(desk.dialect(), &plan.name, number, bit, on)?, (kind, value)))
}

/// A number that the configuration allows; of a list each.
pub(super) fn within_limits(variable: &Variable, plan: &VariablePlan, value: &Value) -> Result<(), String> {
    let (min, max) = (variable.config.min, variable.config.max);
    if min.is_none() && max.is_none() {
        return Ok(());
    }
    match value {
        Value::List(values) => values.iter().try_for_each(|value| within_limits(variable, plan, value)),
        // What is no number is neither over nor under one.
        Value::Text(_) | Value::Bool(_) | Value::Members(_) | Value::Raw(_) => Ok(()),
        value => match (plan.view.number(value), min, max) {
            (None, ..) => Err("the variable has limits, and this is no number".to_owned()),
            (Some(number), Some(min), _) if number < min => {
                Err(format!("{number} is under the smallest that is allowed, {min}"))
            }
            (Some(number), _, Some(max)) if number > max => {
                Err(format!("{number} is over the biggest that is allowed, {max}"))
            }
            _ => Ok(()),
        },
    }
}
