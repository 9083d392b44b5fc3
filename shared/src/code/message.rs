//! What a `MSG_CIPGENERIC` sends, for the dialects that write it. Nothing is written of a block with errors.

use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec;
use alloc::vec::Vec;

use crate::config::{
    BlockConfig, Channel, Endpoint, Extra, Host, MsgCipGeneric, Profile, Target, TargetPath,
};
use crate::plan::{MessagePlan, Severity};
use crate::table;

use super::Code;
use super::change::{Change, Grade, Why};
use super::header::harmless;

/// A block whose request is known.
pub(super) struct Message<'a> {
    pub(super) config: &'a MsgCipGeneric,
    pub(super) plan: MessagePlan,
    pub(super) path: TargetPath,
}

/// What a dialect tells of what not all of them do.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Tells {
    /// `CtrlCfg.TriggerType`
    pub(super) trigger: bool,
    /// `ResDataSize`
    pub(super) res_data_size: bool,
}

impl<'a> Message<'a> {
    /// The message of a block; otherwise the export of a block that cannot be sent.
    pub(super) fn of(block: &'a BlockConfig) -> Result<Self, Code> {
        let of = || {
            let config = block.as_msg()?;
            let plan = MessagePlan::parse(config).0?;
            let path = config.target_cfg.path.parse().ok()?;
            Some(Self { config, plan, path })
        };
        of().ok_or_else(|| not_sendable(block))
    }

    /// Up to three.
    pub(super) fn members(&self) -> &[i64] {
        let app = &self.config.app_cfg;
        let count = usize::try_from(app.member_cnt).unwrap_or(0);
        app.member_id.get(..count).unwrap_or_default()
    }

    /// The bytes that are sent after the path.
    pub(super) fn data(&self) -> &[u8] {
        self.plan.request().data()
    }

    /// Host and TCP port; `None`: the built-in simulated device.
    pub(super) const fn endpoint(&self) -> Option<&Endpoint> {
        match &self.path.target {
            Target::BuiltIn => None,
            Target::Network(endpoint) => Some(endpoint),
        }
    }

    /// `14 Get_Attribute_Single`
    pub(super) fn service_words(&self) -> String {
        let class = u16::try_from(self.config.app_cfg.class).unwrap_or(0);
        let service = self.plan.request().service();
        let known = table::service(class, service);
        format!("{} {}", service.0, known.map_or("", |entry| entry.name)).trim_end().to_string()
    }

    /// `1 Identity`
    pub(super) fn class_words(&self) -> String {
        let class = u16::try_from(self.config.app_cfg.class).unwrap_or(0);
        format!("{class} {}", table::class(class).map_or("", |entry| entry.name)).trim_end().to_string()
    }

    /// The request without member segments, for the dialects that have none.
    pub(super) fn bytes_without_members(&self) -> Vec<u8> {
        let mut config = self.config.clone();
        config.app_cfg.member_cnt = 0;
        MessagePlan::parse(&config).0.map_or_else(Vec::new, |plan| plan.bytes().to_vec())
    }

    /// What it is and what of it is sent: the comments at the head of a section of Structured Text.
    pub(super) fn about(&self, request: &[u8]) -> [String; 2] {
        let app = &self.config.app_cfg;
        let words = harmless(&format!(
            "{}: service {}, class {}, instance {}, attribute {}",
            self.config.name,
            self.service_words(),
            self.class_words(),
            app.instance,
            app.attribute,
        ));
        [format!("(* {words} *)"), format!("(* request {} *)", spaced(request))]
    }

    /// What a dialect does not tell, beside what only itself knows.
    pub(super) fn untold(&self, tells: Tells) -> Vec<Change> {
        let config = self.config;
        let mut changes = ours_alone(&Ours {
            channel: config.channel,
            resume: config.resume,
            profile: config.profile,
            keep_alive: config.keep_alive,
            req_layout: &config.req_layout,
            res_layout: &config.res_layout,
            extra: [
                ("", &config.extra),
                ("CtrlCfg.", &config.ctrl_cfg.extra),
                ("AppCfg.", &config.app_cfg.extra),
                ("TargetCfg.", &config.target_cfg.extra),
            ],
        });
        let mut lost = |is_told: bool, member: &str, from: String, why: Why| {
            if !is_told {
                changes.push(Change::new(&member, &from, &"", Grade::Lost, why));
            }
        };
        let (ctrl, target) = (&config.ctrl_cfg, &config.target_cfg);
        let once = tells.trigger || ctrl.trigger_type == 0;
        lost(once, "CtrlCfg.TriggerType", ctrl.trigger_type.to_string(), Why::ProgramDoes);
        lost(!ctrl.cancel, "CtrlCfg.Cancel", "TRUE".into(), Why::ProgramDoes);
        lost(ctrl.str_mode == 0, "CtrlCfg.StrMode", ctrl.str_mode.to_string(), Why::NoSuchMember);
        let full = tells.res_data_size || config.res_data_size == 490;
        lost(full, "ResDataSize", config.res_data_size.to_string(), Why::NoSuchMember);
        let mut unused = |is_used: bool, member: &str, from: String| {
            if !is_used {
                changes.push(Change::new(&member, &from, &"", Grade::Carried, Why::Unused));
            }
        };
        let sent = self.data().len();
        let all = crate::config::read_hex(&config.req_data).is_ok_and(|data| data.len() == sent);
        unused(all, "ReqData", format!("beyond its first {sent} bytes"));
        let connected = self.plan.connection().is_some();
        let timeout = target.conn_msg_timeout;
        unused(connected || timeout == 0, "TargetCfg.ConnMsgTimeout", timeout.to_string());
        unused(connected || !target.conn_close, "TargetCfg.ConnClose", "TRUE".into());
        changes
    }
}

