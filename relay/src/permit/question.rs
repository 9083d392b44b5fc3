//! What is asked, and the ways to say no.

use std::sync::Arc;

use cipdeck_shared::api::Role;
use cipdeck_shared::config::Target;
use cipdeck_shared::plan::{Effect, MessagePlan, TriggerType};
use cipdeck_shared::table::Access;
use cipdeck_shared::wire::{Epath, Segment};
use tokio::time::Instant;

use super::TargetRule;
use super::ticket::Confirmed;
use crate::actor::Actor;

/// Somebody's command: it holds until the next command to the same block.
#[derive(Clone, Debug)]
pub(crate) struct Order {
    /// Who gives it.
    pub(crate) actor: Actor,
    /// The write that has been confirmed with it.
    pub(crate) confirmed: Option<Confirmed>,
}

impl Order {
    /// Without a confirmed write.
    pub(crate) const fn read(actor: Actor) -> Self {
        Self { actor, confirmed: None }
    }
}

/// What would be sent.
#[derive(Clone, Debug)]
pub(crate) struct Sending {
    /// The endpoint.
    pub(crate) target: Target,
    /// What lies behind it: the block's own route, and those on which requests inside of the request go on.
    pub(crate) routes: Vec<Epath>,
    /// The worst of all effects.
    pub(crate) access: Access,
    /// What each service in the request does.
    pub(crate) effects: Vec<Effect>,
    /// Message router bytes.
    pub(crate) request: Arc<[u8]>,
    /// Sent again and again while IN is TRUE.
    pub(crate) is_cyclic: bool,
}

impl From<&MessagePlan> for Sending {
    fn from(plan: &MessagePlan) -> Self {
        // Where it goes for the kind of device that the block names, which may leave out a hop: without this, naming a
        // kind would be a way to a device that only something behind it is allowed of. Otherwise as it was typed: what
        // is left out then is what the device itself says that it is.
        let own = plan.routed(plan.profile()).route();
        let mut routes = vec![own.clone()];
        for effect in plan.effects() {
            let route = own.clone().join(&effect.route);
            if !routes.contains(&route) {
                routes.push(route);
            }
        }
        Self {
            target: plan.target().clone(),
            routes,
            access: plan.access(),
            effects: plan.effects().to_vec(),
            request: Arc::clone(plan.bytes()),
            is_cyclic: plan.trigger() != TriggerType::Once,
        }
    }
}

impl Sending {
    /// The first route that no rule covers. The built-in device is no target.
    pub(super) fn uncovered<'a>(
        &self,
        rules: &(impl Iterator<Item = &'a TargetRule> + Clone),
    ) -> Option<&Epath> {
        let Target::Network(endpoint) = &self.target else { return None };
        self.routes.iter().find(|route| !rules.clone().any(|rule| rule.covers(endpoint, route)))
    }

    /// Whether a rule covers what one of the effects reaches.
    pub(super) fn is_covered(&self, effect: &Effect, rule: &TargetRule) -> bool {
        let (Target::Network(endpoint), Some(own)) = (&self.target, self.routes.first()) else { return true };
        rule.covers(endpoint, &own.clone().join(&effect.route))
    }

    /// `192.168.1.10:44818 via 1,0`, as the audit names it.
    pub(crate) fn path(&self) -> String {
        self.routes.first().map_or_else(|| self.target.to_string(), |route| place(&self.target, route))
    }
}

/// A target and what lies behind it.
pub(super) fn place(target: &Target, route: &Epath) -> String {
    if route.is_empty() {
        return target.to_string();
    }
    let hop = |segment: &Segment| match segment {
        Segment::Port(hop) => match (hop.slot(), hop.address()) {
            (Some(slot), _) => format!("{},{slot}", hop.port()),
            (None, Some(address)) => format!("{},{address}", hop.port()),
            (None, None) => format!("{},{:02x?}", hop.port(), hop.link()),
        },
        _ => "?".to_owned(),
    };
    let hops: Vec<_> = route.segments().iter().map(hop).collect();
    format!("{target} via {}", hops.join(","))
}

