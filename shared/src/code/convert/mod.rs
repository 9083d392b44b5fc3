//! A block of one kind as a block of another, with all that changed.
//!
//! What the message router of the device gets, and which device that is, is compared at the end, whatever the steps
//! before have told: a conversion that sends something else cannot stay silent.

mod between;
pub(super) mod to_msg;
mod to_words;

use alloc::string::{String, ToString};
use alloc::vec::Vec;

use super::change::{Change, Grade, Why};
use super::dialect::Kind;
use crate::config::{BlockConfig, write_hex};
use crate::plan::{MessagePlan, Severity};

/// A block of another kind.
#[derive(Clone, Debug, PartialEq)]
pub struct Converted {
    /// The block.
    pub config: BlockConfig,
    /// Everything that it does not say as the first one does.
    pub changes: Vec<Change>,
}

/// Makes a block of a kind out of one of any kind. A block with errors is converted as far as it can be read, and the
/// result says so.
pub fn convert(block: &BlockConfig, to: Kind) -> Converted {
    let mut changes = Vec::new();
    let config = match (block, to.form()) {
        _ if Kind::of(block) == to => block.clone(),
        (BlockConfig::MsgCipGeneric(msg), Some(form)) => to_words::convert(msg, form, &mut changes).into(),
        (BlockConfig::SendReq(words), None) => to_msg::convert(words, &mut changes).into(),
        (BlockConfig::SendReq(words), Some(form)) => between::convert(words, form, &mut changes).into(),
        (BlockConfig::MsgCipGeneric(_), None) => block.clone(),
    };
    compare(block, &config, &mut changes);
    Converted { config, changes }
}

/// Adds what has changed about the message itself, if nobody has told it yet.
fn compare(before: &BlockConfig, after: &BlockConfig, changes: &mut Vec<Change>) {
    if before == after {
        return;
    }
    let (before, after) = (Sent::of(before), Sent::of(after));
    let mut told = |member: &str, from: String, to: String, why: Why| {
        let is_told = changes.iter().any(|change| change.grade == Grade::Request && change.why == why);
        if from != to && !is_told {
            changes.push(Change::new(&member, &from, &to, Grade::Request, why));
        }
    };
    match (before, after) {
        (Ok(before), Ok(after)) => {
            told("request", before.request, after.request, Why::SegmentWidths);
            told("target", before.target, after.target, Why::OtherDevice);
        }
        (Ok(before), Err(error)) => told("request", before.request, error, Why::NotSendable),
        (Err(error), after) => {
            let after = after.map_or_else(|error| error, |after| after.request);
            if error != after {
                changes.push(Change::new(&"request", &error, &after, Grade::Request, Why::NotSendable));
            }
        }
    }
}

/// What a block sends, and where to.
struct Sent {
    request: String,
    target: String,
}

impl Sent {
    /// Or the first error that keeps it from sending anything.
    fn of(block: &BlockConfig) -> Result<Self, String> {
        let (plan, findings) = MessagePlan::of(block);
        let Some(plan) = plan else {
            let error = findings.iter().find(|finding| finding.severity == Severity::Error);
            return Err(error.map_or_else(String::new, |it| alloc::format!("{}: {}", it.field, it.rule)));
        };
        let route = plan.routed(plan.profile()).route().bytes();
        let route =
            if route.is_empty() { String::new() } else { alloc::format!(", route {}", write_hex(&route)) };
        Ok(Self { request: write_hex(plan.bytes()), target: plan.target().to_string() + &route })
    }
}

#[cfg(test)]
mod tests;
