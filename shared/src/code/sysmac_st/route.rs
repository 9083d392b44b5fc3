//! Route paths: `02\192.168.250.2\01\#00`. 02 is an Ethernet port, 01 the backplane; `#` marks a hexadecimal number.

use alloc::format;
use alloc::string::{String, ToString};

use crate::config::{Endpoint, Host, Target, TargetPath};
use crate::wire::Segment;

const ETHERNET: u16 = 2;
const BACKPLANE: u16 = 1;

/// Of a path; the second is false if not all hops can be told.
pub(super) fn write(path: &TargetPath) -> (String, bool) {
    let host = match &path.target {
        Target::BuiltIn => "0.0.0.0".to_string(),
        Target::Network(Endpoint { host, .. }) => host.to_string(),
    };
    let mut text = format!("02\\{host}");
    let mut whole = true;
    for segment in path.route.segments() {
        let hop = match segment {
            Segment::Port(hop) if hop.port() == BACKPLANE => {
                hop.slot().map(|slot| format!("\\01\\#{slot:02X}"))
            }
            Segment::Port(hop) if hop.port() == ETHERNET => hop.address().map(|it| format!("\\02\\{it}")),
            _ => None,
        };
        whole &= hop.is_some();
        text.push_str(&hop.unwrap_or_default());
    }
    (text, whole)
}

/// The `Path` of a route path.
pub(super) fn read(text: &str) -> Option<String> {
    let mut parts = text.split('\\').map(str::trim);
    let (kind, address) = (parts.next()?, parts.next()?);
    if number(kind)? != ETHERNET || address.is_empty() || address.starts_with('#') {
        return None;
    }
    let ip = address.parse::<core::net::Ipv4Addr>().map(|ip| Host::Ip(ip.octets()));
    let mut path = match ip {
        Ok(Host::Ip([0, 0, 0, 0])) => "0,0".to_string(),
        _ => format!("4,{address}"),
    };
    while let Some(kind) = parts.next() {
        let address = parts.next()?;
        let hop = match number(kind)? {
            BACKPLANE => format!(",1,{}", number(address)?),
            ETHERNET => format!(",2,{}", address.parse::<core::net::Ipv4Addr>().ok()?),
            _ => return None,
        };
        path.push_str(&hop);
    }
    Some(path)
}

/// `01`, `#0A`.
fn number(text: &str) -> Option<u16> {
    match text.strip_prefix('#') {
        Some(digits) => u16::from_str_radix(digits, 16).ok(),
        None => text.parse().ok(),
    }
}
