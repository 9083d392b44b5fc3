//! `SEND_REQ` and `DATA_EXCH`: an address and a table of words → a message.
//!
//! The CIP request lies in the words as it goes out, low byte first: behind a message type (TSX ETC 100), behind a message
//! type and an IP address (TSX ETC 101), or alone (`DATA_EXCH`). What is sent is those bytes and never a path that is put
//! together anew: a device may care how wide its numbers are.
//!
//! Sources: Control Expert help D-NA-0014148, D-NA-0014195, D-SE-0006431, D-SE-0006433, D-SE-0006482, D-SE-0006557.

mod checks;
mod fields;
mod preset;
mod rule;
mod split;

use alloc::sync::Arc;
use alloc::vec::Vec;

use crate::config::{SendReq, SendReqForm};
use crate::table::{self, Access};
use crate::wire::{LogicalKind, MessageRouterRequest, ServiceCode};

pub use self::fields::{FieldsError, WordsFields, WordsObject, WordsPath};
pub use self::preset::Preset;
pub use self::rule::WordsRule;
pub use self::split::{Split, SplitError};
use super::checks::Checks;
use super::effect::effects;
use super::finding::{Finding, Severity};
use super::routed::Routes;
use super::{ConnectionPlan, Effect, MessagePlan};

/// What a SEND_REQ or DATA_EXCH is made of, all in range.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WordsPlan {
    /// How the words are laid out.
    pub form: SendReqForm,
    /// `Data_to_Send`, also those that stay behind.
    pub words: Vec<u16>,
    /// `Management_Param[3]`: bytes of them that are sent.
    pub length: u16,
    /// ms, a multiple of 100; `None` waits for ever.
    pub timeout_ms: Option<u32>,
    /// Over a class 3 connection.
    pub connected: bool,
    /// Words of `Received_Data`.
    pub received_words: u16,
}

/// Runs every rule that says something about what is sent.
pub(super) fn parse(config: &SendReq) -> (Option<MessagePlan>, Vec<Finding>) {
    let (plan, checks) = planned(config, Checks::default());
    (plan, checks.findings)
}

/// [`parse`], and what is to be said about the layouts.
pub(super) fn check(config: &SendReq) -> (Option<MessagePlan>, Vec<Finding>) {
    let mut checks = Checks::default();
    checks::layouts(&mut checks, config);
    let layouts = core::mem::take(&mut checks.findings);
    let readable = layouts.iter().all(|finding| finding.severity != Severity::Error);
    let (plan, mut findings) = parse(config);
    findings.extend(layouts);
    (plan.filter(|_| readable), findings)
}

fn planned(config: &SendReq, mut checks: Checks) -> (Option<MessagePlan>, Checks) {
    let form = config.form();
    checks::block(&mut checks, config);
    let trigger = checks::period(&mut checks, config.period);
    let address = checks::address(&mut checks, &config.address, form);
    let keep_alive = checks.keep_alive(config.keep_alive);
    let management = checks::management(&mut checks, config);
    let received = checks::received(&mut checks, config);
    let message = checks::message(&mut checks, config, management.as_ref().and_then(|words| words.length));
    let effects: Option<Arc<[Effect]>> = message.as_ref().map(|message| effects(&message.bytes).into());
    let access = effects.as_deref().map(|effects| Access::of_all(effects.iter().map(|effect| effect.access)));
    checks.resume(config.resume, access.or_else(|| service_alone(config)));
    let plan = || {
        let (message, management) = (message?, management?);
        let (target, connected) = message.way(address?)?;
        let timeout_ms =
            Some(management.timeout?).filter(|tenths| *tenths != 0).map(|tenths| u32::from(tenths) * 100);
        let request = MessageRouterRequest::decode(&message.bytes).ok()?;
        let (length, received_words) = (management.length?, received?);
        let words = WordsPlan { form, words: message.words, length, timeout_ms, connected, received_words };
        let ms = timeout_ms.unwrap_or(super::limits::FOR_EVER);
        Some(MessagePlan {
            routes: Routes::direct(message.bytes.clone()),
            bytes: message.bytes.into(),
            request,
            target,
            channel: config.channel,
            profile: config.profile,
            trigger: trigger?,
            ucmm_timeout_ms: ms,
            connection: connected.then_some(ConnectionPlan { timeout_ms: ms, close: false }),
            keep_alive_ms: keep_alive?,
            // The reply's data, behind service and status.
            res_data_size: 2 * received_words - 4,
            effects: effects?,
            resume: config.resume,
            words: Some(Arc::new(words)),
        })
    };
    let plan = plan();
    let sound = checks.findings.iter().all(|finding| finding.severity != Severity::Error);
    (plan.filter(|_| sound), checks)
}

/// While the request cannot be sent, its service and class alone tell whether it reads.
fn service_alone(config: &SendReq) -> Option<Access> {
    let words = crate::config::read_words(&config.data_to_send).ok()?;
    let fields = WordsFields::of_words(config.form(), &words).ok()?;
    let class = match &fields.path {
        WordsPath::Object(object) => u16::try_from(object.class).ok()?,
        WordsPath::Other(_) => return None,
    };
    Some(table::classify(ServiceCode(fields.service), class))
}

/// Numbers of a path in their order, for [`WordsObject`].
const OBJECT: [LogicalKind; 3] = [LogicalKind::Class, LogicalKind::Instance, LogicalKind::Attribute];

#[cfg(test)]
mod tests;
