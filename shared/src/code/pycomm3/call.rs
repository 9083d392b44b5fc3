//! One `generic_message(…)` as a block.

use alloc::collections::BTreeMap;
use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;
use core::fmt::Write;

use super::super::l5x::link;
use super::super::program::{Names, Token, Value, value};
use super::super::remark::{Remark, RemarkKind};
use super::read::Driver;
use crate::config::{MsgCipGeneric, TargetPath, write_hex};
use crate::plan::Severity;
use crate::wire::{Epath, Segment};

/// In the order in which they may be given without a name.
const PARAMETERS: [&str; 10] = [
    "service",
    "class_code",
    "instance",
    "attribute",
    "request_data",
    "data_type",
    "name",
    "connected",
    "unconnected_send",
    "route_path",
];

/// The library's own timeout of a socket, in s.
const SOCKET_TIMEOUT: f64 = 5.0;

/// A call being read.
pub(super) struct Call<'c, 'a> {
    names: &'c Names,
    driver: Option<&'c Driver>,
    statement: &'c [Token<'a>],
    given: BTreeMap<&'static str, Option<Value>>,
    pub(super) remarks: Vec<Remark>,
}

impl<'c, 'a> Call<'c, 'a> {
    pub(super) fn new(names: &'c Names, driver: Option<&'c Driver>, statement: &'c [Token<'a>]) -> Self {
        Self { names, driver, statement, given: BTreeMap::new(), remarks: Vec::new() }
    }

    /// One argument, with its name or by its position.
    pub(super) fn argument(&mut self, position: usize, argument: &[Token<'_>]) {
        let (name, tokens) = match argument {
            [name, sign, rest @ ..] if sign.is("=") => (name.text, rest),
            tokens => (PARAMETERS.get(position).copied().unwrap_or_default(), tokens),
        };
        let Some(known) = PARAMETERS.into_iter().find(|known| *known == name) else {
            return self.say(Severity::Warning, RemarkKind::UnknownMember(name.to_string()));
        };
        let value = value(tokens, self.names);
        if self.given.insert(known, value).is_some() {
            self.say(Severity::Warning, RemarkKind::Twice(known.to_string()));
        }
    }

    pub(super) fn config(&mut self) -> MsgCipGeneric {
        let mut config = MsgCipGeneric::product_name("");
        config.name = match self.given.get("name") {
            Some(Some(Value::Text(name))) => name.clone(),
            _ => "generic".to_string(),
        };
        let app = &mut config.app_cfg;
        app.service = self.number("service", true);
        app.class = self.number("class_code", true);
        app.instance = self.number("instance", true);
        app.attribute = self.number("attribute", false);
        let mut data = self.bytes("request_data");
        let connected = self.flag("connected", true);
        let wrapped = !connected && self.flag("unconnected_send", false);
        let target = &mut config.target_cfg;
        target.path = self.path(connected, wrapped, &mut data);
        target.cip_conn_mode = connected.into();
        let seconds = self.driver.and_then(|driver| driver.timeout).unwrap_or(SOCKET_TIMEOUT);
        #[expect(clippy::cast_possible_truncation, reason = "out of every range before that matters")]
        let ms = (seconds * 1_000.0 + 0.5) as i64;
        target.ucmm_timeout = ms;
        if connected {
            // The connection ends with the script.
            (target.conn_msg_timeout, target.conn_close) = (ms, true);
        }
        config.req_data = write_hex(&data);
        config
    }

    /// Where it goes, as `TargetCfg.Path`.
    fn path(&mut self, connected: bool, wrapped: bool, data: &mut Vec<u8>) -> String {
        let Some(driver) = self.driver else {
            self.say(Severity::Error, RemarkKind::Missing("the driver, CIPDriver(\"…\")".to_string()));
            return String::new();
        };
        let Some(text) = &driver.path else {
            self.say(Severity::Error, RemarkKind::NotConstant("the path of the driver".to_string()));
            return String::new();
        };
        let (host, own) = parts(text, driver.auto_slot);
        let given = self.given.get("route_path").cloned();
        let route = match given {
            _ if connected => own,
            None | Some(Some(Value::Bool(true))) => own,
            Some(Some(Value::Bool(false))) => Some(Vec::new()),
            Some(Some(Value::Text(route))) => hops(&route.split(['/', '\\', ',']).collect::<Vec<_>>()),
            Some(Some(Value::Bytes(bytes))) => encoded(&bytes),
            Some(_) => None,
        };
        let Some(route) = route else {
            self.told(
                Severity::Error,
                "the route is not a constant, or no pairs of port and address: write where it goes",
            );
            return String::new();
        };
        let path = |hops: &[(String, String)]| {
            let mut path = format!("4,{host}");
            for (port, link) in hops {
                // Writing to a String cannot fail.
                let _ = write!(path, ",{port},{link}");
            }
            path
        };
        if !connected && !wrapped && given_route(self.given.get("route_path")) {
            // What the library does when nobody says route_path=False.
            let bytes = path(&route).parse::<TargetPath>().map(|path| path.route.bytes()).unwrap_or_default();
            let words = u8::try_from(bytes.len() / 2).unwrap_or(u8::MAX);
            data.extend([words, 0]);
            data.extend(&bytes);
            self.told(
                Severity::Warning,
                "without unconnected_send and route_path=False, pycomm3 appends the route to the request: these bytes are \
                 at the end of ReqData",
            );
            return path(&[]);
        }
        if wrapped && route.is_empty() {
            self.told(
                Severity::Warning,
                "Unconnected_Send without a route: cipdeck sends the request itself",
            );
        }
        path(&route)
    }

    fn number(&mut self, name: &'static str, is_needed: bool) -> i64 {
        match self.given.get(name) {
            Some(Some(Value::Number(number))) => *number,
            // `b"\x0e"` is one number, too.
            Some(Some(Value::Bytes(bytes))) if bytes.len() == 1 => {
                bytes.first().copied().map_or(0, i64::from)
            }
            Some(Some(Value::Bytes(bytes))) if bytes.is_empty() && !is_needed => 0,
            Some(_) => {
                self.say(Severity::Error, RemarkKind::NotConstant(name.to_string()));
                0
            }
            None => {
                if is_needed {
                    self.say(Severity::Error, RemarkKind::Missing(name.to_string()));
                }
                0
            }
        }
    }

    fn bytes(&mut self, name: &'static str) -> Vec<u8> {
        match self.given.get(name) {
            Some(Some(Value::Bytes(bytes))) => bytes.clone(),
            None => Vec::new(),
            Some(_) => {
                self.say(Severity::Error, RemarkKind::NotConstant(name.to_string()));
                Vec::new()
            }
        }
    }

    fn flag(&mut self, name: &'static str, usual: bool) -> bool {
        match self.given.get(name) {
            Some(Some(Value::Bool(flag))) => *flag,
            None => usual,
            Some(_) => {
                self.say(Severity::Error, RemarkKind::NotConstant(name.to_string()));
                usual
            }
        }
    }

    fn told(&mut self, severity: Severity, words: &str) {
        self.say(severity, RemarkKind::Told(words.to_string()));
    }

    fn say(&mut self, severity: Severity, what: RemarkKind) {
        let (line, column) = self.statement.first().map_or((1, 1), |first| (first.line, first.column));
        let excerpt: String = self.statement.iter().take(8).map(|token| token.text).collect();
        self.remarks.push(Remark { severity, ..Remark::error(line, column, &excerpt, what) });
    }
}

