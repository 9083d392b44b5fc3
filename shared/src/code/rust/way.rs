//! Where messages go, as far as a program has said so.

use alloc::string::{String, ToString};
use alloc::vec::Vec;

use super::super::program::{Names, Token, Value, groups, value};

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

/// The way of the messages that come next.
#[derive(Clone, Debug, Default)]
pub(super) struct Way {
    pub(super) name: Option<String>,
    pub(super) host: Option<String>,
    pub(super) hops: Vec<(i64, String)>,
    pub(super) connected: bool,
    /// ms, in the order in which they are named.
    pub(super) timeouts: Vec<i64>,
}

/// One thing that is said about a way.
#[derive(Debug)]
pub(super) enum Said {
    Name(String),
    Host(String),
    Hop(i64, String),
    Connected,
    Timeout(i64),
}

impl Way {
    pub(super) fn add(&mut self, said: Said) {
        match said {
            Said::Name(name) => self.name = Some(name),
            Said::Host(host) => self.host = Some(host),
            Said::Hop(port, link) => self.hops.push((port, link)),
            Said::Connected => self.connected = true,
            Said::Timeout(ms) => self.timeouts.push(ms),
        }
    }
}

/// What the tokens from here on say about a way.
pub(super) fn said(rest: &[Token<'_>], names: &Names) -> Option<Said> {
    let first = rest.first().filter(|first| WAYS.contains(&first.text))?;
    let (arguments, _) = match rest.get(1) {
        Some(open) if open.is("(") || open.is("{") => groups(rest.get(1..).unwrap_or_default()),
        _ => (Vec::new(), 0),
    };
    let argument = |position: usize| arguments.get(position).and_then(|tokens| value(tokens, names));
    match (first.text, argument(0), argument(1)) {
        ("connect" | "new_host_lookup", Some(Value::Text(host)), _) => Some(Said::Host(host)),
        ("from_millis", Some(Value::Number(ms)), _) => Some(Said::Timeout(ms)),
        ("from_secs", Some(Value::Number(seconds)), _) => Some(Said::Timeout(seconds.saturating_mul(1_000))),
        ("with_port_slot", Some(Value::Number(port)), Some(Value::Number(slot))) => {
            Some(Said::Hop(port, slot.to_string()))
        }
        ("with_port", Some(Value::Number(port)), _) => Some(Said::Hop(port, "0".to_string())),
        ("PortSegment", ..) if rest.get(3).is_some_and(|token| token.is("default")) => {
            Some(Said::Hop(1, "0".to_string()))
        }
        ("PortSegment", ..) => segment(&arguments, names),
        ("EipConnection" | "AbEipConnection", ..) => Some(Said::Connected),
        _ => None,
    }
}

/// `PortSegment { port: 1, link: vec![0].into() }`, with `b"…".to_vec().into()` as well.
fn segment(arguments: &[&[Token<'_>]], names: &Names) -> Option<Said> {
    let member = |name: &str| {
        arguments.iter().find_map(|argument| match argument {
            [it, colon, rest @ ..] if it.is(name) && colon.is(":") => Some(rest),
            _ => None,
        })
    };
    let link = member("link")?;
    let end = link.iter().position(|token| token.is(".")).unwrap_or(link.len());
    let (Value::Number(port), Value::Bytes(link)) =
        (value(member("port")?, names)?, value(link.get(..end)?, names)?)
    else {
        return None;
    };
    let link = match link.as_slice() {
        [slot] => slot.to_string(),
        text => String::from_utf8_lossy(text).into_owned(),
    };
    Some(Said::Hop(port, link))
}
