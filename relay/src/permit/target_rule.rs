//! One line of the list of targets: an address, a network or a name, a port, and a route.

use std::fmt;
use std::net::IpAddr;
use std::str::FromStr;

use cipdeck_shared::config::{Endpoint, Host, TargetPath};
use cipdeck_shared::wire::Epath;
use ipnet::IpNet;

/// `192.168.1.10`, `192.168.1.0/24` or `plc-4.plant.local`; then `:44820` or `:*`, 44818 when left out; then
/// ` via 1,0` or ` via *`, no route when left out.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct TargetRule {
    host: RuleHost,
    /// `None` = any.
    port: Option<u16>,
    /// `None` = any.
    route: Option<Route>,
}

#[derive(Clone, Debug, PartialEq, Eq)]
enum RuleHost {
    /// Exactly this one: names even an address that a network never covers.
    Address(IpAddr),
    Network(IpNet),
    /// In lower case.
    Name(String),
}

#[derive(Clone, Debug, PartialEq, Eq)]
struct Route {
    text: String,
    path: Epath,
}

/// Why a line is no rule.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "{text:?} is no target: {why}. Write an address (192.168.1.10), a network (192.168.1.0/24) or a name, if needed with :PORT or :*, and with \" via 1,0\" or \" via *\" for what lies behind it"
)]
pub(crate) struct RuleError {
    text: String,
    why: &'static str,
}

const DEFAULT_PORT: u16 = 44_818;

impl TargetRule {
    /// Whether the rule names this endpoint and this route. For an address of a special kind see [`Self::names`].
    pub(crate) fn covers(&self, endpoint: &Endpoint, route: &Epath) -> bool {
        self.covers_endpoint(endpoint) && self.route.as_ref().is_none_or(|own| own.path == *route)
    }

    /// Whether the rule names this endpoint, whatever the route.
    pub(crate) fn covers_endpoint(&self, endpoint: &Endpoint) -> bool {
        let host = match (&self.host, &endpoint.host) {
            (RuleHost::Address(own), Host::Ip(ip)) => *own == IpAddr::from(*ip),
            (RuleHost::Network(own), Host::Ip(ip)) => own.contains(&IpAddr::from(*ip)),
            (RuleHost::Name(own), Host::Name(name)) => own.eq_ignore_ascii_case(name),
            _ => false,
        };
        host && self.port.is_none_or(|port| port == endpoint.port)
    }

    /// Whether the rule means this very address: needed for loopback and other addresses that are no plant's.
    pub(crate) fn names(&self, address: IpAddr, port: u16) -> bool {
        self.host == RuleHost::Address(address) && self.port.is_none_or(|own| own == port)
    }

    /// The name, in lower case, if it names one.
    pub(super) fn name(&self) -> Option<&str> {
        match &self.host {
            RuleHost::Name(name) => Some(name),
            RuleHost::Address(_) | RuleHost::Network(_) => None,
        }
    }

    /// Whether it does so with this very port, and not with any.
    pub(crate) fn names_port(&self, address: IpAddr, port: u16) -> bool {
        self.names(address, port) && self.port.is_some()
    }
}

impl FromStr for TargetRule {
    type Err = RuleError;

    fn from_str(text: &str) -> Result<Self, RuleError> {
        let error = |why| RuleError { text: text.to_owned(), why };
        let (endpoint, route) = match text.trim().split_once(char::is_whitespace) {
            None => (text.trim(), Some(Route { text: String::new(), path: Epath::default() })),
            Some((endpoint, rest)) => {
                let route = rest.trim().strip_prefix("via").map(str::trim);
                (
                    endpoint,
                    parse_route(route.ok_or_else(|| error("after the address only \" via …\" may follow"))?)
                        .map_err(error)?,
                )
            }
        };
        let (host, port) = match endpoint.rsplit_once(':') {
            None => (endpoint, Some(DEFAULT_PORT)),
            Some((host, "*")) => (host, None),
            Some((host, port)) => match port.parse() {
                Ok(0) | Err(_) => return Err(error("the port is no number from 1 to 65535")),
                Ok(port) => (host, Some(port)),
            },
        };
        Ok(Self { host: parse_host(host).map_err(error)?, port, route })
    }
}