/// Whether the library puts a route somewhere.
fn given_route(route: Option<&Option<Value>>) -> bool {
    !matches!(route, Some(Some(Value::Bool(false))))
        && !matches!(route, Some(Some(Value::Bytes(bytes))) if bytes.is_empty())
}

/// `10.0.0.1/1/0`: the host, and the hops.
fn parts(path: &str, auto_slot: bool) -> (String, Option<Vec<(String, String)>>) {
    let parts: Vec<&str> = path.split(['/', '\\', ',']).map(str::trim).collect();
    let (host, rest) = parts.split_first().map_or(("", &[][..]), |(host, rest)| (*host, rest));
    let backplane = |slot: &str| alloc::vec![("1".to_string(), slot.to_string())];
    let route = match rest {
        [] if auto_slot => Some(backplane("0")),
        [slot] if auto_slot => Some(backplane(slot)),
        rest => hops(rest),
    };
    (host.to_string(), route)
}

/// Pairs of a port and an address; ports have names as in `PortSegment`.
fn hops(parts: &[&str]) -> Option<Vec<(String, String)>> {
    let pairs = parts.chunks(2).map(|pair| {
        let [port, link] = pair else { return None };
        let port = match port.trim() {
            "bp" | "backplane" => "1",
            "enet" | "dnet" | "cnet" | "dhrio-a" | "dh485-a" => "2",
            "dhrio-b" | "dh485-b" => "3",
            port => port,
        };
        Some((port.to_string(), link.trim().to_string()))
    });
    pairs.collect()
}

/// Finished bytes: size in words, a pad, the route.
fn encoded(bytes: &[u8]) -> Option<Vec<(String, String)>> {
    let Some((_, route)) = bytes.split_at_checked(2) else { return Some(Vec::new()) };
    let route = Epath::decode(route).ok()?;
    let hop = |segment: &Segment| match segment {
        Segment::Port(port) => Some((port.port().to_string(), link(port))),
        _ => None,
    };
    route.segments().iter().map(hop).collect()
}
