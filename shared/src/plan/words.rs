//! `SEND_REQ` and `DATA_EXCH`: words → a message.

use alloc::vec;
use alloc::vec::Vec;

use crate::config::SendReq;

use super::finding::{Field, Finding, Severity};
use super::{MessagePlan, Rule};

/// Runs every rule.
pub(super) fn parse(_config: &SendReq) -> (Option<MessagePlan>, Vec<Finding>) {
    (None, vec![Finding { field: Field::Kind, severity: Severity::Error, rule: Rule::UnknownKind }])
}

/// [`parse`], and what is to be said about the layouts.
pub(super) fn check(config: &SendReq) -> (Option<MessagePlan>, Vec<Finding>) {
    parse(config)
}
