//! A configuration → a message that can be sent, or all findings. The only place that turns text into requests.

mod checks;
mod effect;
mod finding;
pub mod limits;
pub mod plant;
mod reader;
mod routed;
mod rule;
mod tag_way;
pub mod words;

use alloc::sync::Arc;
use alloc::vec::Vec;

use crate::config::{BlockConfig, Channel, MsgCipGeneric, Profile, Target, TargetPath};
use crate::table::{self, Access};
use crate::wire::{Epath, LogicalKind, MessageRouterRequest, ServiceCode};

use self::checks::Checks;
pub use self::effect::{Effect, effects};
pub use self::finding::{Field, Finding, Severity};
pub use self::routed::Routed;
use self::routed::Routes;
pub use self::rule::{Rule, Said};
pub use self::tag_way::TagWay;
use self::words::WordsPlan;

/// A message that can be sent. Exists only for a configuration without errors.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MessagePlan {
    request: MessageRouterRequest,
    bytes: Arc<[u8]>,
    routes: Routes,
    target: Target,
    channel: Channel,
    profile: Profile,
    trigger: TriggerType,
    ucmm_timeout_ms: u32,
    connection: Option<ConnectionPlan>,
    keep_alive_ms: u32,
    res_data_size: u16,
    effects: Arc<[Effect]>,
    resume: bool,
    /// Of a SEND_REQ or DATA_EXCH.
    words: Option<Arc<WordsPlan>>,
}

/// A message over a class 3 connection.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ConnectionPlan {
    /// `ConnMsgTimeout` in ms, already in its range: from sending to the reply, and how long an idle connection stays.
    /// [`FOR_EVER`](limits::FOR_EVER) is no limit for the reply.
    pub timeout_ms: u32,
    /// `ConnClose`: the connection is closed when the message completes.
    pub close: bool,
}

/// CIPTARGETCFG, all in range.
struct TargetPlan {
    path: TargetPath,
    ucmm_timeout_ms: u32,
    connection: Option<ConnectionPlan>,
}

/// When a block whose IN is TRUE triggers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TriggerType {
    /// Once per rising edge of IN.
    Once,
    /// As fast as possible: the next millisecond after the end.
    Fast,
    /// Start to start, in ms: 2..=65535.
    Every(u16),
}

impl TriggerType {
    const fn of(period: u16) -> Self {
        match period {
            0 => Self::Once,
            1 => Self::Fast,
            period => Self::Every(period),
        }
    }
}

impl MessagePlan {
    /// The message of a block of any kind, or all findings.
    pub fn of(config: &BlockConfig) -> (Option<Self>, Vec<Finding>) {
        match config {
            BlockConfig::MsgCipGeneric(config) => Self::parse(config),
            BlockConfig::SendReq(config) => words::parse(config),
        }
    }

    /// [`Self::of`], and what is to be said about the layouts. They change nothing that is sent, and the workbench has
    /// no room for reading them: it leaves them to the relay.
    pub fn check(config: &BlockConfig) -> (Option<Self>, Vec<Finding>) {
        match config {
            BlockConfig::MsgCipGeneric(config) => Self::check_msg(config),
            BlockConfig::SendReq(config) => words::check(config),
        }
    }

    /// Runs every rule, so that a form shows all findings at once.
    pub fn parse(config: &MsgCipGeneric) -> (Option<Self>, Vec<Finding>) {
        let mut checks = Checks::default();
        checks.block(config);
        let trigger = checks.ctrl_cfg(&config.ctrl_cfg);
        let app = checks.app_cfg(&config.app_cfg);
        let target = checks.target_cfg(&config.target_cfg, config.profile);
        let keep_alive = checks.keep_alive(config.keep_alive);
        let data = checks.request_data(config);
        let res_data_size = checks.res_data_size(config);
        let alone = app.as_ref().map(|app| table::classify(app.service, app.class));
        let request = app.zip(data).and_then(|(app, data)| checks.request(app.service, app.path(), data));
        let effects: Option<Arc<[Effect]>> = request.as_ref().map(|request| effects(&request.bytes()).into());
        // While the data cannot be read, the service alone tells.
        checks.resume(config.resume, effects.as_deref().map(access_of).or(alone));
        let plan = || {
            let TargetPlan { path, ucmm_timeout_ms, connection } = target?;
            let request = request?;
            Some(Self {
                // A path of 80 characters and 490 bytes of data always fit.
                routes: Routes::new(&request, &path.route, ucmm_timeout_ms).ok()?,
                bytes: request.bytes().into(),
                request,
                target: path.target,
                channel: config.channel,
                profile: config.profile,
                trigger: trigger?,
                ucmm_timeout_ms,
                connection,
                keep_alive_ms: keep_alive?,
                res_data_size: res_data_size?,
                effects: effects?,
                resume: config.resume,
                words: None,
            })
        };
        let plan = plan();
        let findings = checks.findings;
        let plan = plan.filter(|_| findings.iter().all(|finding| finding.severity != Severity::Error));
        (plan, findings)
    }

