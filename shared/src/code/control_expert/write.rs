//! A block as variables and a section.

use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;
use core::fmt::Write;

use super::super::Code;
use super::super::change::{Change, Grade, Why, is_held};
use super::super::dialect::Language;
use super::super::header::{HELD, harmless};
use super::super::message::{Ours, not_sendable, ours_alone};
use super::super::name::{MAX_NAME, identifier};
use super::words::{about, list};
use crate::config::{BlockConfig, Endpoint, Host, PlcAddress, SendReq, SendReqForm};
use crate::plan::MessagePlan;
use crate::plan::words::WordsPlan;

/// A block as a section of Control Expert.
pub(in super::super) fn export(block: &BlockConfig, language: Language, before: &[Change]) -> Code {
    let plan = MessagePlan::of(block).0;
    let parts = block.as_send_req().zip(plan).and_then(|(config, plan)| {
        let words = plan.words()?.as_ref().clone();
        Some((config, words, plan, config.address.parse::<PlcAddress>().ok()?))
    });
    let Some((config, words, plan, address)) = parts else { return not_sendable(block) };
    let mut changes = changes(config, &address, &plan);
    let mut name = identifier(&config.name);
    name.truncate(MAX_NAME);
    let name = name.trim_end_matches('_').to_string();
    if name != config.name {
        changes.push(Change::new(&"name", &config.name, &name, Grade::Carried, Why::NameCharacters));
    }
    let address = without_port(address);
    let held = is_held(before, &changes);
    let section = Section { config, words: &words, plan: &plan, address: &address, name: &name, held };
    let mut text = section.head();
    text.push_str(&match language {
        Language::St => section.st(),
        Language::Il => section.il(),
    });
    Code { text, changes }
}

fn changes(config: &SendReq, address: &PlcAddress, plan: &MessagePlan) -> Vec<Change> {
    let mut changes = ours_alone(&Ours {
        channel: config.channel,
        resume: config.resume,
        profile: config.profile,
        keep_alive: config.keep_alive,
        req_layout: &config.req_layout,
        res_layout: &config.res_layout,
        extra: [("", &config.extra)],
    });
    if config.period != 0 {
        changes.push(Change::new(&"Period", &config.period, &"", Grade::Lost, Why::ProgramDoes));
    }
    if let Some(endpoint) = address.endpoint().filter(|endpoint| endpoint.has_unusual_port()) {
        let to = &endpoint.host;
        changes.push(Change::new(&"Address", endpoint, to, Grade::Request, Why::NoTcpPort));
    }
    if *plan.target() == crate::config::Target::BuiltIn {
        changes.push(Change::new(&"Address", &"0.0.0.0", &"0.0.0.0", Grade::Request, Why::NoBuiltIn));
    }
    changes
}

/// Control Expert always uses 44818.
fn without_port(mut address: PlcAddress) -> PlcAddress {
    use crate::config::AddressDevice::{Braced, Dotted};
    if let Some(Dotted(endpoint) | Braced(endpoint, _)) = &mut address.device
        && let Host::Ip(ip) = endpoint.host
    {
        *endpoint = Endpoint::of_ip(ip);
    }
    address
}

/// One block as a section.
struct Section<'a> {
    config: &'a SendReq,
    words: &'a WordsPlan,
    plan: &'a MessagePlan,
    address: &'a PlcAddress,
    name: &'a str,
    /// It must not run as it is.
    held: bool,
}

