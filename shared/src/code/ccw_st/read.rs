//! Statements → blocks.

use alloc::collections::{BTreeMap, BTreeSet};
use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;

use super::PARAMETERS;
use crate::code::dialect::Dialect;
use crate::code::remark::{Remark, RemarkKind};
use crate::code::text::{Call, Declared, Expression, Item, Memory, Reading, Script, Statement};
use crate::code::{Found, Imported};
use crate::config::{MsgCipGeneric, write_hex};
use crate::plan::Severity;

const U8: i64 = 255;
const U16: i64 = 65_535;
const U32: i64 = 4_294_967_295;

/// Blocks from Structured Text of a Micro800.
pub(in crate::code) fn import(text: &str) -> Imported {
    let script = Script::read(text);
    let mut imported = Imported { blocks: Vec::new(), remarks: script.remarks.clone() };
    let types = types(&script);
    let mut memory = Memory::new(&script);
    let mut names = BTreeSet::new();
    let mut copies = Vec::new();
    for (index, item) in script.items.iter().enumerate() {
        if let Statement::Call(call) = &item.statement
            && is_message(call, &types)
        {
            let reading = Reading::new(&script, &memory, item);
            let mut block = Block { call, types: &types, reading, names: &mut names };
            let config = block.config(imported.blocks.len() + 1);
            let (lines, mut remarks) = (block.reading.lines(), block.reading.remarks);
            remarks.extend(copied(&script, &copies, call));
            let dialect = Dialect::CcwSt;
            imported.blocks.push(Found { config: config.into(), dialect, lines, remarks });
            if imported.is_full() {
                return imported;
            }
        }
        if matches!(&item.statement, Statement::Call(call) if is_copy(call, &types)) {
            copies.push(item);
        }
        memory.step(index, item);
    }
    if memory.is_full() {
        let words = "there are too many values in this text: some were left out";
        imported.remarks.push(Remark::error(1, 1, "", RemarkKind::told(&words)));
    }
    if imported.blocks.is_empty()
        && let Some(remark) = l5k(text)
    {
        return Imported { blocks: Vec::new(), remarks: alloc::vec![remark] };
    }
    let severity = if imported.blocks.is_empty() { Severity::Error } else { Severity::Note };
    imported.remarks.extend(crate::code::text::left_over(&script, names, severity));
    imported
}

/// The other text form of Logix: nothing of it is Structured Text, and every line of it would be an error.
fn l5k(text: &str) -> Option<Remark> {
    let (at, line) = text.lines().enumerate().find(|(_, line)| line.contains("(MessageType :="))?;
    let words =
        "this is an L5K text, of which nothing is read: save the project or its parts as L5X in Studio 5000";
    Some(Remark::error(at + 1, 1, line, RemarkKind::told(&words)))
}

/// Bytes of the request that come from other variables: their values are not known here.
fn copied(script: &Script<'_>, copies: &[&Item<'_>], call: &Call<'_>) -> Vec<Remark> {
    let Some(array) = Reading::key(call, 4, "ReqData") else { return Vec::new() };
    let into_it = copies.iter().filter(|item| match &item.statement {
        Statement::Call(copy) => Reading::key(copy, 3, "Dest").as_ref() == Some(&array),
        _ => false,
    });
    let words = "COP is not carried out here: the bytes that are assigned one by one are taken; compare them";
    let remark = |item: &&Item<'_>| {
        let (place, what) = (&item.place, RemarkKind::told(&words));
        Remark::warning(place.line, place.column, script.source(item), what)
    };
    into_it.map(remark).collect()
}

type Types<'s, 'a> = BTreeMap<String, &'s Declared<'a>>;

fn types<'s, 'a>(script: &'s Script<'a>) -> Types<'s, 'a> {
    let mut types = BTreeMap::new();
    for item in &script.items {
        if let Statement::Declaration(declaration) = &item.statement {
            types.extend(
                declaration.names.iter().map(|(name, _)| (name.to_ascii_lowercase(), &declaration.kind)),
            );
        }
    }
    types
}

/// An instance of `COP`; one that nobody declares is known by its name.
fn is_copy(call: &Call<'_>, types: &Types<'_, '_>) -> bool {
    let declared = types.get(&call.name.root.to_ascii_lowercase());
    declared.map_or_else(|| is_numbered(call.name.root, "COP"), |kind| kind.is("COP"))
}

