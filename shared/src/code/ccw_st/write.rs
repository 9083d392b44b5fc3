//! A block as variables and statements.

use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;

use super::fields::{Fields, Way};
use crate::code::Code;
use crate::code::change::{Change, Grade, Why, is_held};
use crate::code::header::{HELD, harmless, line};
use crate::code::message::{Message, Tells};
use crate::code::name::identifier;
use crate::code::text::quoted;
use crate::config::{BlockConfig, CONTROLLER_HOPS};

const TELLS: Tells = Tells { trigger: true, res_data_size: true };

/// What the configuration structures tell, too.
const TOLD: [&str; 4] =
    ["CtrlCfg.Cancel", "CtrlCfg.StrMode", "TargetCfg.ConnMsgTimeout", "TargetCfg.ConnClose"];

/// A block as Structured Text.
pub(in crate::code) fn export(block: &BlockConfig, before: &[Change]) -> Code {
    let message = match Message::of(block) {
        Ok(message) => message,
        Err(code) => return code,
    };
    let name = identifier(&message.config.name);
    let request = Fields::of(&message.config.req_layout, Some(message.data()), &name);
    let reply = Fields::of(&message.config.res_layout, None, &name);
    let changes = changes(&message, &name, &request, &reply);
    let mut text = String::new();
    let held = is_held(before, &changes);
    let section = Section { message: &message, name: &name, request: &request, reply: &reply, held };
    section.write(&mut text);
    Code { text, changes }
}

fn changes(message: &Message<'_>, name: &str, request: &Fields, reply: &Fields) -> Vec<Change> {
    let mut changes = message.untold(TELLS);
    changes.retain(|change| !TOLD.contains(&change.member.as_str()));
    for change in &mut changes {
        let packed = match change.member.as_str() {
            "ReqLayout" => !request.is_empty(),
            "ResLayout" => !reply.is_empty(),
            _ => false,
        };
        if packed {
            (change.grade, change.why) = (Grade::Carried, Why::ProgramDoes);
        }
    }
    let whole = message.path.hops() <= CONTROLLER_HOPS;
    changes.extend(message.renamed(name));
    changes.extend(message.path_changes(&reached(message), whole));
    changes
}

/// The path as a controller goes it, whatever TCP port it has.
fn reached(message: &Message<'_>) -> String {
    let path = &message.config.target_cfg.path;
    message.endpoint().map_or_else(
        || path.clone(),
        |endpoint| path.replacen(&endpoint.to_string(), &endpoint.host.to_string(), 1),
    )
}

struct Section<'m> {
    message: &'m Message<'m>,
    name: &'m str,
    request: &'m Fields,
    reply: &'m Fields,
    /// It must not run as it is.
    held: bool,
}

