//! May this be sent? One function, [`permit`], answers: when somebody gives a command, and again immediately before
//! each message is written. Everything is denied that nothing allows.

mod denials;
mod grants;
mod lists;
mod policy;
mod question;
mod rate;
mod read_only;
mod target_rule;
mod ticket;
mod window;

pub(crate) use self::grants::{Former, Gate, Grants};
pub(crate) use self::lists::Lists;
pub(crate) use self::policy::Policy;
pub(crate) use self::policy::{OpenError, record};
pub(crate) use self::question::{Denied, Order, Question, Sending};
pub(crate) use self::read_only::ReadOnly;
pub(crate) use self::target_rule::{RuleError, TargetRule};
pub(crate) use self::ticket::{Confirmed, GOOD_FOR, Offer};
pub(crate) use self::window::NotOpened;

use cipdeck_shared::api::{ActorKind, Role};

/// Decides whether a message may be written. Whoever acts was known when the command came; what they may do is asked
/// anew each time.
pub(crate) fn permit(policy: &Policy, question: &Question<'_>) -> Result<(), Denied> {
    let Question { sending, actor, .. } = question;
    let sending = sending.ok_or(Denied::NoPlan)?;
    let role = actor.role().ok_or(Denied::Gone)?;
    if actor.kind() == ActorKind::Token && !actor.is_present() {
        return Err(Denied::Gone);
    }
    if !role.may_send() {
        return Err(Denied::OnlyLooks);
    }
    policy.lists.allow(sending)?;
    if !actor.scope().is_empty() && sending.uncovered(&actor.scope().iter()).is_some() {
        return Err(Denied::OutOfScope);
    }
    if sending.access.may_write() {
        permit_write(policy, question, sending, role)?;
    }
    if question.shot.is_some() { policy.rate.take(&sending.target, question.now) } else { Ok(()) }
}

fn permit_write(
    policy: &Policy,
    question: &Question<'_>,
    sending: &Sending,
    role: Role,
) -> Result<(), Denied> {
    let Question { actor, now, .. } = *question;
    if policy.read_only.is_on() {
        return Err(Denied::ReadOnly);
    }
    if !role.may_write() || actor.kind() == ActorKind::Relay {
        return Err(Denied::NeverWrites(role));
    }
    if !actor.is_present() {
        return Err(Denied::Gone);
    }
    if role == Role::Operator {
        policy.lists.allow_write(sending)?;
    }
    let window = policy.window.open(now).ok_or(Denied::NoWindow)?;
    let confirmed = question.confirmed.ok_or(Denied::NotConfirmed)?;
    if confirmed.revision != question.revision {
        return Err(Denied::Changed { confirmed: confirmed.revision, current: question.revision });
    }
    if confirmed.window != window {
        return Err(Denied::OtherWindow);
    }
    match (question.shot, question.earlier) {
        (Some(shot), Some(earlier)) if shot != earlier && !question.repeats => return Err(Denied::Twice),
        // Also when it is sent again on another connection. What repeats was in time once.
        (_, earlier) if now >= confirmed.deadline && (earlier.is_none() || !question.repeats) => {
            return Err(Denied::Late);
        }
        _ => {}
    }
    policy.audit.is_writable().then_some(()).ok_or(Denied::NoAudit)
}

#[cfg(test)]
mod tests;
