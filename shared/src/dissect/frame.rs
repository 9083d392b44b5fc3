//! Encapsulation frames and the common packet format.

use alloc::format;
use alloc::string::{String, ToString};

use crate::table;
use crate::wire::{Command, EncapsulationStatus, ItemType, Reader, ServiceCode};

use super::message::{reply_at, request_at};
use super::tree::{Node, Tree};
use super::value::About;
use super::words::{ascii, coded, hex, numbered};

/// One frame: encapsulation header, common packet format, message. A reply is dissected without its request, so
/// its data is a guess.
pub fn frame(bytes: &[u8]) -> Node {
    let mut tree = Tree::new(bytes, 0);
    // `None` has left its error in the tree.
    let _ = fill(&mut tree);
    tree.close("frame", String::new())
}

fn fill(tree: &mut Tree<'_>) -> Option<()> {
    let command = tree.u16("command", |code| match Command(code).name() {
        Some(name) => format!("{code:#06x} {name}"),
        None => format!("{code:#06x}, not in the tables"),
    })?;
    let length = tree.u16("length", |length| format!("{length} bytes follow the header"))?;
    tree.u32("session handle", |handle| format!("{handle:#010x}"))?;
    tree.u32("status", |code| {
        let status = EncapsulationStatus(code);
        coded(status, table::encapsulation_status(status))
    })?;
    tree.leaf(8, "sender context", hex)?;
    tree.u32("options", |options| format!("{options:#010x}"))?;
    tree.branch(length.into(), "encapsulation data", |tree| match Command(command) {
        Command::RegisterSession => {
            tree.u16("protocol version", |version| version.to_string())?;
            tree.u16("options", |options| format!("{options:#06x}"))?;
            Some(())
        }
        Command::SendRRData | Command::SendUnitData => {
            tree.u32("interface handle", |handle| {
                format!("{handle:#010x}{}", if handle == 0 { " CIP" } else { "" })
            })?;
            tree.u16("timeout", |seconds| match seconds {
                0 => "0: as CIP says".to_string(),
                _ => format!("{seconds} s"),
            })?;
            items(tree)
        }
        Command::ListIdentity | Command::ListServices | Command::ListInterfaces => items(tree),
        _ => unknown(tree),
    })
}

fn items(tree: &mut Tree<'_>) -> Option<()> {
    let count = tree.u16("item count", |count| count.to_string())?;
    for _ in 0..count {
        let mut ahead = tree.peek();
        let kind = ahead.u16().ok().map(ItemType);
        let length = ahead.u16().map_or(0, usize::from);
        let name = kind.and_then(ItemType::name).map_or("item", item_name);
        tree.branch(4 + length, name, |tree| {
            let kind = tree.u16("item type", |code| match ItemType(code).name() {
                Some(name) => format!("{code:#06x} {}", item_name(name)),
                None => format!("{code:#06x}, not in the tables"),
            })?;
            tree.u16("item length", |length| format!("{length} bytes"))?;
            item(tree, ItemType(kind))
        })?;
    }
    Some(())
}

fn item_name(code: &'static str) -> &'static str {
    match code {
        "NullAddress" => "null address",
        "ListIdentity" => "identity",
        "ConnectedAddress" => "connected address",
        "ConnectedData" => "connected data",
        "UnconnectedData" => "unconnected data",
        "ListServices" => "services",
        "SocketAddressOT" | "SocketAddressTO" => "socket address",
        "SequencedAddress" => "sequenced address",
        other => other,
    }
}

fn item(tree: &mut Tree<'_>, kind: ItemType) -> Option<()> {
    match kind {
        ItemType::UnconnectedData => message(tree),
        ItemType::ConnectedData => {
            tree.u16("sequence count", |count| count.to_string())?;
            message(tree)
        }
        ItemType::ConnectedAddress => {
            tree.u32("connection id", |id| format!("{id:#010x}"))?;
            Some(())
        }
        ItemType::SequencedAddress => {
            tree.u32("connection id", |id| format!("{id:#010x}"))?;
            tree.u32("sequence number", |number| number.to_string())?;
            Some(())
        }
        ItemType::SocketAddressOT | ItemType::SocketAddressTO => socket_address(tree),
        ItemType::ListIdentity => identity(tree),
        ItemType::ListServices => {
            tree.u16("protocol version", |version| version.to_string())?;
            tree.u16("capabilities", |flags| format!("{flags:#06x}"))?;
            tree.leaf(16, "service name", text)?;
            Some(())
        }
        _ => unknown(tree),
    }
}

/// A request or a reply: bit 7 of the service tells.
fn message(tree: &mut Tree<'_>) -> Option<()> {
    let at = tree.at();
    let bytes = tree.peek().rest();
    let first = *bytes.first()?;
    tree.push_rest([if first & ServiceCode::REPLY == 0 {
        request_at(bytes, at)
    } else {
        reply_at(bytes, at, &About::default())
    }]);
    Some(())
}

fn identity(tree: &mut Tree<'_>) -> Option<()> {
    tree.u16("protocol version", |version| version.to_string())?;
    socket_address(tree)?;
    tree.u16("vendor id", |id| numbered(id.into(), 6, table::vendor(id)))?;
    tree.u16("device type", |code| numbered(code.into(), 6, table::device_type(code)))?;
    tree.u16("product code", |code| code.to_string())?;
    tree.leaf(2, "revision", |bytes| match bytes {
        [major, minor] => format!("{major}.{minor}"),
        _ => String::new(),
    })?;
    tree.u16("status", |status| format!("{status:#06x} {}", table::identity_status(status)))?;
    tree.u32("serial number", |serial| format!("{serial:#010x}"))?;
    let length = tree.peek().u8().unwrap_or_default();
    tree.leaf(1 + usize::from(length), "product name", |bytes| text(bytes.get(1..).unwrap_or_default()))?;
    if !tree.is_empty() {
        tree.u8("state", |state| {
            let words = table::identity_state(state).unwrap_or("not in the tables");
            format!("{state} {words}")
        })?;
    }
    Some(())
}

fn socket_address(tree: &mut Tree<'_>) -> Option<()> {
    tree.leaf(16, "socket address", |bytes| {
        let mut reader = Reader::new(bytes);
        let parts = (reader.array(), reader.array(), reader.array::<4>());
        let (Ok(family), Ok(port), Ok([a, b, c, d])) = parts else { return String::new() };
        let port = u16::from_be_bytes(port);
        match u16::from_be_bytes(family) {
            2 => format!("{a}.{b}.{c}.{d}:{port}"),
            family => format!("{a}.{b}.{c}.{d}:{port}, family {family} is not IPv4"),
        }
    })?;
    Some(())
}

/// Characters up to the padding, or hexadecimal.
fn text(bytes: &[u8]) -> String {
    let end = bytes.iter().rposition(|byte| *byte != 0).map_or(0, |last| last + 1);
    let characters = bytes.get(..end).unwrap_or_default();
    ascii(characters).map_or_else(|| hex(bytes), ToString::to_string)
}

fn unknown(tree: &mut Tree<'_>) -> Option<()> {
    tree.leaf(tree.remaining(), "data", hex)?;
    Some(())
}