/// What several dialects cannot say in the same way.
impl Message<'_> {
    /// The name as an identifier, if that is another one.
    pub(super) fn renamed(&self, name: &str) -> Option<Change> {
        let from = &self.config.name;
        (name != from).then(|| Change::new(&"name", from, &name, Grade::Carried, Why::NameCharacters))
    }

    /// Of a dialect that has no member segments.
    pub(super) fn without_members(&self) -> Option<Change> {
        let members = Some(self.members()).filter(|members| !members.is_empty())?;
        let from = format!("{members:?}");
        Some(Change::new(&"AppCfg.MemberId", &from, &"", Grade::Request, Why::NoMemberSegments))
    }

    /// Of a dialect that knows addresses in digits and port 44818: what of the path it cannot say. `to`: what it says
    /// instead; `whole`: whether that goes along the whole route.
    pub(super) fn path_changes(&self, to: &str, whole: bool) -> Vec<Change> {
        let endpoint = self.endpoint();
        let reasons = [
            (endpoint.is_none(), Grade::Carried, Why::NoBuiltIn),
            (endpoint.is_some_and(Endpoint::has_unusual_port), Grade::Request, Why::NoTcpPort),
            (endpoint.is_some_and(|it| matches!(it.host, Host::Name(_))), Grade::Request, Why::NoHostName),
            (!whole, Grade::Request, Why::NoRoute),
        ];
        let path = &self.config.target_cfg.path;
        // The same text again says nothing of where it goes.
        let to = if to == path { "" } else { to };
        let changes = reasons.into_iter().filter(|(is_so, ..)| *is_so);
        changes.map(|(_, grade, why)| Change::new(&"TargetCfg.Path", path, &to, grade, why)).collect()
    }
}

/// The settings of cipdeck that no controller has.
pub(super) struct Ours<'a, const N: usize> {
    pub(super) channel: Channel,
    pub(super) resume: bool,
    pub(super) profile: Profile,
    pub(super) keep_alive: i64,
    pub(super) req_layout: &'a str,
    pub(super) res_layout: &'a str,
    /// Unknown members, and what their names begin with.
    pub(super) extra: [(&'a str, &'a Extra); N],
}

/// One loss for each of them that is set.
pub(super) fn ours_alone<const N: usize>(ours: &Ours<'_, N>) -> Vec<Change> {
    let mut changes = Vec::new();
    let mut lost = |is_set: bool, member: &str, from: &str, why: Why| {
        if is_set {
            changes.push(Change::new(&member, &from, &"", Grade::Lost, why));
        }
    };
    lost(ours.channel != Channel::default(), "Channel", &String::from(ours.channel), Why::OursAlone);
    lost(ours.resume, "Resume", "TRUE", Why::OursAlone);
    lost(ours.profile != Profile::Auto, "Profile", ours.profile.word(), Why::OursAlone);
    lost(ours.keep_alive != 0, "KeepAlive", &ours.keep_alive.to_string(), Why::OursAlone);
    lost(!ours.req_layout.is_empty(), "ReqLayout", ours.req_layout, Why::OursAlone);
    lost(!ours.res_layout.is_empty(), "ResLayout", ours.res_layout, Why::OursAlone);
    for (prefix, extra) in ours.extra {
        for (name, value) in extra {
            lost(true, &format!("{prefix}{name}"), &value.to_string(), Why::NoSuchMember);
        }
    }
    changes
}

/// What would be sent is not known, so nothing is written. The first error is told.
pub(super) fn not_sendable(block: &BlockConfig) -> Code {
    let findings = MessagePlan::of(block).1;
    let error = findings.iter().find(|finding| finding.severity == Severity::Error);
    let error = error.map_or_else(String::new, |it| format!("{}: {}", it.field, it.rule));
    let change = Change::new(&"request", &error, &"", Grade::Request, Why::NotSendable);
    Code { text: String::new(), changes: vec![change] }
}

/// `0E 03 20`
pub(super) fn spaced(bytes: &[u8]) -> String {
    let words: Vec<String> = bytes.iter().map(|byte| format!("{byte:02X}")).collect();
    words.join(" ")
}