/// An instance of `MSG_CIPGENERIC`; one that nobody declares is known by its parameters.
fn is_message(call: &Call<'_>, types: &Types<'_, '_>) -> bool {
    if let Some(kind) = types.get(&call.name.root.to_ascii_lowercase()) {
        return kind.is("MSG_CIPGENERIC");
    }
    let formal =
        |name: &str| call.arguments.iter().any(|it| it.name.is_some_and(|it| it.eq_ignore_ascii_case(name)));
    is_instance(call.name.root) || formal("AppCfg") || formal("TargetCfg") || is_positional(call)
}

/// An instance that nobody declares, by the name that the editor gives it: `MSG_CIPGENERIC_1`.
pub(in crate::code) fn is_instance(name: &str) -> bool {
    is_numbered(name, "MSG_CIPGENERIC")
}

/// A block's own name, or that with a number or a word behind it.
fn is_numbered(name: &str, block: &str) -> bool {
    let is_it = |(begin, rest): (&str, &str)| {
        begin.eq_ignore_ascii_case(block)
            && (rest.is_empty() || rest.starts_with(|c: char| c == '_' || c.is_ascii_digit()))
    };
    name.split_at_checked(block.len()).is_some_and(is_it)
}

/// `fb(start, ctrl, app, target, req, length, res)` of an instance that nobody declares.
pub(in crate::code) fn is_positional(call: &Call<'_>) -> bool {
    let variable = |at: &usize| {
        call.arguments.get(*at).is_some_and(|it| matches!(it.value, Some(Expression::Reference(_))))
    };
    let plain = call.arguments.iter().all(|it| it.name.is_none());
    plain && call.arguments.len() >= PARAMETERS.len() && [1, 2, 3, 4, 6].iter().all(variable)
}

struct Block<'b, 's, 'a> {
    call: &'s Call<'a>,
    types: &'b Types<'s, 'a>,
    reading: Reading<'b, 's, 'a>,
    names: &'b mut BTreeSet<String>,
}

