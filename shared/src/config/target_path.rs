//! `TargetCfg.Path`: `"<port>,<node or slot>"` once or twice. 2080-RM001D p. 182. A third hop, which a controller does
//! not take, is read as well.

use alloc::string::String;
use core::fmt;
use core::str::FromStr;

use crate::wire::{Epath, PortSegment, Segment};

/// `STRING[80]`.
pub const MAX_PATH: usize = 80;

/// The controller's embedded Ethernet port.
const ETHERNET: &str = "4";

/// TCP port of explicit messages when the path names none.
pub(super) const DEFAULT_TCP_PORT: u16 = 44818;

/// Hops of the controller's own `Path`. 2080-RM001D p. 182.
pub const CONTROLLER_HOPS: usize = 2;

/// Hops behind the TCP endpoint that we take.
const MAX_ROUTE_HOPS: usize = 2;

/// A readable path.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TargetPath {
    /// Where the TCP connection goes.
    pub target: Target,
    /// The hops behind the TCP endpoint: port segments only, none for the endpoint itself.
    pub route: Epath,
}

impl TargetPath {
    /// How many hops the path has, the TCP endpoint included.
    pub fn hops(&self) -> usize {
        1 + self.route.segments().len()
    }
}

/// Where messages go.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Target {
    /// `0,0`: the built-in simulated device.
    BuiltIn,
    /// A device on the network.
    Network(Endpoint),
}

/// An address and a TCP port.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Endpoint {
    /// IP address or name.
    pub host: Host,
    /// TCP port; a controller always uses 44818.
    pub port: u16,
}

/// The address part of an endpoint.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Host {
    /// IPv4.
    Ip([u8; 4]),
    /// A name to be resolved; a controller takes addresses only.
    Name(String),
}

impl Endpoint {
    /// An address at the port that a controller uses.
    pub const fn of_ip(ip: [u8; 4]) -> Self {
        Self { host: Host::Ip(ip), port: DEFAULT_TCP_PORT }
    }

    /// Whether the path gave a TCP port of its own.
    pub const fn has_unusual_port(&self) -> bool {
        self.port != DEFAULT_TCP_PORT
    }
}

/// Why a path cannot be used.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PathError {
    /// Nothing was typed.
    Empty,
    /// Over 80 characters.
    TooLong,
    /// An odd number of parts: a port without its address.
    HalfHop,
    /// More than three hops, or a third one that does not leave the chassis.
    TooManyHops,
    /// The first port is a serial port (2, 5..=9).
    SerialPort,
    /// The first port is none of the controller's.
    BadPort,
    /// The first address is not an IPv4 address, a name or either with a TCP port.
    BadAddress,
    /// The port of a further hop is not 1..=65535.
    BadRoutePort,
    /// The address of a further hop is neither a slot 0..=255 nor an IPv4 address; the backplane has slots only.
    BadSlot,
}

impl FromStr for TargetPath {
    type Err = PathError;

    fn from_str(text: &str) -> Result<Self, PathError> {
        if text.trim().is_empty() {
            return Err(PathError::Empty);
        }
        if text.chars().count() > MAX_PATH {
            return Err(PathError::TooLong);
        }
        let mut parts = text.split(',').map(str::trim);
        let (port, node) = (parts.next().unwrap_or_default(), parts.next().ok_or(PathError::HalfHop)?);
        let target = first_hop(port, node)?;
        let mut route = Epath::default();
        while let Some(port) = parts.next() {
            let address = parts.next().ok_or(PathError::HalfHop)?;
            let hop = further_hop(port, address)?;
            if route.segments().len() == MAX_ROUTE_HOPS || stays_in_the_chassis(&route, &hop) {
                return Err(PathError::TooManyHops);
            }
            route = route.hop(hop);
        }
        Ok(Self { target, route })
    }
}

impl fmt::Display for Target {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::BuiltIn => f.write_str("0,0"),
            Self::Network(endpoint) => write!(f, "{endpoint}"),
        }
    }
}

impl fmt::Display for Endpoint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}", self.host, self.port)
    }
}

impl fmt::Display for Host {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Ip(ip) => write!(f, "{}", core::net::Ipv4Addr::from(*ip)),
            Self::Name(name) => f.write_str(name),
        }
    }
}

fn first_hop(port: &str, node: &str) -> Result<Target, PathError> {
    match (port, node) {
        ("0", "0") => Ok(Target::BuiltIn),
        (ETHERNET, address) => endpoint(address).map(Target::Network).ok_or(PathError::BadAddress),
        ("2" | "5" | "6" | "7" | "8" | "9", _) => Err(PathError::SerialPort),
        _ => Err(PathError::BadPort),
    }
}

fn endpoint(address: &str) -> Option<Endpoint> {
    let (host, port) = match address.split_once(':') {
        Some((host, port)) => (host, port.parse().ok().filter(|port| *port != 0)?),
        None => (address, DEFAULT_TCP_PORT),
    };
    // Digits and dots only are meant as an address: a typo in one must not become a name.
    let host = if host.bytes().all(|b| b.is_ascii_digit() || b == b'.') {
        Host::Ip(host.parse::<core::net::Ipv4Addr>().ok()?.octets())
    } else {
        // One target however it is spelled: it gets one message at a time.
        Host::Name(host_name(host)?.to_ascii_lowercase())
    };
    Some(Endpoint { host, port })
}

