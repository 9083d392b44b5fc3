//! Statements → blocks.

use alloc::collections::{BTreeMap, BTreeSet};
use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;

use super::{SEGMENTS, route, width};
use crate::code::change::{Change, Grade, Why};
use crate::code::dialect::Dialect;
use crate::code::message::spaced;
use crate::code::remark::{Remark, RemarkKind};
use crate::code::text::{
    Call, Declared, Expression, Literal, Memory, Reading, Reference, Script, Statement, Step, left_over,
};
use crate::code::{Found, Imported};
use crate::config::{MsgCipGeneric, write_hex};
use crate::plan::limits::{CONN_MSG_TIMEOUT, TimeoutRange, UCMM_TIMEOUT};
use crate::plan::{MessagePlan, Severity};
use crate::wire::LogicalKind;

/// No input has a position that a public page shows.
const NAMED: usize = usize::MAX;

const INPUTS: [&str; 15] = [
    "Execute",
    "EN",
    "RoutePath",
    "TimeOut",
    "ServiceCode",
    "RqPath",
    "ServiceDat",
    "Size",
    "RespServiceDat",
    "Handle",
    "DataSize",
    "Done",
    "Busy",
    "Error",
    "ErrorID",
];

const OUTPUTS: [&str; 3] = ["ErrorIDEx", "RespSize", "ENO"];

/// Tenths of a second, where `TimeOut` is not given.
const USUAL_TIMEOUT: i64 = 20;

/// Blocks from Structured Text of an NJ or NX.
pub(in crate::code) fn import(text: &str) -> Imported {
    let script = Script::read(text);
    let mut imported = Imported { blocks: Vec::new(), remarks: script.remarks.clone() };
    let types = types(&script);
    let mut memory = Memory::new(&script);
    let mut names = BTreeSet::new();
    let calls = script.items.iter().enumerate().filter_map(|(index, item)| match &item.statement {
        Statement::Call(call) => Some((index, call, instruction(call, &types)?)),
        _ => None,
    });
    let calls: Vec<(usize, &Call<'_>, Instruction)> = calls.collect();
    let mut calls_left = calls.iter().peekable();
    for (index, item) in script.items.iter().enumerate() {
        if let Some((_, call, instruction)) = calls_left.next_if(|(at, ..)| *at == index) {
            uses(call, &mut names);
            if matches!(instruction, Instruction::Unconnected | Instruction::Send) {
                let reading = Reading::new(&script, &memory, item);
                let mut block = Block { call, types: &types, reading };
                let config = block.config(*instruction, &calls, &script, imported.blocks.len() + 1);
                let (lines, remarks) = (block.reading.lines(), block.reading.remarks);
                let dialect = Dialect::SysmacSt;
                imported.blocks.push(Found { config: config.into(), dialect, lines, remarks });
            }
        }
        memory.step(index, item);
    }
    if memory.is_full() {
        let words = "there are too many values in this text: some were left out";
        imported.remarks.push(Remark::error(1, 1, "", RemarkKind::told(&words)));
    }
    let severity = if imported.blocks.is_empty() { Severity::Error } else { Severity::Note };
    imported.remarks.extend(left_over(&script, names, severity));
    imported
}

type Types<'s, 'a> = BTreeMap<String, &'s Declared<'a>>;

fn types<'s, 'a>(script: &'s Script<'a>) -> Types<'s, 'a> {
    let mut types = BTreeMap::new();
    for item in &script.items {
        if let Statement::Declaration(declaration) = &item.statement {
            types.extend(declaration.names.iter().map(|(name, _)| (name.to_lowercase(), &declaration.kind)));
        }
    }
    types
}

/// What is called.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Instruction {
    Unconnected,
    Open,
    Send,
    Close,
}

/// By the type of the instance, or by the inputs of one that nobody declares.
fn instruction(call: &Call<'_>, types: &Types<'_, '_>) -> Option<Instruction> {
    let declared = types.get(&call.name.root.to_lowercase()).map(|kind| kind.name);
    match declared.unwrap_or(call.name.root).to_ascii_lowercase().as_str() {
        "cipucmmsend" => Some(Instruction::Unconnected),
        "cipsend" => Some(Instruction::Send),
        "cipopen" | "cipopenwithdatasize" => Some(Instruction::Open),
        "cipclose" => Some(Instruction::Close),
        _ if declared.is_some() => None,
        _ => {
            let has = |name: &str| call.argument(NAMED, name).is_some();
            match (has("RqPath"), has("RoutePath"), has("Handle")) {
                (true, _, true) => Some(Instruction::Send),
                (true, _, false) => Some(Instruction::Unconnected),
                (false, true, _) => Some(Instruction::Open),
                (false, false, _) => None,
            }
        }
    }
}