impl Section<'_> {
    /// The variables, which the data editor keeps.
    fn head(&self) -> String {
        let Self { words, name, .. } = self;
        let (address, management) = (self.address_size() - 1, self.management());
        format!(
            "(* {}, {} *)\n\
             (* Variables for the data editor. The section begins below them; {name}_Mgmt[0].0 needs the project option that\n   \
             allows bits of integers. {name}_Start sends on its rising edge. *)\n\
             VAR\n\
             \x20   {name}_Adr : ARRAY [0..{address}] OF INT;\n\
             \x20   {name}_Send : ARRAY [0..{}] OF INT := [{}];\n\
             \x20   {name}_Mgmt : ARRAY [0..3] OF INT := [0, 0, {}, {}];\n\
             \x20   {name}_Recv : ARRAY [0..{}] OF INT;\n\
             \x20   {name}_Start, {name}_Last, {name}_Busy : BOOL;\n\
             \x20   {name}_Report, {name}_Cip : INT;\n\
             END_VAR\n\n",
            harmless(&self.config.name),
            words.form,
            words.words.len().saturating_sub(1),
            list(&words.words),
            management[0],
            management[1],
            words.received_words.saturating_sub(1),
        )
    }

    /// Words of an address: D-SA-0009555.
    const fn address_size(&self) -> usize {
        match self.words.form {
            SendReqForm::Etc100 | SendReqForm::Etc101 => 6,
            SendReqForm::DataExch => 8,
        }
    }

    /// Timeout and length. An INT is at most 32767 in decimal, and 65535 in hexadecimal.
    fn management(&self) -> [String; 2] {
        let timeout = self.words.timeout_ms.map_or(0, |ms| ms / 100);
        let marked = timeout > i16::MAX.cast_unsigned().into();
        let timeout = if marked { format!("16#{timeout:04X}") } else { timeout.to_string() };
        [timeout, self.words.length.to_string()]
    }

    fn management_words(&self) -> [String; 2] {
        let timeout = self.words.timeout_ms;
        let waits = timeout.map_or("waits FOR EVER".to_string(), |ms| format!("{ms} ms"));
        [
            format!("16#{:04X}: {waits}", timeout.map_or(0, |ms| ms / 100)),
            format!("16#{:04X} bytes", self.words.length),
        ]
    }

    /// The function and its constant argument.
    fn function(&self) -> (&'static str, String) {
        match self.words.form {
            SendReqForm::Etc100 | SendReqForm::Etc101 => {
                ("SEND_REQ", format!("16#{:04X}", self.config.request_code))
            }
            SendReqForm::DataExch => ("DATA_EXCH", self.config.exchange_type.to_string()),
        }
    }

    /// Why it does not run, if it does not.
    fn held(&self) -> String {
        if self.held { format!("{HELD}\n") } else { String::new() }
    }

    fn st(&self) -> String {
        let Self { words, name, address, .. } = self;
        let [timeout, length] = self.management();
        let [timeout_words, length_words] = self.management_words();
        let (function, code) = self.function();
        let never = if self.held { "FALSE AND " } else { "" };
        let mut text = self.held();
        // Writing to a String cannot fail.
        let _ = writeln!(text, "IF {never}{name}_Start AND NOT {name}_Last AND NOT {name}_Mgmt[0].0 THEN");
        let _ = writeln!(text, "    {name}_Adr := {address};");
        for (index, word) in words.words.iter().enumerate() {
            let about = about(self.plan, words, index);
            let _ = writeln!(text, "    {name}_Send[{index}] := 16#{word:04X};  (* {about} *)");
        }
        let _ = write!(
            text,
            "    {name}_Mgmt[2] := {timeout};  (* {timeout_words} *)\n\
             \x20   {name}_Mgmt[3] := {length};  (* {length_words} *)\n\
             \x20   {function}({name}_Adr, {code}, {name}_Send, {name}_Mgmt, {name}_Recv);\n\
             \x20   {name}_Busy := TRUE;  (* a request that is refused at once never raises the activity bit *)\n\
             END_IF;\n\
             {name}_Last := {name}_Start;\n\
             (* Done when the activity bit is down: low byte communication report, high byte operation report, both 0 = \
             answered; then\n   the CIP status: low byte general status, 0 = success. *)\n\
             IF {name}_Busy AND NOT {name}_Mgmt[0].0 THEN\n\
             \x20   {name}_Report := {name}_Mgmt[1];\n\
             \x20   {name}_Cip := {name}_Recv[1];\n\
             END_IF;\n\
             {name}_Busy := {name}_Mgmt[0].0;\n"
        );
        text
    }

    fn il(&self) -> String {
        let Self { words, name, address, .. } = self;
        let [timeout, length] = self.management();
        let [timeout_words, length_words] = self.management_words();
        let (function, code) = self.function();
        let text = address.to_string();
        let (convert, argument) = text.split_once('(').unwrap_or(("ADDR", ""));
        let argument = argument.trim_end_matches(')');
        let start = if self.held { "LD FALSE\n    AND" } else { "LD" };
        let mut text = self.held();
        // Writing to a String cannot fail.
        let _ = write!(
            text,
            "    {start} {name}_Start\n    ANDN {name}_Last\n    ANDN {name}_Mgmt[0].0\n    JMPCN {name}_Wait\n    \
             LD {argument}\n    {convert}\n    ST {name}_Adr\n"
        );
        for (index, word) in words.words.iter().enumerate() {
            let about = about(self.plan, words, index);
            let _ = write!(text, "    LD 16#{word:04X}  (* {about} *)\n    ST {name}_Send[{index}]\n");
        }
        let _ = write!(
            text,
            "    LD {timeout}  (* {timeout_words} *)\n    ST {name}_Mgmt[2]\n\
             \x20   LD {length}  (* {length_words} *)\n    ST {name}_Mgmt[3]\n\
             \x20   LD {name}_Adr\n    {function} {code}, {name}_Send, {name}_Mgmt, {name}_Recv\n\
             \x20   LD TRUE  (* a request that is refused at once never raises the activity bit *)\n    ST {name}_Busy\n\
             {name}_Wait:\n    LD {name}_Start\n    ST {name}_Last\n\
             (* Done when the activity bit is down: low byte communication report, high byte operation report, both 0 = \
             answered; then\n   the CIP status: low byte general status, 0 = success. *)\n\
             \x20   LD {name}_Busy\n    ANDN {name}_Mgmt[0].0\n    JMPCN {name}_Going\n\
             \x20   LD {name}_Mgmt[1]\n    ST {name}_Report\n    LD {name}_Recv[1]\n    ST {name}_Cip\n\
             {name}_Going:\n    LD {name}_Mgmt[0].0\n    ST {name}_Busy\n"
        );
        text
    }
}