fn host_name(name: &str) -> Option<&str> {
    let label = |label: &str| {
        (1..=63).contains(&label.len())
            && label.bytes().all(|b| b.is_ascii_alphanumeric() || b == b'-' || b == b'_')
            && !label.starts_with('-')
    };
    name.split('.').all(label).then_some(name)
}

fn further_hop(port: &str, address: &str) -> Result<PortSegment, PathError> {
    let port: u16 = port.parse().map_err(|_| PathError::BadRoutePort)?;
    let hop = match (address.parse::<u8>(), address.parse::<core::net::Ipv4Addr>()) {
        (Ok(slot), _) => PortSegment::new(port, slot),
        (Err(_), Ok(ip)) if port != BACKPLANE => {
            PortSegment::with_address(port, alloc::format!("{ip}").as_bytes())
        }
        _ => return Err(PathError::BadSlot),
    };
    hop.ok_or(PathError::BadRoutePort)
}

/// From backplane to backplane: a module's port 1 is the backplane that the message came over.
fn stays_in_the_chassis(route: &Epath, hop: &PortSegment) -> bool {
    let from = route.segments().last();
    hop.port() == BACKPLANE && matches!(from, Some(Segment::Port(from)) if from.port() == BACKPLANE)
}

/// The port of a chassis; what is behind it has slot numbers.
const BACKPLANE: u16 = 1;

#[cfg(test)]
mod tests {
    use super::*;
    use alloc::vec;

    #[test]
    fn the_manuals_examples_are_read() {
        let direct: TargetPath = "4,192.168.1.100".parse().unwrap();
        let endpoint = Endpoint { host: Host::Ip([192, 168, 1, 100]), port: 44818 };
        assert_eq!(direct, TargetPath { target: Target::Network(endpoint.clone()), route: Epath::default() });
        let routed: TargetPath = "4,192.168.1.100,1,0".parse().unwrap();
        assert_eq!((routed.target, routed.route.bytes()), (Target::Network(endpoint), vec![1, 0]));
        assert_eq!("0,0".parse::<TargetPath>().unwrap().target, Target::BuiltIn);
        assert_eq!("6,1".parse::<TargetPath>(), Err(PathError::SerialPort));
    }

    #[test]
    fn further_hops_are_slots_addresses_and_extended_ports() {
        for (text, hops, bytes) in [
            ("4,10.0.0.1,2,192.168.1.55", 2, &b"\x12\x0C192.168.1.55"[..]),
            ("4,10.0.0.1,18,10.0.0.20", 2, b"\x1F\x09\x12\x0010.0.0.20\0"),
            ("4,10.0.0.1, 1, 3, 2, 192.168.1.100", 3, b"\x01\x03\x12\x0D192.168.1.100\0"),
        ] {
            let path: TargetPath = text.parse().unwrap();
            assert_eq!((path.hops(), path.route.bytes()), (hops, bytes.to_vec()), "{text}");
        }
    }

    #[test]
    fn a_name_and_a_tcp_port_are_read() {
        let path: TargetPath = " 4 , drive-3.line.local:44820 ".parse().unwrap();
        let Target::Network(endpoint) = path.target else { panic!("a network target") };
        assert_eq!((endpoint.host, endpoint.port), (Host::Name("drive-3.line.local".into()), 44820));
    }

    #[test]
    fn a_name_is_the_same_target_however_it_is_spelled() {
        assert_eq!("4,PLC-3.Line".parse::<TargetPath>(), "4,plc-3.line".parse());
    }

    #[test]
    fn what_cannot_be_used_says_why() {
        let long = alloc::format!("4,{}", "a".repeat(79));
        for (text, error) in [
            ("", PathError::Empty),
            ("  ", PathError::Empty),
            (long.as_str(), PathError::TooLong),
            ("4", PathError::HalfHop),
            ("4,10.0.0.1,1", PathError::HalfHop),
            ("4,10.0.0.1,1,0,2,10.0.0.2,1,0", PathError::TooManyHops),
            ("4,10.0.0.1,1,0,1,0", PathError::TooManyHops),
            ("4,10.0.0.1,1,0,2", PathError::HalfHop),
            ("2,1", PathError::SerialPort),
            ("3,10.0.0.1", PathError::BadPort),
            ("0,1", PathError::BadPort),
            ("4,", PathError::BadAddress),
            ("4,10.0.0.256", PathError::BadAddress),
            ("4,10.0.0.1:0", PathError::BadAddress),
            ("4,10.0.0.1:70000", PathError::BadAddress),
            ("4,a b", PathError::BadAddress),
            ("4,10.0.0.1,0,0", PathError::BadRoutePort),
            ("4,10.0.0.1,65536,0", PathError::BadRoutePort),
            ("4,10.0.0.1,1,x", PathError::BadSlot),
            ("4,10.0.0.1,1,256", PathError::BadSlot),
            ("4,10.0.0.1,1,10.0.0.2", PathError::BadSlot),
            ("4,10.0.0.1,2,10.0.0.256", PathError::BadSlot),
        ] {
            assert_eq!(text.parse::<TargetPath>(), Err(error), "{text}");
        }
    }
}
