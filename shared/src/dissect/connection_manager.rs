//! The Connection Manager's services: a message on a route, and what opens and closes connections. The layouts and
//! their sources are those of `wire`: `unconnected_send`, `forward_open`, `forward_close`.

use alloc::format;
use alloc::string::{String, ToString};

use crate::table;
use crate::wire::{ClassCode, GeneralStatus, ServiceCode};

use super::message::embedded;
use super::path;
use super::tree::Tree;
use super::value::About;
use super::words::{hex, numbered};

/// The name of a service that is dissected here.
const fn name(service: ServiceCode) -> Option<&'static str> {
    match service {
        ServiceCode::UnconnectedSend => Some("Unconnected_Send"),
        ServiceCode::ForwardClose => Some("Forward_Close"),
        ServiceCode::ForwardOpen => Some("Forward_Open"),
        ServiceCode::LargeForwardOpen => Some("Large_Forward_Open"),
        _ => None,
    }
}

/// Whether the data of this request is dissected here.
pub(super) fn is_asked(about: &About) -> bool {
    let manager = about.address.class == Some(ClassCode::ConnectionManager.0);
    manager && about.service.and_then(name).is_some()
}

/// Adds the data of a request to the Connection Manager.
pub(super) fn request(tree: &mut Tree<'_>, service: ServiceCode) -> Option<()> {
    tree.branch(tree.remaining(), name(service).unwrap_or("data"), |tree| match service {
        ServiceCode::UnconnectedSend => unconnected_send(tree),
        ServiceCode::ForwardClose => {
            timeout(tree)?;
            triad(tree)?;
            padded_path(tree, "path")
        }
        _ => forward_open(tree, service == ServiceCode::LargeForwardOpen),
    })
}

/// Whether a reply is the Connection Manager's: it was asked, or a router answers instead of the target. Without its
/// request a reply of another class's service with the same number looks the same, except for its length.
pub(super) fn answers(about: &About, service: ServiceCode, refused: bool, length: usize) -> bool {
    if name(service).is_none() {
        return false;
    }
    match about.service {
        Some(asked) if asked == service => is_asked(about),
        _ if refused => true,
        _ => match service {
            ServiceCode::UnconnectedSend => false,
            ServiceCode::ForwardClose => length >= 10,
            _ => length >= 26,
        },
    }
}

/// What it means that the Connection Manager has answered although something else was asked.
pub(super) fn answers_instead(about: &About, service: ServiceCode) -> Option<&'static str> {
    let asked = about.service.filter(|asked| *asked != service);
    match (asked?, service) {
        (_, ServiceCode::UnconnectedSend) => Some("Not the target has answered, but a router."),
        (_, ServiceCode::ForwardOpen | ServiceCode::LargeForwardOpen) => {
            Some("This is about the connection that the request needed.")
        }
        _ => None,
    }
}

/// Adds the data of a reply.
pub(super) fn reply(tree: &mut Tree<'_>, service: ServiceCode, status: GeneralStatus) -> Option<()> {
    if status != GeneralStatus::Success {
        return tree.branch(tree.remaining(), "data", |tree| refusal(tree, service));
    }
    tree.branch(tree.remaining(), name(service).unwrap_or("data"), |tree| {
        if matches!(service, ServiceCode::ForwardOpen | ServiceCode::LargeForwardOpen) {
            ids(tree)?;
        }
        triad(tree)?;
        if service != ServiceCode::ForwardClose {
            interval(tree, "O→T actual interval")?;
            interval(tree, "T→O actual interval")?;
        }
        tree.u8("application reply size", words)?;
        reserved(tree, 1)?;
        rest(tree)
    })
}

/// Devices are known to leave out everything.
fn refusal(tree: &mut Tree<'_>, service: ServiceCode) -> Option<()> {
    if service != ServiceCode::UnconnectedSend && tree.remaining() >= 8 {
        triad(tree)?;
    }
    if !tree.is_empty() {
        tree.u8("remaining path size", |size| format!("{} of the path were left", words(size)))?;
    }
    if !tree.is_empty() {
        reserved(tree, 1)?;
    }
    rest(tree)
}

