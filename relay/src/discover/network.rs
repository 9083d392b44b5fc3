//! The networks that this machine is part of.

use std::io;
use std::net::Ipv4Addr;

use if_addrs::IfAddr;

/// One IPv4 address of the machine and the network around it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Network {
    /// The machine's address in it.
    pub(super) own: Ipv4Addr,
    /// The bits that all addresses in it share.
    pub(super) mask: Ipv4Addr,
    /// Everybody in it, if it can be asked so.
    pub(super) broadcast: Option<Ipv4Addr>,
}

impl Network {
    /// All of them.
    pub(super) fn own() -> io::Result<Vec<Self>> {
        let interfaces = if_addrs::get_if_addrs()?;
        Ok(interfaces.into_iter().filter_map(|interface| Self::of(&interface.addr)).collect())
    }

    fn of(address: &IfAddr) -> Option<Self> {
        let IfAddr::V4(address) = address else { return None };
        let mut network = Self { own: address.ip, mask: address.netmask, broadcast: address.broadcast };
        if network.own.is_loopback() {
            // Systems do not always say it.
            network.broadcast = Some(network.last());
        }
        if network.mask.to_bits().count_zeros() < 2 {
            // A line between two ends, or a single address.
            network.broadcast = None;
        }
        Some(network)
    }

    /// Whether an address is in this network.
    pub(super) fn contains(&self, address: Ipv4Addr) -> bool {
        let mask = self.mask.to_bits();
        address.to_bits() & mask == self.own.to_bits() & mask
    }

    /// The network itself: once, everybody in it.
    pub(super) fn first(&self) -> Ipv4Addr {
        Ipv4Addr::from_bits(self.own.to_bits() & self.mask.to_bits())
    }

    /// The address with all other bits set.
    pub(super) fn last(&self) -> Ipv4Addr {
        Ipv4Addr::from_bits(self.own.to_bits() | !self.mask.to_bits())
    }
}
