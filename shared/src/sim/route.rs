//! Routes through the chassis, one hop after the other, as bridges check them.

use crate::wire::{PortSegment, Reader, Segment};

use super::module::{BACKPLANE, ETHERNET, SimModule};
use super::objects::Objects;

/// Why a route does not lead on: the additional status word, and how many words of the path were left.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Stuck {
    pub(super) status: u16,
    pub(super) remaining: u8,
}

/// Unconnected request timed out: nobody answers on the network.
pub(super) const TIMED_OUT: u16 = 0x0204;

const PORT_NOT_AVAILABLE: u16 = 0x0311;
const LINK_ADDRESS_NOT_VALID: u16 = 0x0312;
pub(super) const INVALID_SEGMENT: u16 = 0x0315;
const LINK_ADDRESS_TO_SELF: u16 = 0x0318;

/// Follows the port segments at the front of a path; the reader stops at the first other segment. Each hop eats at
/// least one word, so a route has at most 255.
pub(super) fn follow(modules: &[Objects], from: usize, path: &mut Reader<'_>) -> Result<usize, Stuck> {
    let mut here = from;
    while is_port_segment(path) {
        let stuck = |status| Stuck { status, remaining: words(path) };
        let mut reader = path.clone();
        let Ok(Segment::Port(hop)) = Segment::read(&mut reader) else { return Err(stuck(INVALID_SEGMENT)) };
        here = step(modules, here, &hop).map_err(stuck)?;
        *path = reader;
    }
    Ok(here)
}

/// How many words are left.
pub(super) fn words(path: &Reader<'_>) -> u8 {
    u8::try_from(path.remaining() / 2).unwrap_or(u8::MAX)
}

/// The top three bits of a port segment are 0.
fn is_port_segment(path: &Reader<'_>) -> bool {
    path.clone().u8().is_ok_and(|byte| byte >> 5 == 0)
}

fn step(modules: &[Objects], here: usize, hop: &PortSegment) -> Result<usize, u16> {
    let own = &modules.get(here).ok_or(PORT_NOT_AVAILABLE)?.module;
    let find =
        |wanted: &dyn Fn(&SimModule) -> bool| modules.iter().position(|objects| wanted(&objects.module));
    match hop.port() {
        BACKPLANE if own.slot.is_some() => {
            let slot = hop.slot().ok_or(LINK_ADDRESS_NOT_VALID)?;
            find(&|module| module.slot == Some(slot)).ok_or(LINK_ADDRESS_NOT_VALID)
        }
        ETHERNET if own.ip.is_some() => {
            let address = hop.address().and_then(|text| text.parse::<core::net::Ipv4Addr>().ok());
            let ip = address.ok_or(LINK_ADDRESS_NOT_VALID)?.octets();
            if own.ip == Some(ip) {
                return Err(LINK_ADDRESS_TO_SELF);
            }
            find(&|module| module.ip == Some(ip)).ok_or(TIMED_OUT)
        }
        _ => Err(PORT_NOT_AVAILABLE),
    }
}
