//! `MessageRequest` of rseip in a program.

use alloc::collections::BTreeMap;
use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;
use core::fmt::Write;

use super::super::dialect::Dialect;
use super::super::program::{Kind, Language, MAX_GROUP, Names, Token, Value, groups, tokens, value};
use super::super::remark::{Remark, RemarkKind};
use super::super::{Found, Imported};
use crate::config::{MsgCipGeneric, TargetPath, write_hex};
use crate::plan::Severity;
use crate::wire::{Epath, LogicalKind, Segment};

/// Functions of `CommonServices`, and the service of each.
const SERVICES: [(&str, i64); 8] = [
    ("get_attribute_all", 0x01),
    ("set_attribute_all", 0x02),
    ("reset", 0x05),
    ("start", 0x06),
    ("stop", 0x07),
    ("get_attribute_single", 0x0E),
    ("set_attribute_single", 0x10),
    ("no_operation", 0x17),
];

/// What says where messages go.
const WAYS: [&str; 9] = [
    "connect",
    "new_host_lookup",
    "from_millis",
    "from_secs",
    "with_port_slot",
    "with_port",
    "PortSegment",
    "EipConnection",
    "AbEipConnection",
];

/// Blocks from a program.
pub(in super::super) fn import(text: &str) -> Imported {
    let (tokens, remarks) = tokens(text, Language::Rust);
    let mut program = Program {
        names: Names::new(),
        bound: BTreeMap::new(),
        way: Way::default(),
        fresh: true,
        blocks: Vec::new(),
        remarks,
    };
    let mut at = 0;
    while at < tokens.len() {
        at += program.step(tokens.get(at..).unwrap_or_default()).max(1);
    }
    program.finish(text, &tokens)
}

/// Where messages go, as far as the program has said so.
#[derive(Clone, Debug, Default)]
struct Way {
    name: Option<String>,
    host: Option<String>,
    hops: Vec<(i64, String)>,
    connected: bool,
    /// ms, in the order in which they are named.
    timeouts: Vec<i64>,
}

struct Program<'t, 'a> {
    names: Names,
    /// `let path = …;`
    bound: BTreeMap<&'a str, &'t [Token<'a>]>,
    way: Way,
    /// Nothing of a way has been said since the last message.
    fresh: bool,
    blocks: Vec<Found>,
    remarks: Vec<Remark>,
}

impl<'t, 'a> Program<'t, 'a> {
    /// One place of the program; how many tokens it has.
    fn step(&mut self, rest: &'t [Token<'a>]) -> usize {
        match rest {
            // `use a::b;`
            [word, ..] if word.is("use") => rest.iter().position(|token| token.is(";")).unwrap_or(rest.len()),
            [word, ..] if word.is("let") || word.is("const") => self.bind(rest),
            [name, a, b, new, open, ..]
                if name.is("MessageRequest") && a.is(":") && b.is(":") && new.is("new") && open.is("(") =>
            {
                let (arguments, length) = groups(rest.get(4..).unwrap_or_default());
                self.message(rest.get(..4 + length).unwrap_or(rest), None, &arguments);
                4 + length
            }
            [dot, name, open, ..] if dot.is(".") && open.is("(") => {
                if let Some((_, service)) = SERVICES.iter().find(|(service, _)| name.is(service)) {
                    let (arguments, length) = groups(rest.get(2..).unwrap_or_default());
                    if !arguments.is_empty() {
                        self.message(rest.get(..2 + length).unwrap_or(rest), Some(*service), &arguments);
                        return 2 + length;
                    }
                }
                self.way(rest);
                1
            }
            _ => {
                self.way(rest);
                1
            }
        }
    }