impl Section<'_> {
    fn write(&self, out: &mut String) {
        self.about(out);
        self.declarations(out);
        self.settings(out);
        self.data(out);
        self.call(out);
        self.results(out);
    }

    fn about(&self, out: &mut String) {
        for about in self.message.about(self.message.plan.bytes()) {
            line(out, &about);
        }
        line(
            out,
            "(* The variables are entered in the table of local variables; the program begins after END_VAR. *)",
        );
    }

    fn declarations(&self, out: &mut String) {
        let name = self.name;
        // The manual asks for an array that is larger than ReqLength.
        let request = self.message.data().len() + 1;
        let reply = self.message.config.res_data_size;
        line(out, "VAR");
        for (variable, kind) in [
            (name.to_string(), "MSG_CIPGENERIC".to_string()),
            (format!("{name}_IN"), "BOOL".to_string()),
            (format!("{name}_Ctrl"), "CIPCONTROLCFG".to_string()),
            (format!("{name}_App"), "CIPAPPCFG".to_string()),
            (format!("{name}_Target"), "CIPTARGETCFG".to_string()),
            (format!("{name}_Req"), format!("ARRAY[1..{request}] OF USINT")),
            (format!("{name}_Res"), format!("ARRAY[1..{reply}] OF USINT")),
            (format!("{name}_Q"), "BOOL".to_string()),
            (format!("{name}_Status"), "CIPSTATUS".to_string()),
            (format!("{name}_ResLen"), "UINT".to_string()),
        ] {
            line(out, &format!("    {variable} : {kind};"));
        }
        self.request.declare(out);
        self.reply.declare(out);
        if self.request.copies() || self.reply.copies() {
            line(out, &format!("    {name}_Copy : COP;"));
        }
        line(out, "END_VAR");
        out.push('\n');
    }

    fn settings(&self, out: &mut String) {
        let config = self.message.config;
        let (ctrl, app, target) = (&config.ctrl_cfg, &config.app_cfg, &config.target_cfg);
        let mut set = |group: &str, member: &str, value: &str, about: &str| {
            let comment =
                if about.is_empty() { String::new() } else { format!(" (* {} *)", harmless(about)) };
            line(out, &format!("{}_{group}.{member} := {value};{comment}", self.name));
        };
        set("Ctrl", "Cancel", truth(ctrl.cancel), "");
        let period =
            if ctrl.trigger_type == 0 { "once per rising edge of IN" } else { "ms, while IN is TRUE" };
        set("Ctrl", "TriggerType", &ctrl.trigger_type.to_string(), period);
        set("Ctrl", "StrMode", &ctrl.str_mode.to_string(), "");
        let service = self.message.service_words();
        set("App", "Service", &app.service.to_string(), &format!("16#{:02X}, {service}", app.service));
        let class = self.message.class_words();
        set("App", "Class", &app.class.to_string(), &format!("16#{:02X}, {class}", app.class));
        set("App", "Instance", &app.instance.to_string(), &format!("16#{:02X}", app.instance));
        let none = if app.attribute == 0 { ", none" } else { "" };
        set("App", "Attribute", &app.attribute.to_string(), &format!("16#{:02X}{none}", app.attribute));
        set("App", "MemberCnt", &app.member_cnt.to_string(), "");
        for (at, member) in self.message.members().iter().enumerate() {
            set("App", &format!("MemberId[{at}]"), &member.to_string(), &format!("16#{member:02X}"));
        }
        set("Target", "Path", &quoted(&target.path), "");
        let mode = if target.cip_conn_mode == 0 { "unconnected" } else { "class 3 connection" };
        set("Target", "CipConnMode", &target.cip_conn_mode.to_string(), mode);
        let ucmm = if target.ucmm_timeout == 0 { "ms; 0 = 3000" } else { "ms" };
        set("Target", "UcmmTimeout", &target.ucmm_timeout.to_string(), ucmm);
        let connected = if target.conn_msg_timeout == 0 { "ms; 0 = 10000" } else { "ms" };
        set("Target", "ConnMsgTimeout", &target.conn_msg_timeout.to_string(), connected);
        set("Target", "ConnClose", truth(target.conn_close), "");
        out.push('\n');
    }

    /// Typed variables where the layout has them, bytes elsewhere. `COP` copies over bytes that are the same.
    fn data(&self, out: &mut String) {
        let data = self.message.data();
        if data.is_empty() {
            return;
        }
        let array = format!("{}_Req", self.name);
        for (at, byte) in data.iter().enumerate() {
            if self.request.way(at) != Some(Way::Arithmetic) {
                line(out, &format!("{array}[{}] := {byte}; (* 16#{byte:02X} *)", at + 1));
            }
        }
        self.request.pack(self.name, &array, out);
        out.push('\n');
    }

    fn call(&self, out: &mut String) {
        let name = self.name;
        let length = self.message.data().len();
        if self.held {
            line(out, HELD);
        }
        let start = format!("{}{name}_IN", if self.held { "FALSE AND " } else { "" });
        line(
            out,
            &format!(
                "{name}({start}, {name}_Ctrl, {name}_App, {name}_Target, {name}_Req, {length}, {name}_Res);"
            ),
        );
    }

    fn results(&self, out: &mut String) {
        let name = self.name;
        line(out, &format!("{name}_Q := {name}.Q;"));
        line(out, &format!("{name}_Status := {name}.Status;"));
        line(out, &format!("{name}_ResLen := {name}.ResLength;"));
        if !self.reply.is_empty() {
            line(out, &format!("IF {name}_Q THEN"));
            self.reply.unpack(name, &format!("{name}_Res"), out);
            line(out, "END_IF;");
        }
    }
}

fn truth(value: bool) -> &'static str {
    if value { "TRUE" } else { "FALSE" }
}
