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
pub(super) enum Meant<'t> {
    /// As `TargetCfg.Path`.
    Path(String),
    /// The controller itself.
    This,
    /// A path behind `1, slot`, which is in the controller's own chassis.
    Behind(String, String),
    /// A module of the project, and the way on from there; with the path behind it, if the name is that of the
    /// controller's own Ethernet module.
    Named {
        /// Of the module.
        name: &'t str,
        /// `,1,0`
        rest: String,
        /// As `TargetCfg.Path`.
        path: Option<String>,
    },
    /// Nothing that leads over Ethernet.
    Elsewhere,
}

/// Reads a `ConnectionPath`.
pub(super) fn meant(text: &str) -> Meant<'_> {
    let parts: Vec<&str> = text.split(',').map(str::trim).collect();
    match parts.as_slice() {
        [this] if this.eq_ignore_ascii_case(THIS) => Meant::This,
        ["2", rest @ ..] => ethernet(rest).map_or(Meant::Elsewhere, Meant::Path),
        ["1", slot, "2", rest @ ..] => {
            let front = format!("1, {slot}");
            ethernet(rest).map_or(Meant::Elsewhere, |path| Meant::Behind(front, path))
        }
        [name, rest @ ..] if is_name(name) => {
            let path = rest.split_first().filter(|(port, _)| **port == "2");
            let path = path.and_then(|(_, rest)| ethernet(rest));
            let rest = rest.iter().flat_map(|part| [",", part]).collect();
            Meant::Named { name, rest, path }
        }
        _ => Meant::Elsewhere,
    }
}

/// From the address on; only what `TargetCfg.Path` understands.
fn ethernet(parts: &[&str]) -> Option<String> {
    let path = format!("4,{}", parts.join(","));
    is_path(&path).then_some(path)
}

/// Whether `TargetCfg.Path` can be that.
pub(super) fn is_path(text: &str) -> bool {
    text.parse::<TargetPath>().is_ok()
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
        let named = |name, rest: &str, path: Option<&str>| Meant::Named {
            name,
            rest: rest.into(),
            path: path.map(ToString::to_string),
        };
        for (text, expected) in [
            ("2, 192.168.1.100", path("4,192.168.1.100")),
            ("2,192.168.1.100,1,0", path("4,192.168.1.100,1,0")),
            (
                "LocalENB, 2, 192.168.1.20, 1, 0",
                named("LocalENB", ",2,192.168.1.20,1,0", Some("4,192.168.1.20,1,0")),
            ),
            ("1, 3, 2, 10.0.0.7", behind("1, 3", "4,10.0.0.7")),
            ("THIS", Meant::This),
            ("DriveModule", named("DriveModule", "", None)),
            ("Remote, 1, 0", named("Remote", ",1,0", None)),
            ("1, 4", Meant::Elsewhere),
            ("ENB, 3, 7", named("ENB", ",3,7", None)),
            ("2, 300.1.1.1", Meant::Elsewhere),
            ("", Meant::Elsewhere),
        ] {
            assert_eq!(meant(text), expected, "{text}");
        }
    }
}
