//! A block as variables and statements.

use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;

use super::{SEGMENTS, route, width};
use crate::code::Code;
use crate::code::change::{Change, Grade, Why, is_held};
use crate::code::header::{HELD, harmless, line};
use crate::code::message::{Message, Tells};
use crate::code::name::identifier;
use crate::code::text::quoted;
use crate::config::BlockConfig;

/// ms.
const STEP: u32 = 100;

/// Bytes of a reply. W502 p. 765.
const MAX_REPLY: i64 = 492;

/// A block as Structured Text.
pub(in crate::code) fn export(block: &BlockConfig, before: &[Change]) -> Code {
    let message = match Message::of(block) {
        Ok(message) => message,
        Err(code) => return code,
    };
    let name = identifier(&message.config.name);
    let mut changes = message.untold(Tells { res_data_size: true, ..Tells::default() });
    let (route, whole) = route::write(&message.path);
    changes.extend(message.path_changes(&route, whole));
    changes.extend(message.renamed(&name));
    changes.extend(message.without_members());
    let mut out = String::new();
    let held = is_held(before, &changes);
    let section = Section { message: &message, name: &name, route: &route, held };
    section.about(&mut out);
    section.declarations(&mut out);
    section.path(&mut out);
    section.data(&mut out);
    match message.plan.connection() {
        None => {
            let timeout = steps(message.plan.ucmm_timeout_ms(), "TargetCfg.UcmmTimeout", &mut changes);
            section.unconnected(timeout, &mut out);
        }
        Some(connection) => {
            let ucmm = message.plan.ucmm_timeout_ms();
            if ucmm != connection.timeout_ms {
                let (member, why) = ("TargetCfg.UcmmTimeout", Why::OneTimeout);
                changes.push(Change::new(&member, &ucmm, &connection.timeout_ms, Grade::Adjusted, why));
            }
            let timeout = steps(connection.timeout_ms, "TargetCfg.ConnMsgTimeout", &mut changes);
            if !connection.close {
                let (member, why) = ("TargetCfg.ConnClose", Why::ConnectionStays);
                changes.push(Change::new(&member, &"FALSE", &"TRUE", Grade::Adjusted, why));
            }
            section.connected(timeout, &mut out);
        }
    }
    Code { text: out, changes }
}

/// Tenths of a second, rounded up.
fn steps(ms: u32, member: &str, changes: &mut Vec<Change>) -> u32 {
    let steps = ms.div_ceil(STEP);
    if steps * STEP != ms {
        let (from, to) = (format!("{ms} ms"), format!("{} ms", steps * STEP));
        changes.push(Change::new(&member, &from, &to, Grade::Adjusted, Why::TimeoutStep(STEP)));
    }
    steps
}

struct Section<'m> {
    message: &'m Message<'m>,
    name: &'m str,
    route: &'m str,
    /// It must not run as it is.
    held: bool,
}

