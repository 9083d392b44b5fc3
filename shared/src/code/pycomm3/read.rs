//! `generic_message` of pycomm3 in a script.

use alloc::collections::BTreeMap;
use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;

use super::super::dialect::Dialect;
use super::super::program::{Kind, Language, Names, Token, Value, groups, remember, tokens, value};
use super::super::remark::{Remark, RemarkKind};
use super::super::{Found, Imported, MAX_BLOCKS};
use super::call::Call;

/// Drivers that have `generic_message`.
const DRIVERS: [&str; 3] = ["CIPDriver", "LogixDriver", "SLCDriver"];

/// Constants of pycomm3 that stand for numbers.
const CONSTANTS: [(&str, i64); 24] = [
    ("Services.get_attributes_all", 0x01),
    ("Services.set_attributes_all", 0x02),
    ("Services.get_attribute_list", 0x03),
    ("Services.set_attribute_list", 0x04),
    ("Services.reset", 0x05),
    ("Services.start", 0x06),
    ("Services.stop", 0x07),
    ("Services.create", 0x08),
    ("Services.delete", 0x09),
    ("Services.apply_attributes", 0x0D),
    ("Services.get_attribute_single", 0x0E),
    ("Services.set_attribute_single", 0x10),
    ("Services.restore", 0x15),
    ("Services.save", 0x16),
    ("Services.nop", 0x17),
    ("Services.get_member", 0x18),
    ("Services.set_member", 0x19),
    ("ClassCode.identity_object", 0x01),
    ("ClassCode.message_router", 0x02),
    ("ClassCode.assembly", 0x04),
    ("ClassCode.connection_manager", 0x06),
    ("ClassCode.register", 0x07),
    ("ClassCode.parameter", 0x0F),
    ("ClassCode.parameter_group", 0x10),
];

/// A driver of the script.
#[derive(Clone, Debug)]
pub(super) struct Driver {
    /// As it is given to the driver; `None`: the program makes it.
    pub(super) path: Option<String>,
    /// Whether it goes to slot 0 when nothing else is said.
    pub(super) auto_slot: bool,
    /// s; `None`: as the library has it.
    pub(super) timeout: Option<f64>,
}

/// Blocks from a script.
pub(in super::super) fn import(text: &str) -> Imported {
    let (tokens, remarks) = tokens(text, Language::Python);
    let names =
        CONSTANTS.iter().map(|(name, number)| ((*name).to_string(), Value::Number(*number))).collect();
    let mut script =
        Script { names, drivers: BTreeMap::new(), blocks: Vec::new(), remarks, others: Vec::new() };
    for statement in statements(&tokens) {
        if script.blocks.len() > MAX_BLOCKS {
            break;
        }
        script.statement(statement);
    }
    script.finish(text)
}

/// What one statement is: from the beginning of a line to where all brackets are closed.
fn statements<'t, 'a>(tokens: &'t [Token<'a>]) -> Vec<&'t [Token<'a>]> {
    let (mut statements, mut depth, mut from) = (Vec::new(), 0_usize, 0);
    for (at, token) in tokens.iter().enumerate() {
        let last = at.checked_sub(1).and_then(|last| tokens.get(last));
        if depth == 0 && last.is_some_and(|last| token.line > last.line && !last.is("\\")) {
            statements.push(tokens.get(from..at).unwrap_or_default());
            from = at;
        }
        if token.kind == Kind::Sign {
            match token.text {
                "(" | "[" | "{" => depth += 1,
                ")" | "]" | "}" => depth = depth.saturating_sub(1),
                _ => {}
            }
        }
    }
    statements.extend(tokens.get(from..).filter(|last| !last.is_empty()));
    statements
}

struct Script {
    names: Names,
    drivers: BTreeMap<String, Driver>,
    blocks: Vec<Found>,
    remarks: Vec<Remark>,
    /// Lines that do something else.
    others: Vec<usize>,
}