/// One question.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Question<'a> {
    /// What would be sent; `None` for a configuration with errors.
    pub(crate) sending: Option<&'a Sending>,
    /// Its revision.
    pub(crate) revision: u64,
    /// Who has given the command.
    pub(crate) actor: &'a Actor,
    /// The write that was confirmed with the command.
    pub(crate) confirmed: Option<&'a Confirmed>,
    /// Which message; `None` when the command itself is asked about.
    pub(crate) shot: Option<u64>,
    /// The last message that was permitted for this command.
    pub(crate) earlier: Option<u64>,
    /// The command is carried out again and again.
    pub(crate) repeats: bool,
    /// When.
    pub(crate) now: Instant,
}

/// Why something must not be sent, and what to do about it.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub(crate) enum Denied {
    /// It was deleted, or never there.
    #[error("the block does not exist in this revision")]
    Unknown,
    /// Its configuration has errors: there is nothing that could be sent.
    #[error("the configuration has errors")]
    NoPlan,
    /// The account or its session has ended.
    #[error("whoever gave the command is signed out or locked: sign in and give it again")]
    Gone,
    /// A viewer.
    #[error("a viewer looks and sends nothing: ask somebody who is an operator or an engineer")]
    OnlyLooks,
    /// Nothing on the list covers the target.
    #[error("{0} is not on the list of allowed targets: an administrator can add it")]
    Target(String),
    /// An address that must be named.
    #[error(
        "{0} is {1}, which no network on the list includes: an administrator has to allow exactly this address"
    )]
    Special(String, &'static str),
    /// A token's own limits.
    #[error("the token is limited to other targets")]
    OutOfScope,
    /// The switch.
    #[error("the relay is read-only: only local access turns that off (cipdeck read-only off)")]
    ReadOnly,
    /// The role, or a block that resumes.
    #[error("this may write, and the role {} never writes", .0.word())]
    NeverWrites(Role),
    /// An operator, and the list has no such write.
    #[error(
        "this may write ({0}), and it is not on the operators' list of writes: ask an engineer, or an administrator to add it"
    )]
    NotOnList(String),
    /// Nobody has opened one.
    #[error("this may write: open a write window first")]
    NoWindow,
    /// A write without a ticket.
    #[error(
        "this may write: ask blocks/{{id}}/write for a ticket, look at what it says, and give it with the command"
    )]
    NotConfirmed,
    /// The block has changed since.
    #[error(
        "revision {confirmed} was confirmed, but revision {current} would be sent: look at it and confirm again"
    )]
    Changed {
        /// What a person has seen.
        confirmed: u64,
        /// What would be sent.
        current: u64,
    },
    /// The window has been closed since.
    #[error("the write window in which this was confirmed has ended: confirm again")]
    OtherWindow,
    /// The ticket is not of this relay, this caller or this block.
    #[error(
        "the ticket is unknown, or somebody else's, or for another block: ask for one with blocks/{{id}}/write"
    )]
    NoTicket,
    /// It has been used.
    #[error("the ticket has been used: a command is carried out once; ask for another ticket")]
    Used,
    /// Too late.
    #[error("the time to carry this write out is over: nothing was sent; look again and confirm again")]
    Late,
    /// A second message for one confirmed write.
    #[error("this write was confirmed for one message, which has been sent")]
    Twice,
    /// Nothing may be written that is not written down.
    #[error("the audit cannot be written: writes stop until it can; reads go on")]
    NoAudit,
    /// The target's own limit.
    #[error(
        "{target} gets at most {limit} messages a second: use a longer period, or raise limits.messages_per_second"
    )]
    TooMany {
        /// Which.
        target: String,
        /// Messages per second.
        limit: u32,
    },
}

impl Denied {
    /// The word under which it is counted.
    pub(crate) const fn word(&self) -> &'static str {
        match self {
            Self::Unknown => "unknown_block",
            Self::NoPlan => "no_plan",
            Self::Gone => "signed_out",
            Self::OnlyLooks => "viewer",
            Self::Target(_) => "target",
            Self::Special(..) => "special_address",
            Self::OutOfScope => "scope",
            Self::ReadOnly => "read_only",
            Self::NeverWrites(_) => "role",
            Self::NotOnList(_) => "not_on_list",
            Self::NoWindow => "no_window",
            Self::NotConfirmed => "not_confirmed",
            Self::Changed { .. } => "changed",
            Self::OtherWindow => "other_window",
            Self::NoTicket => "no_ticket",
            Self::Used => "ticket_used",
            Self::Late => "late",
            Self::Twice => "twice",
            Self::NoAudit => "no_audit",
            Self::TooMany { .. } => "rate",
        }
    }
}