impl Block<'_, '_, '_> {
    fn config(&mut self, number: usize) -> MsgCipGeneric {
        self.uses();
        let mut config = MsgCipGeneric::product_name("");
        config.name = if self.call.is("MSG_CIPGENERIC") {
            format!("message-{number}")
        } else {
            self.call
                .name
                .key()
                .map_or_else(|| format!("message-{number}"), |_| self.call.name.root.to_string())
        };
        self.ctrl_cfg(&mut config);
        self.app_cfg(&mut config);
        self.target_cfg(&mut config);
        self.data(&mut config);
        config
    }

    /// The variables of this message.
    fn uses(&mut self) {
        self.names.insert(self.call.name.root.to_ascii_lowercase());
        for argument in &self.call.arguments {
            if let Some(Expression::Reference(reference)) = &argument.value {
                self.names.insert(reference.root.to_ascii_lowercase());
            }
            let known = |name: &str| {
                PARAMETERS
                    .iter()
                    .chain(&["EN", "ENO", "Q", "Status", "ResLength"])
                    .any(|it| it.eq_ignore_ascii_case(name))
            };
            if let Some(name) = argument.name.filter(|name| !known(name)) {
                self.reading.say(Severity::Error, RemarkKind::UnknownMember(name.into()));
            }
        }
    }

    /// The variable of a parameter. What is not a variable is told.
    fn variable(&mut self, position: usize) -> Option<String> {
        let name = PARAMETERS.get(position)?;
        let key = Reading::key(self.call, position, name);
        if key.is_none() {
            self.reading.say(Severity::Error, RemarkKind::Expected(format!("a variable for {name}")));
        }
        key
    }

    fn ctrl_cfg(&mut self, config: &mut MsgCipGeneric) {
        let Some(key) = self.variable(1) else { return };
        let read = &mut self.reading;
        read.unknown(&key, &["Cancel", "TriggerType", "StrMode"]);
        let ctrl = &mut config.ctrl_cfg;
        ctrl.cancel = read.truth(&format!("{key}.cancel"), "CtrlCfg.Cancel").unwrap_or_default();
        let period = read.integer(&format!("{key}.triggertype"), "CtrlCfg.TriggerType", 0, U16);
        ctrl.trigger_type = period.unwrap_or_default();
        ctrl.str_mode = read.integer(&format!("{key}.strmode"), "CtrlCfg.StrMode", 0, U8).unwrap_or_default();
    }

    fn app_cfg(&mut self, config: &mut MsgCipGeneric) {
        let app = &mut config.app_cfg;
        (app.service, app.class, app.instance, app.attribute) = (0, 0, 0, 0);
        let Some(key) = self.variable(2) else { return };
        let read = &mut self.reading;
        read.unknown(&key, &["Service", "Class", "Instance", "Attribute", "MemberCnt", "MemberId"]);
        let mut needed = |member: &str, high: i64| {
            let label = format!("AppCfg.{member}");
            let before = read.remarks.len();
            let value = read.integer(&format!("{key}.{}", member.to_ascii_lowercase()), &label, 0, high);
            if value.is_none() && read.remarks.len() == before {
                read.say(Severity::Error, RemarkKind::Missing(label));
            }
            value.unwrap_or_default()
        };
        app.service = needed("Service", U8);
        app.class = needed("Class", U16);
        app.instance = needed("Instance", U32);
        app.attribute =
            read.integer(&format!("{key}.attribute"), "AppCfg.Attribute", 0, U16).unwrap_or_default();
        app.member_cnt =
            read.integer(&format!("{key}.membercnt"), "AppCfg.MemberCnt", 0, 3).unwrap_or_default();
        // Elements are counted from 0; where nobody sets that one, from 1.
        let mut member = |at: usize| {
            read.integer(&format!("{key}.memberid[{at}]"), &format!("AppCfg.MemberId[{at}]"), 0, U16)
        };
        let from_0 = [member(0), member(1), member(2), member(3)];
        let ids = if from_0.first() == Some(&None) && from_0.last() != Some(&None)
            || from_0.first() == Some(&None)
        {
            from_0.get(1..)
        } else {
            from_0.get(..3)
        };
        app.member_id = ids.unwrap_or_default().iter().map(|id| id.unwrap_or_default()).collect();
    }

    fn target_cfg(&mut self, config: &mut MsgCipGeneric) {
        let target = &mut config.target_cfg;
        let Some(key) = self.variable(3) else { return };
        let read = &mut self.reading;
        read.unknown(&key, &["Path", "CipConnMode", "UcmmTimeout", "ConnMsgTimeout", "ConnClose"]);
        let before = read.remarks.len();
        match read.text(&format!("{key}.path"), "TargetCfg.Path") {
            Some(path) => target.path = path.into(),
            None if read.remarks.len() == before => {
                read.say(Severity::Error, RemarkKind::Missing("TargetCfg.Path".into()));
            }
            None => {}
        }
        let mut number = |member: &str, high: i64| {
            let value = read.integer(
                &format!("{key}.{}", member.to_ascii_lowercase()),
                &format!("TargetCfg.{member}"),
                0,
                high,
            );
            value.unwrap_or_default()
        };
        target.cip_conn_mode = number("CipConnMode", 1);
        target.ucmm_timeout = number("UcmmTimeout", U32);
        target.conn_msg_timeout = number("ConnMsgTimeout", U32);
        target.conn_close =
            read.truth(&format!("{key}.connclose"), "TargetCfg.ConnClose").unwrap_or_default();
    }

    fn data(&mut self, config: &mut MsgCipGeneric) {
        let length = self.reading.integer_of(self.call, 5, "ReqLength", 0, 490);
        let length = length.and_then(|length| usize::try_from(length).ok());
        let named = self.call.argument(4, "ReqData").is_some();
        if length.is_none() && named {
            let words = "ReqLength is not known: all of ReqData that is set is sent";
            self.reading.say(Severity::Warning, RemarkKind::told(&words));
        }
        if length != Some(0)
            && let Some(key) = self.variable(4)
        {
            let low = self.types.get(&key).and_then(|kind| kind.bounds.first()).map(|(low, _)| *low);
            config.req_data = write_hex(&self.reading.bytes(&key, "ReqData", low, length));
        }
        let reply = Reading::key(self.call, 6, "ResData").and_then(|key| self.types.get(&key).copied());
        let size = reply.filter(|kind| !kind.bounds.is_empty()).map(Declared::elements);
        config.res_data_size = size.and_then(|size| i64::try_from(size).ok()).unwrap_or(490);
    }
}