impl Script {
    fn statement(&mut self, statement: &[Token<'_>]) {
        let Some(first) = statement.first() else { return };
        if first.is("import") || first.is("from") {
            return;
        }
        let find = |name: &str| statement.iter().position(|token| token.is(name));
        if let Some(at) = find("generic_message") {
            return self.message(statement, at);
        }
        let created = DRIVERS.into_iter().find_map(|driver| find(driver).map(|at| (driver, at)));
        if let Some((driver, at)) = created {
            return self.driver(statement, driver, at);
        }
        match statement {
            // `with driver as plc:`
            [with, driver, word, name, ..] if with.is("with") && word.is("as") => {
                if let Some(driver) = self.drivers.get(driver.text).cloned() {
                    self.drivers.insert(name.text.to_string(), driver);
                }
            }
            [with, ..] if with.is("with") => self.forget(statement),
            [name, dot, member, sign, rest @ ..]
                if dot.is(".") && member.is("socket_timeout") && sign.is("=") =>
            {
                let seconds = match value(rest, &self.names) {
                    Some(Value::Real(seconds)) => Some(seconds),
                    #[expect(clippy::cast_precision_loss, reason = "seconds, rounded to ms later")]
                    Some(Value::Number(seconds)) => Some(seconds as f64),
                    _ => None,
                };
                match (self.drivers.get_mut(name.text), seconds) {
                    (Some(driver), Some(seconds)) => driver.timeout = Some(seconds),
                    _ => self.say(first, statement, RemarkKind::NotConstant("socket_timeout".to_string())),
                }
            }
            [name, sign, rest @ ..] if name.kind == Kind::Name && sign.is("=") => {
                let value = value(rest, &self.names);
                self.drivers.remove(name.text);
                if value.is_none() {
                    self.forget(statement);
                    self.others.push(first.line);
                }
                remember(&mut self.names, name.text, value);
            }
            _ => {
                self.forget(statement);
                self.others.push(first.line);
            }
        }
    }

    /// What a statement may change is not known any more: what it assigns to, loops over, opens, or calls a method of.
    fn forget(&mut self, statement: &[Token<'_>]) {
        let mut at = 0;
        let mut outside = Vec::new();
        while let Some(token) = statement.get(at) {
            outside.push(token);
            at += token.close + 1;
        }
        let targets = outside.iter().rposition(|token| token.is("=")).unwrap_or(0);
        let calls = statement.get(1).is_some_and(|dot| dot.is("."));
        let parameters = statement.first().is_some_and(|word| word.is("def") || word.is("del"));
        let mut bound = false;
        for (index, token) in outside.into_iter().enumerate() {
            if index < targets || bound || calls && index == 0 {
                self.names.remove(token.text);
            }
            bound = (bound && !token.is("in") || token.is("for") || token.is("as")) && !token.is(":");
        }
        for token in statement.iter().filter(|_| parameters) {
            self.names.remove(token.text);
        }
    }

    /// `plc = CIPDriver("…")`, `with CIPDriver("…") as plc:`
    fn driver(&mut self, statement: &[Token<'_>], driver: &str, at: usize) {
        let (arguments, end) = groups(statement.get(at + 1..).unwrap_or_default());
        let argument = arguments.first().copied().unwrap_or_default();
        let argument = match argument {
            [name, sign, rest @ ..] if name.is("path") && sign.is("=") => rest,
            argument => argument,
        };
        let path = match value(argument, &self.names) {
            Some(Value::Text(path)) => Some(path),
            _ => None,
        };
        let name = match (statement, statement.get(at + 1 + end..)) {
            (_, Some([word, name, ..])) if word.is("as") => name.text,
            ([name, sign, ..], _) if sign.is("=") => name.text,
            _ => return self.others.extend(statement.first().map(|first| first.line)),
        };
        let driver = Driver { path, auto_slot: driver == "LogixDriver", timeout: None };
        self.drivers.insert(name.to_string(), driver);
    }

    fn message(&mut self, statement: &[Token<'_>], at: usize) {
        let Some(first) = statement.first() else { return };
        let name = at.checked_sub(2).and_then(|at| statement.get(at)).map_or("", |token| token.text);
        let (arguments, _) = groups(statement.get(at + 1..).unwrap_or_default());
        if arguments.is_empty() {
            return self.say(first, statement, RemarkKind::NotUnderstood);
        }
        let driver = self.drivers.get(name);
        let mut call = Call::new(&self.names, driver, statement);
        for (position, argument) in arguments.into_iter().enumerate() {
            call.argument(position, argument);
        }
        let config = call.config();
        let last = statement.last().map_or(first.line, |last| last.line);
        self.blocks.push(Found {
            config: config.into(),
            dialect: Dialect::Pycomm3,
            lines: first.line..last + 1,
            remarks: call.remarks,
        });
    }

    fn say(&mut self, first: &Token<'_>, statement: &[Token<'_>], what: RemarkKind) {
        let excerpt: Vec<&str> = statement.iter().map(|token| token.text).collect();
        self.remarks.push(Remark::error(first.line, first.column, &excerpt.join(" "), what));
    }

    fn finish(mut self, text: &str) -> Imported {
        let line = |number: usize| text.lines().nth(number.saturating_sub(1)).unwrap_or_default();
        if self.blocks.is_empty() {
            let first = self.others.first().copied().unwrap_or(1);
            let what = RemarkKind::Expected("generic_message(…) of pycomm3".to_string());
            self.remarks.push(Remark::error(first, 1, line(first), what));
        } else if let Some(first) = self.others.first() {
            let words = format!("what the program does in {} other lines", self.others.len());
            self.remarks.push(Remark::note(*first, 1, line(*first), RemarkKind::NoEffect(words)));
        }
        Imported { blocks: self.blocks, remarks: self.remarks }
    }
}
