//! Where a question may go.

use std::net::{Ipv4Addr, SocketAddrV4};

use super::network::Network;

/// UDP and TCP port of explicit messages.
pub(crate) const EXPLICIT_PORT: u16 = 44_818;

/// Where a question goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Destination {
    /// To one device.
    Device(SocketAddrV4),
    /// To everybody in one of the machine's own networks.
    Network {
        /// The machine's address in it.
        from: Ipv4Addr,
        /// Its broadcast address.
        to: SocketAddrV4,
    },
}

/// Why an address is not asked.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub(crate) enum AddressError {
    /// Not `ADDRESS` or `ADDRESS:PORT`.
    #[error("{0:?} is not an IPv4 address, with or without a port: 192.168.1.100 or 192.168.1.100:44818")]
    Unreadable(String),
    /// Nobody has this address.
    #[error("{0} is not the address of a device")]
    Nobody(Ipv4Addr),
    /// A group, not a device.
    #[error("{0} is a multicast address: discovery asks devices, or the machine's own networks")]
    Multicast(Ipv4Addr),
    /// The broadcast address of somebody else's network.
    #[error(
        "{0} is a broadcast address, but not of one of this machine's own networks: without an address all of those \
         are asked"
    )]
    ForeignBroadcast(Ipv4Addr),
}

impl Destination {
    /// Everybody in a network, except on this machine alone.
    pub(super) fn everybody(network: &Network) -> Option<Self> {
        let to = network.broadcast.filter(|_| !network.own.is_loopback())?;
        Some(Self::Network { from: network.own, to: SocketAddrV4::new(to, EXPLICIT_PORT) })
    }

    /// The address, if it is not the usual port of somebody in a network that this machine shares with others.
    pub(super) fn elsewhere(&self, networks: &[Network]) -> Option<SocketAddrV4> {
        let (Self::Device(to) | Self::Network { to, .. }) = self;
        let is_near = networks.iter().any(|network| !network.own.is_loopback() && network.contains(*to.ip()));
        (!is_near || to.port() != EXPLICIT_PORT).then_some(*to)
    }

    /// Reads an address and judges it by the networks that the machine is part of.
    pub(super) fn parse(text: &str, networks: &[Network]) -> Result<Self, AddressError> {
        let address = text
            .parse::<SocketAddrV4>()
            .or_else(|_| text.parse().map(|ip| SocketAddrV4::new(ip, EXPLICIT_PORT)))
            .ok()
            .filter(|address| address.port() != 0)
            .ok_or_else(|| AddressError::Unreadable(text.to_owned()))?;
        let ip = *address.ip();
        if let Some(network) = networks.iter().find(|network| network.broadcast == Some(ip)) {
            return Ok(Self::Network { from: network.own, to: address });
        }
        let own = networks.iter().find(|network| network.contains(ip));
        match (ip.octets(), own) {
            ([224..=239, ..], _) => Err(AddressError::Multicast(ip)),
            ([255, 255, 255, 255], _) => Err(AddressError::ForeignBroadcast(ip)),
            ([0 | 240.., ..], _) => Err(AddressError::Nobody(ip)),
            // Once the network's own address meant everybody in it, and some devices still think so.
            (_, Some(network)) if network.broadcast.is_some() && network.first() == ip => {
                Err(AddressError::ForeignBroadcast(ip))
            }
            // Nobody here knows where a foreign network ends. A device with 255 at the end is rare, a network that
            // ends there is not.
            ([.., 255], None) => Err(AddressError::ForeignBroadcast(ip)),
            _ => Ok(Self::Device(address)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn network(own: [u8; 4], mask: [u8; 4]) -> Network {
        let network = Network { own: own.into(), mask: mask.into(), broadcast: None };
        Network { broadcast: Some(network.last()), ..network }
    }

    fn networks() -> Vec<Network> {
        vec![
            network([127, 0, 0, 1], [255, 0, 0, 0]),
            network([192, 168, 1, 5], [255, 255, 255, 0]),
            network([10, 4, 2, 9], [255, 255, 252, 0]),
        ]
    }

    fn parse(text: &str) -> Result<Destination, AddressError> {
        Destination::parse(text, &networks())
    }

    #[test]
    fn what_is_not_the_usual_port_of_a_neighbour_is_elsewhere() {
        for (text, is_elsewhere) in [
            ("192.168.1.100", false),
            ("192.168.1.255", false),
            ("192.168.1.100:19", true),
            ("192.168.1.255:19", true),
            ("172.16.0.9", true),
            ("127.0.0.1", true),
        ] {
            assert_eq!(parse(text).unwrap().elsewhere(&networks()).is_some(), is_elsewhere, "{text}");
        }
    }

    #[test]
    fn devices_anywhere_may_be_asked() {
        for (text, expected) in [
            ("192.168.1.100", "192.168.1.100:44818"),
            ("172.16.0.9:44820", "172.16.0.9:44820"),
            ("127.0.0.1", "127.0.0.1:44818"),
            // In the middle of a network of ours.
            ("10.4.1.255", "10.4.1.255:44818"),
            ("10.4.1.0", "10.4.1.0:44818"),
        ] {
            assert_eq!(parse(text), Ok(Destination::Device(expected.parse().unwrap())), "{text}");
        }
    }

    #[test]
    fn own_networks_are_asked_from_our_address_in_them() {
        for (text, from, to) in [
            ("192.168.1.255", [192, 168, 1, 5], "192.168.1.255:44818"),
            ("10.4.3.255:44820", [10, 4, 2, 9], "10.4.3.255:44820"),
            ("127.255.255.255", [127, 0, 0, 1], "127.255.255.255:44818"),
        ] {
            let expected = Destination::Network { from: from.into(), to: to.parse().unwrap() };
            assert_eq!(parse(text), Ok(expected), "{text}");
        }
        let everybody: Vec<_> = networks().iter().filter_map(Destination::everybody).collect();
        assert_eq!(everybody.len(), 2, "not on the loopback interface");
    }

    #[test]
    fn broadcasts_to_others_are_refused() {
        for text in [
            "255.255.255.255",
            "192.168.2.255",
            "10.255.255.255",
            "192.168.1.0",
            "10.4.0.0",
            "172.31.255.255",
        ] {
            let ip = text.parse().unwrap();
            assert_eq!(parse(text), Err(AddressError::ForeignBroadcast(ip)), "{text}");
        }
        assert!(parse("192.168.2.255").unwrap_err().to_string().contains("this machine's own networks"));
        assert_eq!(parse("239.192.1.1"), Err(AddressError::Multicast([239, 192, 1, 1].into())));
        for text in ["0.0.0.0", "0.1.2.3", "240.0.0.1", "255.1.1.1"] {
            assert_eq!(parse(text), Err(AddressError::Nobody(text.parse().unwrap())), "{text}");
        }
    }

    #[test]
    fn what_is_no_address_is_said_back() {
        for text in [
            "",
            "drive",
            "192.168.1",
            "192.168.1.300",
            "192.168.1.1:0",
            "192.168.1.1:70000",
            "[::1]:44818",
            "::1",
        ] {
            assert_eq!(parse(text), Err(AddressError::Unreadable(text.to_owned())));
        }
    }
}