fn unconnected_send(tree: &mut Tree<'_>) -> Option<()> {
    timeout(tree)?;
    let length = tree.u16("embedded message length", |length| format!("{length} bytes"))?;
    tree.branch(length.into(), "embedded message", embedded)?;
    if length % 2 != 0 {
        tree.u8("pad", |_| "the embedded message has an odd length".to_string())?;
    }
    padded_path(tree, "route")
}

fn forward_open(tree: &mut Tree<'_>, large: bool) -> Option<()> {
    timeout(tree)?;
    ids(tree)?;
    triad(tree)?;
    tree.u8("timeout multiplier", |code| {
        format!("{code}: silent for {} intervals, the connection ends", 4_u16 << code.min(7))
    })?;
    reserved(tree, 3)?;
    interval(tree, "O→T requested interval")?;
    parameters(tree, large, "O→T parameters")?;
    interval(tree, "T→O requested interval")?;
    parameters(tree, large, "T→O parameters")?;
    tree.u8("transport", |code| {
        let side = if code & 0x80 == 0 { "client" } else { "server" };
        format!("{code:#04x}: class {}, {side}", code & 0x0F)
    })?;
    let size = tree.u8("path size", words)?;
    tree.branch(2 * usize::from(size), "path", path::segments)
}

fn timeout(tree: &mut Tree<'_>) -> Option<()> {
    let tick = 1_u32 << (tree.peek().u8().unwrap_or_default() & 0x0F);
    tree.u8("time tick", |code| format!("{code}: a tick is {tick} ms"))?;
    tree.u8("timeout ticks", |ticks| format!("{ticks} ticks, {} ms", tick * u32::from(ticks)))?;
    Some(())
}

fn ids(tree: &mut Tree<'_>) -> Option<()> {
    tree.u32("O→T connection id", |id| format!("{id:#010x}, in requests"))?;
    tree.u32("T→O connection id", |id| format!("{id:#010x}, in replies"))?;
    Some(())
}

fn triad(tree: &mut Tree<'_>) -> Option<()> {
    tree.u16("connection serial number", |serial| numbered(serial.into(), 6, None))?;
    tree.u16("originator vendor id", |id| numbered(id.into(), 6, table::vendor(id)))?;
    tree.u32("originator serial number", |serial| format!("{serial:#010x}"))?;
    Some(())
}

fn interval(tree: &mut Tree<'_>, name: &'static str) -> Option<()> {
    tree.u32(name, |micros| format!("{micros} µs"))?;
    Some(())
}

/// Size and kind: 9 and 7 bits in Forward_Open, 16 and 16 bits in Large_Forward_Open.
fn parameters(tree: &mut Tree<'_>, large: bool, name: &'static str) -> Option<()> {
    let text = |size: u32, flags: u32| {
        let kind = match (flags >> 13) & 3 {
            0 => "null",
            1 => "multicast",
            2 => "point to point",
            _ => "reserved type",
        };
        let length = if flags & 0x0200 == 0 { "fixed" } else { "at most" };
        format!("{length} {size} bytes, {kind}")
    };
    if large {
        tree.u32(name, |bits| text(bits & 0xFFFF, bits >> 16))?;
    } else {
        tree.u16(name, |bits| text((bits & 0x01FF).into(), bits.into()))?;
    }
    Some(())
}

fn padded_path(tree: &mut Tree<'_>, name: &'static str) -> Option<()> {
    let size = tree.u8(if name == "route" { "route size" } else { "path size" }, words)?;
    reserved(tree, 1)?;
    tree.branch(2 * usize::from(size), name, path::segments)
}

fn reserved(tree: &mut Tree<'_>, length: usize) -> Option<()> {
    tree.leaf(length, "reserved", hex)?;
    Some(())
}

fn rest(tree: &mut Tree<'_>) -> Option<()> {
    tree.leaf(tree.remaining(), "data", hex)?;
    Some(())
}

fn words(size: u8) -> String {
    format!("{size} words, {} bytes", 2 * u16::from(size))
}