    fn check_msg(config: &MsgCipGeneric) -> (Option<Self>, Vec<Finding>) {
        let (plan, mut findings) = Self::parse(config);
        let mut checks = Checks::default();
        checks.layouts(config);
        let readable = checks.findings.iter().all(|finding| finding.severity != Severity::Error);
        findings.append(&mut checks.findings);
        (plan.filter(|_| readable), findings)
    }

    /// Service, path and data.
    pub const fn request(&self) -> &MessageRouterRequest {
        &self.request
    }

    /// Message router bytes: what goes out over a connection, and what the target's object gets.
    pub fn bytes(&self) -> &Arc<[u8]> {
        &self.bytes
    }

    /// The bytes that go out unconnected, and along which route, for a kind of device: the request itself, or an
    /// Unconnected_Send around it if there is a route.
    pub fn routed(&self, profile: Profile) -> &Routed {
        self.routes.of(profile)
    }

    /// Whether the way depends on the kind of device.
    pub const fn ways_differ(&self) -> bool {
        self.routes.differ()
    }

    /// What the target is said to be.
    pub const fn profile(&self) -> Profile {
        self.profile
    }

    /// How it is sent over a class 3 connection; `None` for an unconnected message.
    pub const fn connection(&self) -> Option<ConnectionPlan> {
        self.connection
    }

    /// ms that its connection stays open without being used; 0 for an unconnected message.
    pub fn idle_ms(&self) -> u32 {
        let timeout_ms = self.connection.map_or(0, |connection| connection.timeout_ms);
        if self.words.is_some() && self.connection.is_some() {
            // Its own timeout has no limits, the target's patience has.
            return timeout_ms.clamp(limits::CONN_MSG_TIMEOUT.min, limits::CONN_MSG_TIMEOUT.max);
        }
        timeout_ms
    }

    /// ms between reads that keep an idle session alive; 0 = none.
    pub const fn keep_alive_ms(&self) -> u32 {
        self.keep_alive_ms
    }

    /// Where it goes.
    pub const fn target(&self) -> &Target {
        &self.target
    }

    /// Whose limits apply.
    pub const fn channel(&self) -> Channel {
        self.channel
    }

    /// When it triggers.
    pub const fn trigger(&self) -> TriggerType {
        self.trigger
    }

    /// ms, already in its range; [`FOR_EVER`](limits::FOR_EVER) is no limit.
    pub const fn ucmm_timeout_ms(&self) -> u32 {
        self.ucmm_timeout_ms
    }

    /// Bytes of data that the block holds of a reply with so many words of additional status: 1..=490; more for a
    /// message about tags.
    pub const fn res_data_size(&self, additional: u16) -> u16 {
        match self.words {
            // Received_Data holds the whole reply.
            Some(_) => self.res_data_size.saturating_sub(additional.saturating_mul(2)),
            None => self.res_data_size,
        }
    }

    /// What a SEND_REQ or DATA_EXCH is made of.
    pub const fn words(&self) -> Option<&Arc<WordsPlan>> {
        self.words.as_ref()
    }

    /// Whether it reads, writes, or nobody knows: the worst of [`MessagePlan::effects`].
    pub fn access(&self) -> Access {
        access_of(&self.effects)
    }

    /// The services that objects get, also those that are carried inside of the request. At least one.
    pub fn effects(&self) -> &[Effect] {
        &self.effects
    }

    /// Whether IN is restored after a start of the relay.
    pub const fn resume(&self) -> bool {
        self.resume
    }
}

fn access_of(effects: &[Effect]) -> Access {
    Access::of_all(effects.iter().map(|effect| effect.access))
}

/// The numbers of CIPAPPCFG, all in range.
struct App {
    service: ServiceCode,
    class: u16,
    instance: u32,
    attribute: u16,
    members: Vec<u16>,
}

impl App {
    /// Class, instance, attribute if not 0, then the member segments.
    fn path(&self) -> Epath {
        let mut path = Epath::object(self.class, self.instance);
        if self.attribute != 0 {
            path = path.then(LogicalKind::Attribute, self.attribute.into());
        }
        self.members.iter().fold(path, |path, member| path.then(LogicalKind::Member, (*member).into()))
    }
}

#[cfg(test)]
mod tests;
