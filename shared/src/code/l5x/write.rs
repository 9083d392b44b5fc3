//! A block as a partial export of Studio 5000: a routine to be imported into a program.

use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;
use core::fmt::Write;

use super::super::Code;
use super::super::change::{Change, Grade, Why, is_held};
use super::super::message::{Message, Tells};
use super::super::name::identifier;
use super::path::connection_path;
use super::xml::cdata;
use super::{MAX_TARGET_OBJECT, tag};
use crate::config::BlockConfig;

const TELLS: Tells = Tells { trigger: true, res_data_size: true };

/// A block as an L5X document.
pub(in super::super) fn export(block: &BlockConfig, before: &[Change]) -> Code {
    let message = match Message::of(block) {
        Ok(message) => message,
        Err(code) => return code,
    };
    let changes = changes(&message);
    let text = Document { message: &message, name: identifier(&message.config.name) };
    // A request that is not the block's must not run before somebody has looked at it.
    let held = is_held(before, &changes);
    Code { text: text.write(held), changes }
}

fn changes(message: &Message<'_>) -> Vec<Change> {
    let app = &message.config.app_cfg;
    let mut changes = message.untold(TELLS);
    changes.extend(message.renamed(&identifier(&message.config.name)));
    changes.extend(message.without_members());
    if app.instance > MAX_TARGET_OBJECT {
        let why = Why::NumberLimit(MAX_TARGET_OBJECT);
        changes.push(Change::new(&"AppCfg.Instance", &app.instance, &"", Grade::Request, why));
    }
    if let Some(endpoint) = message.endpoint().filter(|endpoint| endpoint.has_unusual_port()) {
        let to = connection_path(message);
        changes.push(Change::new(&"TargetCfg.Path", &endpoint, &to, Grade::Request, Why::NoTcpPort));
    }
    changes
}

struct Document<'a> {
    message: &'a Message<'a>,
    name: String,
}

impl Document<'_> {
    fn write(&self, held: bool) -> String {
        let name = &self.name;
        format!(
            r#"<?xml version="1.0" encoding="UTF-8" standalone="yes"?>
<!-- Studio 5000: right-click a program, Add, Import Routine...; then call it: JSR({name}). TRUE on {name}_Start sends. -->
{hint}<RSLogix5000Content SchemaRevision="1.0" SoftwareRevision="20.01" TargetName="{name}" TargetType="Routine" TargetSubType="RLL" ContainsContext="true" ExportOptions="References NoRawData L5KData DecoratedData Context Dependencies ForceProtectedEncoding AllProjDocTrans">
<Controller Use="Context" Name="cipdeck">
<Tags Use="Context">
{tags}</Tags>
<Programs Use="Context">
<Program Use="Context" Name="MainProgram">
<Routines Use="Context">
<Routine Use="Target" Name="{name}" Type="RLL">
<RLLContent>
{rungs}</RLLContent>
</Routine>
</Routines>
</Program>
</Programs>
</Controller>
</RSLogix5000Content>
"#,
            hint = self.chassis_hint(),
            tags = self.tags(),
            rungs = self.rungs(held),
        )
    }

    /// What a ControlLogix needs besides.
    fn chassis_hint(&self) -> &'static str {
        if self.message.endpoint().is_none() {
            return "<!-- THIS is the controller itself. -->\n";
        }
        "<!-- The path begins at port 2, the Ethernet port of a CompactLogix. A ControlLogix has an Ethernet module in \
         its chassis: write its name, or 1 and its slot, in front, as in: LocalENB, 2, 192.168.1.100 -->\n"
    }

    fn tags(&self) -> String {
        let (message, name) = (self.message, &self.name);
        let mut tags = tag::message(message, name);
        if !message.data().is_empty() {
            tags.push_str(&tag::bytes(&format!("{name}_Req"), message.data()));
        }
        let size = usize::try_from(message.config.res_data_size).unwrap_or(0);
        tags.push_str(&tag::bytes(&format!("{name}_Res"), &alloc::vec![0; size]));
        tags.push_str(&tag::flag(&format!("{name}_Start")));
        if let Some(period) = self.period() {
            tags.push_str(&tag::timer(&format!("{name}_Timer"), period));
        }
        tags
    }

    /// ms, of a block that triggers by itself, other than as fast as possible.
    fn period(&self) -> Option<i64> {
        Some(self.message.config.ctrl_cfg.trigger_type).filter(|period| *period > 1)
    }

    fn rungs(&self, held: bool) -> String {
        let name = &self.name;
        let start = match self.message.config.ctrl_cfg.trigger_type {
            0 => format!("XIC({name}_Start)"),
            1 => format!("XIC({name}_Start)XIO({name}.EN)"),
            _ => format!("XIC({name}_Timer.DN)"),
        };
        let never = if held { "AFI()" } else { "" };
        let send = format!("{never}{start}{}MSG({name});", self.timeouts());
        let mut rungs = Vec::new();
        if let Some(period) = self.period() {
            let every = format!("Every {period} ms (16#{period:x}) while {name}_Start is TRUE.");
            rungs.push((every, format!("XIC({name}_Start)XIO({name}_Timer.DN)TON({name}_Timer,?,?);")));
        }
        let held = if held { " AFI keeps the rung from running: see what is NOT CARRIED." } else { "" };
        let words = format!("{}: {}.{held}", self.message.config.name, self.timeout_words());
        rungs.push((words, send));
        let mut text = String::new();
        for (number, (comment, rung)) in rungs.into_iter().enumerate() {
            // Writing to a String cannot fail.
            let _ = writeln!(
                text,
                "<Rung Number=\"{number}\" Type=\"N\">\n<Comment>\n{}\n</Comment>\n<Text>\n{}\n</Text>\n</Rung>",
                cdata(&comment),
                cdata(&rung)
            );
        }
        text
    }

    /// µs; the connection's is four times its rate.
    fn timeouts(&self) -> String {
        let name = &self.name;
        let ucmm = u64::from(self.message.plan.ucmm_timeout_ms()) * 1_000;
        let mut moves = format!("MOV({ucmm},{name}.UnconnectedTimeout)");
        if let Some(ms) = self.connected_ms() {
            let rate = u64::from(ms) * 1_000 / 4;
            let _ = write!(moves, "MOV({rate},{name}.ConnectionRate)MOV(0,{name}.TimeoutMultiplier)");
        }
        moves
    }

    fn timeout_words(&self) -> String {
        let ucmm = self.message.plan.ucmm_timeout_ms();
        let connected = self.connected_ms().map(|ms| format!(", {ms} ms (16#{ms:x}) over the connection"));
        format!("timeout {ucmm} ms (16#{ucmm:x}){}", connected.unwrap_or_default())
    }

    fn connected_ms(&self) -> Option<u32> {
        self.message.plan.connection().map(|connection| connection.timeout_ms)
    }
}
