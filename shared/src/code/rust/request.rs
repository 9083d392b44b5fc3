//! One request of a program as a block.

use alloc::collections::BTreeMap;
use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;
use core::fmt::Write;

use super::super::program::{Names, Token, Value, groups, value};
use super::super::remark::{Remark, RemarkKind};
use super::way::Way;
use crate::config::{CipAppCfg, CipTargetCfg, MsgCipGeneric, TargetPath, write_hex};
use crate::plan::Severity;
use crate::wire::{Epath, LogicalKind, Segment};

/// `let path = …;`
pub(super) type Bound<'t, 'a> = BTreeMap<&'a str, &'t [Token<'a>]>;

/// A request being read.
pub(super) struct Request<'r, 't, 'a> {
    pub(super) names: &'r Names,
    pub(super) bound: &'r Bound<'t, 'a>,
    pub(super) way: &'r Way,
    /// All of the call.
    pub(super) tokens: &'r [Token<'a>],
    pub(super) remarks: Vec<Remark>,
}

impl<'t, 'a> Request<'_, 't, 'a> {
    /// The block. Without a service of its own the first argument is one.
    pub(super) fn config(&mut self, service: Option<i64>, arguments: &[&'t [Token<'a>]]) -> MsgCipGeneric {
        let (own, rest) = match service {
            Some(_) => (None, arguments),
            None => arguments.split_first().map_or((None, arguments), |(own, rest)| (Some(*own), rest)),
        };
        let mut config = MsgCipGeneric::product_name("");
        let own = own.and_then(|own| value(own, self.names));
        config.app_cfg.service = match (service, own) {
            (Some(service), _) | (None, Some(Value::Number(service))) => service,
            _ => {
                self.say(Severity::Error, RemarkKind::NotConstant("service".to_string()));
                0
            }
        };
        if let Some(numbers) = rest.first().and_then(|path| self.path(path)) {
            object(&mut config.app_cfg, &numbers);
        } else {
            let words = "the path is no constant class, instance, attribute and members in this order";
            self.say(Severity::Error, RemarkKind::told(&words));
            config.app_cfg.class = 0;
        }
        match rest.get(1).map(|data| value(data, self.names)) {
            None => config.req_data = String::new(),
            Some(Some(Value::Bytes(bytes))) => config.req_data = write_hex(&bytes),
            Some(_) => self.say(Severity::Error, RemarkKind::NotConstant("data".to_string())),
        }
        config.name = self.way.name.clone().unwrap_or_else(|| "request".to_string());
        self.target(&mut config.target_cfg);
        config
    }

    /// Where it goes, and how long it has.
    fn target(&mut self, target: &mut CipTargetCfg) {
        let way = self.way;
        if let Some(host) = &way.host {
            target.path = format!("4,{}", host.strip_suffix(":44818").unwrap_or(host));
            for (port, link) in &way.hops {
                // Writing to a String cannot fail.
                let _ = write!(target.path, ",{port},{link}");
            }
            if target.path.parse::<TargetPath>().is_err() {
                let words = format!("{} is no path: write where it goes", target.path);
                self.say(Severity::Error, RemarkKind::Told(words));
            }
        } else {
            let words = "the address, TcpStream::connect(\"…\")".to_string();
            self.say(Severity::Error, RemarkKind::Missing(words));
        }
        target.cip_conn_mode = way.connected.into();
        target.ucmm_timeout = way.timeouts.first().copied().unwrap_or(0);
        if way.connected {
            // The connection ends with the program.
            target.conn_close = true;
            target.conn_msg_timeout = way.timeouts.get(1).or(way.timeouts.first()).copied().unwrap_or(0);
        }
        if way.timeouts.is_empty() {
            let words = "the program waits for ever: the timeouts are those of the block";
            self.say(Severity::Note, RemarkKind::told(&words));
        }
    }

    /// The segments of a path: a chain of `with_…`, a variable, or bytes.
    fn path(&self, tokens: &[Token<'_>]) -> Option<Vec<(LogicalKind, i64)>> {
        let tokens = match tokens {
            [name] => self.bound.get(name.text).copied().unwrap_or(tokens),
            tokens => tokens,
        };
        if let Some(Value::Bytes(bytes)) = value(tokens, self.names) {
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
            let Value::Number(number) = value(arguments.first()?, self.names)? else { return None };
            numbers.push((kind, number));
        }
        let kinds: Vec<LogicalKind> = numbers.iter().map(|(kind, _)| *kind).collect();
        let [LogicalKind::Class, LogicalKind::Instance, rest @ ..] = kinds.as_slice() else { return None };
        let members = rest.strip_prefix(&[LogicalKind::Attribute]).unwrap_or(rest);
        (members.len() <= 3 && members.iter().all(|kind| *kind == LogicalKind::Member)).then_some(numbers)
    }

    fn say(&mut self, severity: Severity, what: RemarkKind) {
        let Some(first) = self.tokens.first() else { return };
        let excerpt: String = self.tokens.iter().take(8).map(|token| token.text).collect();
        let remark = Remark::error(first.line, first.column, &excerpt, what);
        self.remarks.push(Remark { severity, ..remark });
    }
}

fn object(app: &mut CipAppCfg, numbers: &[(LogicalKind, i64)]) {
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