fn uses(call: &Call<'_>, names: &mut BTreeSet<String>) {
    names.insert(call.name.root.to_lowercase());
    for argument in &call.arguments {
        if let Some(Expression::Reference(reference)) = &argument.value {
            names.insert(reference.root.to_lowercase());
        }
    }
}

struct Block<'b, 's, 'a> {
    call: &'s Call<'a>,
    types: &'b Types<'s, 'a>,
    reading: Reading<'b, 's, 'a>,
}

impl<'s, 'a> Block<'_, 's, 'a> {
    fn config(
        &mut self,
        instruction: Instruction,
        calls: &[(usize, &'s Call<'a>, Instruction)],
        script: &'s Script<'a>,
        number: usize,
    ) -> MsgCipGeneric {
        self.inputs(self.call);
        let mut config = MsgCipGeneric::product_name("");
        let is_function =
            self.call.name.root.to_ascii_lowercase().starts_with("cip") && self.types.is_empty();
        config.name = if is_function { format!("message-{number}") } else { self.call.name.root.to_string() };
        let service = self.reading.integer_of(self.call, NAMED, "ServiceCode", 0, 255);
        config.app_cfg.service = self.needed("ServiceCode", service);
        let call = self.call;
        if instruction == Instruction::Send {
            self.connected(calls, script, &mut config);
        } else {
            self.route(call, &mut config);
            let timeout = self.timeout(call, "TargetCfg.UcmmTimeout", UCMM_TIMEOUT);
            config.target_cfg.ucmm_timeout = timeout;
        }
        self.data(&mut config);
        self.reply(&mut config);
        let widths = self.path(&mut config);
        self.compare(&config, widths);
        config
    }

    fn needed(&mut self, name: &str, value: Option<i64>) -> i64 {
        if value.is_none() && self.call.argument(NAMED, name).is_none() {
            self.reading.say(Severity::Error, RemarkKind::Missing(name.into()));
        }
        value.unwrap_or_default()
    }

    fn inputs(&mut self, call: &Call<'a>) {
        for argument in &call.arguments {
            match argument.name {
                Some(name) if INPUTS.iter().chain(&OUTPUTS).any(|it| it.eq_ignore_ascii_case(name)) => {}
                Some(name) => self.reading.say(Severity::Error, RemarkKind::UnknownMember(name.into())),
                None => {
                    let words = "arguments with their names, as in RqPath := …,";
                    self.reading.say(Severity::Error, RemarkKind::Expected(words.into()));
                    return;
                }
            }
        }
    }

    /// `CIPSend` goes where the `CIPOpen` with the same handle has opened a connection to.
    fn connected(
        &mut self,
        calls: &[(usize, &'s Call<'a>, Instruction)],
        script: &'s Script<'a>,
        config: &mut MsgCipGeneric,
    ) {
        let call = self.call;
        config.target_cfg.cip_conn_mode = 1;
        config.target_cfg.conn_msg_timeout = self.timeout(call, "TargetCfg.ConnMsgTimeout", CONN_MSG_TIMEOUT);
        let handle = Reading::key(call, NAMED, "Handle");
        let same = |other: &&(usize, &'s Call<'a>, Instruction)| {
            let key = Reading::key(other.1, NAMED, "Handle");
            // `Handle := open.Handle` names the instance.
            let of_instance = other.1.name.key().map(|name| format!("{name}.handle"));
            handle.is_some() && (key == handle || of_instance == handle)
        };
        let of = |instruction: Instruction| calls.iter().filter(move |it| it.2 == instruction).find(same);
        config.target_cfg.conn_close = of(Instruction::Close).is_some();
        let Some((at, open, _)) = of(Instruction::Open) else {
            self.reading.say(Severity::Error, RemarkKind::Missing("the CIPOpen of this handle".into()));
            return;
        };
        if let Some(item) = script.items.get(*at) {
            self.reading.begins(item);
        }
        self.inputs(open);
        if open.argument(NAMED, "DataSize").is_some() {
            self.reading.say(Severity::Note, RemarkKind::NoEffect("DataSize".into()));
        }
        self.route(open, config);
        config.target_cfg.ucmm_timeout = self.timeout(open, "TargetCfg.UcmmTimeout", UCMM_TIMEOUT);
    }

    fn route(&mut self, call: &'s Call<'a>, config: &mut MsgCipGeneric) {
        let given = call.argument(NAMED, "RoutePath").and_then(|argument| argument.value.as_ref());
        let text = match given {
            Some(Expression::Literal(Literal::Text(text), _)) => Some(text.as_str()),
            Some(Expression::Reference(reference)) => {
                reference.key().and_then(|key| self.reading.text_or_told(&key, "RoutePath"))
            }
            Some(_) => {
                self.reading.say(Severity::Error, RemarkKind::NotConstant("RoutePath".into()));
                None
            }
            None => {
                self.reading.say(Severity::Error, RemarkKind::Missing("RoutePath".into()));
                None
            }
        };
        let Some(text) = text else { return };
        if let Some(path) = route::read(text) {
            config.target_cfg.path = path;
        } else {
            let words = format!("a route path such as 02\\192.168.250.2\\01\\#00 instead of {text}");
            self.reading.say(Severity::Error, RemarkKind::Expected(words));
        }
    }

    /// ms.
    fn timeout(&mut self, call: &'s Call<'a>, member: &str, range: TimeoutRange) -> i64 {
        let given = call.argument(NAMED, "TimeOut").is_some();
        let steps = self.reading.integer_of(call, NAMED, "TimeOut", 0, 65_535);
        let steps = match steps {
            Some(0) | None => {
                let words = format!(
                    "TimeOut is {}: {USUAL_TIMEOUT} tenths of a second are taken",
                    if given { "0 or not known" } else { "not given" }
                );
                self.reading.say(Severity::Warning, RemarkKind::Told(words));
                USUAL_TIMEOUT
            }
            Some(steps) => steps,
        };
        let ms = steps.saturating_mul(100);
        let moved = ms.clamp(range.min.into(), range.max.into());
        if moved != ms {
            let why = Why::TimeoutBounds(range.min, range.max);
            let change =
                Change::new(&member, &format!("{ms} ms"), &format!("{moved} ms"), Grade::Adjusted, why);
            self.reading.say(Severity::Warning, RemarkKind::Change(change));
        }
        moved
    }

    /// Class, instance and attribute; and the widths of their segments, if they are known.
    fn path(&mut self, config: &mut MsgCipGeneric) -> Vec<(LogicalKind, u32, String)> {
        let app = &mut config.app_cfg;
        (app.class, app.instance, app.attribute) = (0, 0, 0);
        let Some(key) = Reading::key(self.call, NAMED, "RqPath") else { return Vec::new() };
        let reading = &mut self.reading;
        let known: Vec<&str> = SEGMENTS.iter().flat_map(|(n, f)| [*n, *f]).chain(["isAttributeID"]).collect();
        reading.unknown(&key, &known);
        let kind = self.types.get(&key).map(|kind| kind.name.to_ascii_lowercase());
        let formats =
            SEGMENTS.iter().any(|(_, format)| reading.has(&format!("{key}.{}", format.to_lowercase())));
        let extended = kind.map_or(formats, |kind| kind == "_srequest_path_ex");
        let has_attribute =
            reading.truth(&format!("{key}.isattributeid"), "isAttributeID").unwrap_or_default();
        let kinds = [LogicalKind::Class, LogicalKind::Instance, LogicalKind::Attribute];
        let mut widths = Vec::new();
        let mut values = [0_i64; 3];
        for (((name, format), kind), slot) in SEGMENTS.iter().zip(kinds).zip(&mut values) {
            if kind == LogicalKind::Attribute && !has_attribute {
                continue;
            }
            let value_key = format!("{key}.{}", name.to_lowercase());
            if !reading.has(&value_key) {
                reading.say(Severity::Error, RemarkKind::Missing(format!("RqPath.{name}")));
            }
            let high = if kind == LogicalKind::Instance { 4_294_967_295 } else { 65_535 };
            let value = reading.integer(&value_key, &format!("RqPath.{name}"), 0, high).unwrap_or_default();
            *slot = value;
            let value = u32::try_from(value).unwrap_or(0);
            let told = reading.word(&format!("{key}.{}", format.to_lowercase()));
            let width = match told {
                Some(told) => told.rsplit('#').next().unwrap_or_default().to_ascii_uppercase(),
                None if extended => "_8BIT".to_string(),
                None => "_16BIT".to_string(),
            };
            if !matches!(width.as_str(), "_8BIT" | "_16BIT" | "_32BIT") {
                reading.say(Severity::Error, RemarkKind::NotConstant(format!("RqPath.{format}")));
            }
            if width == "_8BIT" && value > 0xFF || width == "_16BIT" && value > 0xFFFF {
                let words = format!(
                    "RqPath.{name} {value} does not fit into {width}: it is sent in {}",
                    self::width(value)
                );
                reading.say(Severity::Warning, RemarkKind::Told(words));
            }
            widths.push((kind, value, width));
        }
        [app.class, app.instance, app.attribute] = values;
        widths
    }

    /// Segments of other widths are other bytes.
    fn compare(&mut self, config: &MsgCipGeneric, widths: Vec<(LogicalKind, u32, String)>) {
        let Some(plan) = MessagePlan::parse(config).0 else { return };
        let mut path = Vec::new();
        for (kind, value, width) in widths {
            let bytes = value.to_le_bytes();
            match width.as_str() {
                "_8BIT" => path.extend([kind.code(), bytes[0]]),
                "_16BIT" => path.extend([kind.code() | 1, 0, bytes[0], bytes[1]]),
                _ => path.extend([kind.code() | 2, 0, bytes[0], bytes[1], bytes[2], bytes[3]]),
            }
        }
        if path != plan.request().path().bytes() {
            let (from, to) = (spaced(&path), spaced(&plan.request().path().bytes()));
            let change = Change::new(&"path", &from, &to, Grade::Request, Why::SegmentWidths);
            self.reading.say(Severity::Warning, RemarkKind::Change(change));
        }
    }

    /// `ServiceDat := Req[0], Size := 4`: so many elements from there, each as wide as its type.
    fn data(&mut self, config: &mut MsgCipGeneric) {
        let size = self.reading.integer_of(self.call, NAMED, "Size", 0, 65_535);
        let count = usize::try_from(self.needed("Size", size)).unwrap_or(0);
        if count == 0 {
            return;
        }
        let Some((root, from)) = self.start("ServiceDat") else {
            self.reading.say(Severity::Error, RemarkKind::Expected("a variable for ServiceDat".into()));
            return;
        };
        let kind = self.types.get(&root).map_or("BYTE", |kind| kind.name).to_ascii_uppercase();
        let (width, low, high): (usize, i64, i64) = match kind.as_str() {
            "BYTE" | "USINT" => (1, 0, 0xFF),
            "SINT" => (1, -0x80, 0x7F),
            "WORD" | "UINT" => (2, 0, 0xFFFF),
            "INT" => (2, -0x8000, 0x7FFF),
            "DWORD" | "UDINT" => (4, 0, 0xFFFF_FFFF),
            "DINT" => (4, -0x8000_0000, 0x7FFF_FFFF),
            "LINT" | "LWORD" | "ULINT" => (8, i64::MIN, i64::MAX),
            _ => {
                let words = format!("bytes, words or whole numbers for ServiceDat instead of {kind}");
                self.reading.say(Severity::Error, RemarkKind::Expected(words));
                return;
            }
        };
        let values = if let Some(from) = from {
            self.reading.elements(&root, "ServiceDat", from, count, (low, high))
        } else {
            let value = self.reading.integer(&root, "ServiceDat", low, high);
            if value.is_none() && !self.reading.has(&root) {
                self.reading.say(Severity::Error, RemarkKind::NotConstant("ServiceDat".into()));
            }
            [value.unwrap_or_default()].into()
        };
        let bytes = values.iter().flat_map(|value| value.to_le_bytes().into_iter().take(width));
        config.req_data = write_hex(&bytes.collect::<Vec<u8>>());
    }

    /// The variable and the index of `Req[0]`; no index: not an array.
    fn start(&self, name: &str) -> Option<(String, Option<i128>)> {
        let reference: &Reference<'_> = self.call.argument(NAMED, name)?.value.as_ref()?.reference()?;
        let Some((Step::Index(indexes), before)) = reference.steps.split_last() else {
            return Some((reference.key()?, None));
        };
        let [index] = indexes.as_slice() else { return None };
        let array = Reference { root: reference.root, steps: before.to_vec(), place: reference.place };
        Some((array.key()?, Some(index.integer()?)))
    }

    fn reply(&mut self, config: &mut MsgCipGeneric) {
        let elements = self.start("RespServiceDat").and_then(|(root, _)| self.types.get(&root).copied());
        let is_bytes = |kind: &&Declared<'_>| ["BYTE", "USINT", "SINT"].iter().any(|name| kind.is(name));
        let size = elements.filter(is_bytes).map(Declared::elements);
        config.res_data_size =
            size.and_then(|size| i64::try_from(size).ok()).map_or(490, |size| size.clamp(1, 490));
    }
}