fn parse_host(text: &str) -> Result<RuleHost, &'static str> {
    if let Ok(address) = text.parse() {
        return Ok(RuleHost::Address(address));
    }
    if text.contains('/') {
        let network: IpNet = text.parse().map_err(|_| "the network cannot be read")?;
        if network.addr() != network.network() {
            return Err("the network has bits set behind its length");
        }
        return Ok(RuleHost::Network(network));
    }
    let is_name = !text.is_empty()
        && text.len() <= 253
        && text.bytes().all(|byte| byte.is_ascii_alphanumeric() || matches!(byte, b'-' | b'.' | b'_'))
        // Digits and dots alone are a mistyped address.
        && text.bytes().any(|byte| byte.is_ascii_alphabetic());
    if is_name { Ok(RuleHost::Name(text.to_ascii_lowercase())) } else { Err("the address cannot be read") }
}

/// `*` is any route.
fn parse_route(text: &str) -> Result<Option<Route>, &'static str> {
    if text == "*" {
        return Ok(None);
    }
    // The hops are read by the code that reads a block's Path.
    let path: TargetPath = format!("4,192.0.2.1,{text}").parse().map_err(|_| "the route cannot be read")?;
    Ok(Some(Route { text: text.to_owned(), path: path.route }))
}

impl fmt::Display for TargetRule {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.host {
            RuleHost::Address(address) => write!(f, "{address}")?,
            RuleHost::Network(network) => write!(f, "{network}")?,
            RuleHost::Name(name) => f.write_str(name)?,
        }
        match self.port {
            Some(DEFAULT_PORT) => {}
            Some(port) => write!(f, ":{port}")?,
            None => f.write_str(":*")?,
        }
        match &self.route {
            None => f.write_str(" via *"),
            Some(route) if route.text.is_empty() => Ok(()),
            Some(route) => write!(f, " via {}", route.text),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn covers(rule: &str, path: &str) -> bool {
        let rule: TargetRule = rule.parse().unwrap();
        let path: TargetPath = path.parse().unwrap();
        let cipdeck_shared::config::Target::Network(endpoint) = &path.target else { panic!("{path:?}") };
        rule.covers(endpoint, &path.route)
    }

    #[test]
    fn a_rule_covers_what_it_says_and_nothing_else() {
        for (rule, path, expected) in [
            ("192.168.1.10", "4,192.168.1.10", true),
            ("192.168.1.10", "4,192.168.1.11", false),
            ("192.168.1.10", "4,192.168.1.10:44820", false),
            ("192.168.1.10", "4,192.168.1.10,1,0", false),
            ("192.168.1.10:*", "4,192.168.1.10:44820", true),
            ("192.168.1.10:44820", "4,192.168.1.10", false),
            ("192.168.1.0/24", "4,192.168.1.11", true),
            ("192.168.1.0/24", "4,192.168.2.11", false),
            ("192.168.1.10 via 1,0", "4,192.168.1.10,1,0", true),
            ("192.168.1.10 via 1,0", "4,192.168.1.10,1,1", false),
            ("192.168.1.10 via 1,0", "4,192.168.1.10", false),
            ("192.168.1.10 via *", "4,192.168.1.10,1,1", true),
            ("192.168.1.10 via *", "4,192.168.1.10", true),
            ("PLC-4.plant", "4,plc-4.PLANT", true),
            ("plc-4", "4,192.168.1.10", false),
        ] {
            assert_eq!(covers(rule, path), expected, "{rule} and {path}");
        }
    }

    #[test]
    fn a_rule_is_shown_in_one_spelling_that_is_the_same_rule() {
        for (text, shown) in [
            (" 192.168.1.10:44818 ", "192.168.1.10"),
            ("192.168.1.0/24:* via *", "192.168.1.0/24:* via *"),
            ("Plc.Local:2222  via  1,0", "plc.local:2222 via 1,0"),
        ] {
            let rule: TargetRule = text.parse().unwrap();
            assert_eq!(rule.to_string(), shown);
            assert_eq!(shown.parse::<TargetRule>().unwrap(), rule);
        }
    }

    #[test]
    fn what_is_no_rule_says_why() {
        for text in [
            "",
            "192.168.1",
            "192.168.1.256",
            "192.168.1.1/24",
            "10.0.0.0/33",
            "a:0",
            "a:70000",
            "a via",
            "a by 1,0",
            "a via 1",
            "*",
            "a b",
        ] {
            let error = text.parse::<TargetRule>().unwrap_err().to_string();
            assert!(error.contains("is no target"), "{error}");
        }
    }
}