    /// `let mut name: type = …;`, `const NAME: type = …;`: only the name is behind; what it is made of is read on.
    fn bind(&mut self, rest: &'t [Token<'a>]) -> usize {
        let rest = rest.get(..rest.len().min(MAX_GROUP)).unwrap_or_default();
        let end = rest.iter().position(|token| token.is(";")).unwrap_or(rest.len());
        let Some(sign) = rest.get(..end).unwrap_or_default().iter().position(|token| token.is("=")) else {
            return 1;
        };
        let name = rest.iter().skip(1).find(|token| token.kind == Kind::Name && token.text != "mut");
        let made = rest.get(sign + 1..end).unwrap_or_default();
        if let Some(name) = name {
            self.bound.insert(name.text, made);
            if let Some(value) = value(made, &self.names) {
                if let (Value::Text(text), true) = (&value, name.text.eq_ignore_ascii_case("name")) {
                    self.renew();
                    self.way.name = Some(text.clone());
                }
                self.names.insert(name.text.to_string(), value);
            }
        }
        sign + 1
    }

    /// Something that says where messages go, and how long they have.
    fn way(&mut self, rest: &[Token<'_>]) {
        let Some(first) = rest.first().filter(|first| WAYS.contains(&first.text)) else { return };
        let (arguments, _) = match rest.get(1) {
            Some(open) if open.is("(") || open.is("{") => groups(rest.get(1..).unwrap_or_default()),
            _ => (Vec::new(), 0),
        };
        let argument =
            |position: usize| arguments.get(position).and_then(|tokens| value(tokens, &self.names));
        match (first.text, argument(0), argument(1)) {
            ("connect" | "new_host_lookup", Some(Value::Text(host)), _) => {
                self.renew();
                self.way.host = Some(host);
            }
            ("from_millis", Some(Value::Number(ms)), _) => self.timeout(ms),
            ("from_secs", Some(Value::Number(seconds)), _) => self.timeout(seconds.saturating_mul(1_000)),
            ("with_port_slot", Some(Value::Number(port)), Some(Value::Number(slot))) => {
                self.hop(port, slot.to_string());
            }
            ("with_port", Some(Value::Number(port)), _) => self.hop(port, "0".to_string()),
            ("PortSegment", ..) if rest.get(3).is_some_and(|token| token.is("default")) => {
                self.hop(1, "0".to_string());
            }
            ("PortSegment", ..) => {
                let member = |name: &str| {
                    arguments.iter().find_map(|argument| match argument {
                        [it, colon, rest @ ..] if it.is(name) && colon.is(":") => Some(rest),
                        _ => None,
                    })
                };
                let port = member("port").and_then(|tokens| value(tokens, &self.names));
                // `vec![0].into()`, `b"…".to_vec().into()`
                let link = member("link").and_then(|tokens| {
                    let end = tokens.iter().position(|token| token.is(".")).unwrap_or(tokens.len());
                    value(tokens.get(..end)?, &self.names)
                });
                if let (Some(Value::Number(port)), Some(Value::Bytes(link))) = (port, link) {
                    let link = match link.as_slice() {
                        [slot] => slot.to_string(),
                        text => String::from_utf8_lossy(text).into_owned(),
                    };
                    self.hop(port, link);
                }
            }
            ("EipConnection" | "AbEipConnection", ..) => {
                self.renew();
                self.way.connected = true;
            }
            _ => {}
        }
    }

    /// The first thing that is said after a message begins another way.
    fn renew(&mut self) {
        if !self.fresh {
            (self.way, self.fresh) = (Way::default(), true);
        }
    }

    fn timeout(&mut self, ms: i64) {
        self.renew();
        self.way.timeouts.push(ms);
    }

    fn hop(&mut self, port: i64, link: String) {
        self.renew();
        self.way.hops.push((port, link));
    }

    fn message(&mut self, tokens: &[Token<'a>], service: Option<i64>, arguments: &[&'t [Token<'a>]]) {
        let (Some(first), Some(last)) = (tokens.first(), tokens.last()) else { return };
        let (own, rest) = match service {
            Some(_) => (None, arguments),
            None => arguments.split_first().map_or((None, arguments), |(own, rest)| (Some(*own), rest)),
        };
        let mut config = MsgCipGeneric::product_name("");
        let mut remarks = Vec::new();
        let mut say = |severity: Severity, what: RemarkKind| {
            let excerpt: String = tokens.iter().take(8).map(|token| token.text).collect();
            remarks.push(Remark { severity, ..Remark::error(first.line, first.column, &excerpt, what) });
        };
        let own = own.and_then(|own| value(own, &self.names));
        config.app_cfg.service = match (service, own) {
            (Some(service), _) | (None, Some(Value::Number(service))) => service,
            _ => {
                say(Severity::Error, RemarkKind::NotConstant("service".to_string()));
                0
            }
        };
        if let Some(numbers) = rest.first().and_then(|path| self.path(path)) {
            object(&mut config, &numbers);
        } else {
            let words = "the path is no constant class, instance, attribute and members in this order";
            say(Severity::Error, RemarkKind::told(&words));
            config.app_cfg.class = 0;
        }
        match rest.get(1).map(|data| value(data, &self.names)) {
            None => config.req_data = String::new(),
            Some(Some(Value::Bytes(bytes))) => config.req_data = write_hex(&bytes),
            Some(_) => say(Severity::Error, RemarkKind::NotConstant("data".to_string())),
        }
        let way = &self.way;
        config.name = way.name.clone().unwrap_or_else(|| "request".to_string());
        let target = &mut config.target_cfg;
        match &way.host {
            Some(host) => {
                target.path = format!("4,{}", host.strip_suffix(":44818").unwrap_or(host));
                for (port, link) in &way.hops {
                    // Writing to a String cannot fail.
                    let _ = write!(target.path, ",{port},{link}");
                }
                if target.path.parse::<TargetPath>().is_err() {
                    say(
                        Severity::Error,
                        RemarkKind::Told(format!("{} is no path: write where it goes", target.path)),
                    );
                }
            }
            None => say(
                Severity::Error,
                RemarkKind::Missing("the address, TcpStream::connect(\"…\")".to_string()),
            ),
        }
        target.cip_conn_mode = way.connected.into();
        target.ucmm_timeout = way.timeouts.first().copied().unwrap_or(0);
        if way.connected {
            // The connection ends with the program.
            target.conn_close = true;
            target.conn_msg_timeout = way.timeouts.get(1).or(way.timeouts.first()).copied().unwrap_or(0);
        }
        if way.timeouts.is_empty() {
            say(
                Severity::Note,
                RemarkKind::told(&"the program waits for ever: the timeouts are those of the block"),
            );
        }
        self.fresh = false;
        let lines = first.line..last.line + 1;
        self.blocks.push(Found { config: config.into(), dialect: Dialect::Rust, lines, remarks });
    }

    /// The segments of a path: a chain of `with_…`, a variable, or bytes.
    fn path(&self, tokens: &[Token<'a>]) -> Option<Vec<(LogicalKind, i64)>> {
        let tokens = match tokens {
            [name] => self.bound.get(name.text).copied().unwrap_or(tokens),
            tokens => tokens,
        };
        if let Some(Value::Bytes(bytes)) = value(tokens, &self.names) {
            let path = Epath::decode(&bytes).ok()?;
            let segment = |segment: &Segment| match segment {
                Segment::Logical(it) => Some((it.kind, i64::from(it.value))),
                _ => None,
            };
            return path.segments().iter().map(segment).collect();
        }
        let mut numbers = Vec::new();
        for (at, token) in tokens.iter().enumerate() {
            let kind = match token.text {
                "with_class" => LogicalKind::Class,
                "with_instance" => LogicalKind::Instance,
                "with_attribute" => LogicalKind::Attribute,
                "with_element" => LogicalKind::Member,
                "with_symbol" | "from_symbol" | "parse_tag" => return None,
                _ => continue,
            };
            let (arguments, _) = groups(tokens.get(at + 1..)?);
            let Value::Number(number) = value(arguments.first()?, &self.names)? else { return None };
            numbers.push((kind, number));
        }
        let kinds: Vec<LogicalKind> = numbers.iter().map(|(kind, _)| *kind).collect();
        let [LogicalKind::Class, LogicalKind::Instance, rest @ ..] = kinds.as_slice() else { return None };
        let members = rest.strip_prefix(&[LogicalKind::Attribute]).unwrap_or(rest);
        (members.len() <= 3 && members.iter().all(|kind| *kind == LogicalKind::Member)).then_some(numbers)
    }

    fn finish(mut self, text: &str, tokens: &[Token<'_>]) -> Imported {
        if self.blocks.is_empty() {
            let what = RemarkKind::Expected("MessageRequest::new(…) of rseip".to_string());
            self.remarks.push(Remark::error(1, 1, text, what));
        } else if let Some(around) =
            tokens.iter().find(|token| ["for", "while", "loop"].iter().any(|word| token.is(word)))
        {
            let what = RemarkKind::NoEffect("how often the program does it".to_string());
            self.remarks.push(Remark::note(around.line, around.column, around.text, what));
        }
        Imported { blocks: self.blocks, remarks: self.remarks }
    }
}

fn object(config: &mut MsgCipGeneric, numbers: &[(LogicalKind, i64)]) {
    let app = &mut config.app_cfg;
    let number =
        |kind: LogicalKind| numbers.iter().find(|(it, _)| *it == kind).map_or(0, |(_, number)| *number);
    app.class = number(LogicalKind::Class);
    app.instance = number(LogicalKind::Instance);
    app.attribute = number(LogicalKind::Attribute);
    let members = numbers.iter().filter(|(kind, _)| *kind == LogicalKind::Member);
    app.member_id = members.map(|(_, number)| *number).collect();
    app.member_cnt = i64::try_from(app.member_id.len()).unwrap_or(i64::MAX);
    app.member_id.resize(3, 0);
}
