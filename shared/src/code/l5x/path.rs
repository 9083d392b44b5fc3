//! `ConnectionPath` ↔ `TargetCfg.Path`.
//!
//! A Logix path begins at the controller: `2, 192.168.1.100` leaves a CompactLogix by its Ethernet port. A ControlLogix
//! goes over the backplane to its Ethernet module first, by name or as `1, slot`: `LocalENB, 2, 192.168.1.100`.

use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;
use core::fmt::Write;

use crate::config::TargetPath;
use crate::wire::{PortSegment, Segment};

use super::super::message::Message;

/// The controller itself.
pub(super) const THIS: &str = "THIS";

/// As Studio 5000 writes it: `2, 192.168.1.100, 1, 0`.
pub(super) fn connection_path(message: &Message<'_>) -> String {
    let Some(endpoint) = message.endpoint() else { return THIS.to_string() };
    let mut path = format!("2, {}", endpoint.host);
    for segment in message.path.route.segments() {
        if let Segment::Port(port) = segment {
            // Writing to a String cannot fail.
            let _ = write!(path, ", {}, {}", port.port(), link(port));
        }
    }
    path
}

/// A slot, or an address.
pub(in crate::code) fn link(port: &PortSegment) -> String {
    match (port.slot(), port.address()) {
        (Some(slot), _) => slot.to_string(),
        (None, address) => address.unwrap_or_default().to_string(),
    }
}

/// What a `ConnectionPath` says.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Meant {
    /// As `TargetCfg.Path`.
    Path(String),
    /// The controller itself.
    This,
    /// A path behind what belongs to the controller's own chassis: the module's name, or `1, slot`.
    Behind(String, String),
    /// A module of the project, by name alone.
    Module(String),
    /// Nothing that leads over Ethernet.
    Elsewhere,
}

/// Reads a `ConnectionPath`.
pub(super) fn meant(text: &str) -> Meant {
    let parts: Vec<&str> = text.split(',').map(str::trim).collect();
    match parts.as_slice() {
        [this] if this.eq_ignore_ascii_case(THIS) => Meant::This,
        ["2", rest @ ..] => ethernet(rest).map_or(Meant::Elsewhere, Meant::Path),
        ["1", slot, "2", rest @ ..] => {
            let front = format!("1, {slot}");
            ethernet(rest).map_or(Meant::Elsewhere, |path| Meant::Behind(front, path))
        }
        [name] if is_name(name) => Meant::Module(name.to_string()),
        [name, "2", rest @ ..] if is_name(name) => {
            ethernet(rest).map_or(Meant::Elsewhere, |path| Meant::Behind(name.to_string(), path))
        }
        _ => Meant::Elsewhere,
    }
}

/// From the address on; only what `TargetCfg.Path` understands.
fn ethernet(parts: &[&str]) -> Option<String> {
    let path = format!("4,{}", parts.join(","));
    path.parse::<TargetPath>().is_ok().then_some(path)
}

fn is_name(text: &str) -> bool {
    text.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_begins_at_the_controller_or_at_its_ethernet_module() {
        let path = |path: &str| Meant::Path(path.into());
        let behind = |front: &str, path: &str| Meant::Behind(front.into(), path.into());
        for (text, expected) in [
            ("2, 192.168.1.100", path("4,192.168.1.100")),
            ("2,192.168.1.100,1,0", path("4,192.168.1.100,1,0")),
            ("LocalENB, 2, 192.168.1.20, 1, 0", behind("LocalENB", "4,192.168.1.20,1,0")),
            ("1, 3, 2, 10.0.0.7", behind("1, 3", "4,10.0.0.7")),
            ("THIS", Meant::This),
            ("DriveModule", Meant::Module("DriveModule".into())),
            ("1, 4", Meant::Elsewhere),
            ("ENB, 3, 7", Meant::Elsewhere),
            ("2, 300.1.1.1", Meant::Elsewhere),
            ("", Meant::Elsewhere),
        ] {
            assert_eq!(meant(text), expected, "{text}");
        }
    }
}