impl Section<'_> {
    fn about(&self, out: &mut String) {
        for about in self.message.about(&self.message.bytes_without_members()) {
            line(out, &about);
        }
        line(
            out,
            "(* The variables are entered in the table of variables; the program begins after END_VAR. *)",
        );
    }

    fn declarations(&self, out: &mut String) {
        let name = self.name;
        let connected = self.message.plan.connection();
        let last = self.message.data().len().saturating_sub(1);
        let reply = self.message.config.res_data_size;
        let block = if connected.is_some() { "CIPSend" } else { "CIPUCMMSend" };
        line(out, "VAR");
        let mut declare = |ending: &str, kind: &str| line(out, &format!("    {name}{ending} : {kind};"));
        declare("", block);
        if connected.is_some() {
            for (ending, kind) in [
                ("_Open", "CIPOpen"),
                ("_Handle", "_sCIP_HANDLE"),
                ("_Close", "CIPClose"),
                ("_OpenError", "BOOL"),
                ("_OpenErrorID", "WORD"),
                ("_OpenErrorIDEx", "DWORD"),
            ] {
                declare(ending, kind);
            }
        }
        declare("_Start", "BOOL");
        declare("_Path", "_sREQUEST_PATH_EX");
        declare("_Req", &format!("ARRAY[0..{last}] OF BYTE"));
        declare("_Res", &format!("ARRAY[0..{}] OF BYTE", reply - 1));
        for (ending, kind) in [
            ("_Done", "BOOL"),
            ("_Error", "BOOL"),
            ("_ErrorID", "WORD"),
            ("_ErrorIDEx", "DWORD"),
            ("_RespSize", "UINT"),
        ] {
            declare(ending, kind);
        }
        line(out, "END_VAR");
        if reply > MAX_REPLY {
            line(out, &format!("(* A reply has at most {MAX_REPLY} bytes of data. *)"));
        }
        out.push('\n');
    }

    fn path(&self, out: &mut String) {
        let app = &self.message.config.app_cfg;
        let name = self.name;
        let has_attribute = app.attribute != 0;
        line(out, &format!("{name}_Path.isAttributeID := {};", if has_attribute { "TRUE" } else { "FALSE" }));
        for ((number, format), value) in SEGMENTS.iter().zip([app.class, app.instance, app.attribute]) {
            if *number == "AttributeID" && !has_attribute {
                continue;
            }
            let width = width(u32::try_from(value).unwrap_or(0));
            line(out, &format!("{name}_Path.{format} := _eCIP_LOGICAL_FORMAT#{width};"));
            line(out, &format!("{name}_Path.{number} := 16#{value:02X}; (* {value} *)"));
        }
        out.push('\n');
    }

    fn data(&self, out: &mut String) {
        for (at, byte) in self.message.data().iter().enumerate() {
            line(out, &format!("{}_Req[{at}] := BYTE#16#{byte:02X}; (* {byte} *)", self.name));
        }
    }

    /// The inputs that both ways have.
    fn service(&self) -> String {
        let (name, size) = (self.name, self.message.data().len());
        let service = self.message.config.app_cfg.service;
        format!(
            "    ServiceCode := BYTE#16#{service:02X}, (* {} *)\n    RqPath := {name}_Path,\n    ServiceDat := \
             {name}_Req[0],\n    Size := UINT#{size},\n    RespServiceDat := {name}_Res[0],\n    Done => \
             {name}_Done,\n    Error => {name}_Error,\n    ErrorID => {name}_ErrorID,\n    ErrorIDEx => \
             {name}_ErrorIDEx,\n    RespSize => {name}_RespSize);",
            harmless(&self.message.service_words())
        )
    }

    fn unconnected(&self, timeout: u32, out: &mut String) {
        let (name, route) = (self.name, quoted(self.route));
        let start = self.start(out);
        line(out, &format!("{name}(Execute := {start},\n    RoutePath := {route},"));
        line(out, &format!("    TimeOut := UINT#{timeout}, (* {} ms *)", timeout * STEP));
        line(out, &self.service());
    }

    /// What starts it.
    fn start(&self, out: &mut String) -> String {
        if self.held {
            line(out, HELD);
        }
        format!("{}{}_Start", if self.held { "FALSE AND " } else { "" }, self.name)
    }

    /// Opened, used and closed each time: a connection that stays would be opened anew at each start, until there are no
    /// more. The timeout is that of the connection: `CIPSend` has none of its own.
    fn connected(&self, timeout: u32, out: &mut String) {
        let (name, route) = (self.name, quoted(self.route));
        let start = self.start(out);
        line(out, &format!("{name}_Open(Execute := {start},\n    RoutePath := {route},"));
        line(out, &format!("    TimeOut := UINT#{timeout}, (* {} ms *)", timeout * STEP));
        line(
            out,
            &format!(
                "    Handle => {name}_Handle,\n    Error => {name}_OpenError,\n    ErrorID => {name}_OpenErrorID,\n    \
                 ErrorIDEx => {name}_OpenErrorIDEx);"
            ),
        );
        line(out, &format!("{name}(Execute := {name}_Open.Done,\n    Handle := {name}_Handle,"));
        line(out, &self.service());
        line(
            out,
            &format!("{name}_Close(Execute := {name}.Done OR {name}.Error,\n    Handle := {name}_Handle);"),
        );
    }
}
