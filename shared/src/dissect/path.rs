//! Paths: which object a request is for, and its segments one by one.

use alloc::format;
use alloc::string::{String, ToString};

use crate::table;
use crate::wire::{ClassCode, LogicalKind, LogicalSegment, PortSegment, Reader, Segment, SymbolSegment};

use super::tree::Tree;
use super::words::{ascii, hex, numbered};

/// What a path addresses, as far as it can be understood.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Address {
    /// [`ClassCode::Symbol`] for a symbolic path.
    pub(super) class: Option<u16>,
    pub(super) instance: u32,
    /// 0 = none.
    pub(super) attribute: u16,
}

impl Address {
    /// Reads segments until one is not understood.
    pub(super) fn of(path: &[u8]) -> Self {
        let mut address = Self::default();
        if path.first() == Some(&SymbolSegment::CODE) {
            return Self { class: Some(ClassCode::Symbol.0), ..address };
        }
        let mut reader = Reader::new(path);
        while let Ok(Segment::Logical(LogicalSegment { kind, value })) = Segment::read(&mut reader) {
            match kind {
                LogicalKind::Class => address.class = u16::try_from(value).ok(),
                LogicalKind::Instance => address.instance = value,
                LogicalKind::Attribute => address.attribute = u16::try_from(value).unwrap_or(0),
                LogicalKind::Member | LogicalKind::ConnectionPoint => {}
            }
        }
        address
    }
}

/// Adds one leaf a segment.
pub(super) fn segments(tree: &mut Tree<'_>) -> Option<()> {
    while !tree.is_empty() {
        let mut ahead = tree.peek();
        match Segment::read(&mut ahead) {
            Ok(segment) => {
                let length = ahead.at() - tree.at();
                let (name, text) = describe(segment);
                tree.leaf(length, name, |_| text)?;
            }
            // A name that is cut.
            Err(_) if tree.peek().u8() == Ok(SymbolSegment::CODE) => symbol(tree)?,
            Err(error) => {
                tree.fail("segment", error);
                return None;
            }
        }
    }
    Some(())
}

fn describe(segment: Segment) -> (&'static str, String) {
    let LogicalSegment { kind, value } = match segment {
        Segment::Port(port) => {
            return ("port", format!("{}: {}", port.port(), link(&port)));
        }
        Segment::Symbol(symbol) => return ("symbol", name(symbol.name())),
        Segment::SimpleData(part) => {
            return ("part", format!("{} bytes from byte {}", part.size, part.offset));
        }
        Segment::Logical(logical) => logical,
    };
    match kind {
        LogicalKind::Class => ("class", numbered(value, 4, u16::try_from(value).ok().and_then(table::class))),
        LogicalKind::Instance if value == 0 => ("instance", "0: the class itself".to_string()),
        LogicalKind::Instance => ("instance", numbered(value, 4, None)),
        LogicalKind::Attribute => ("attribute", numbered(value, 4, None)),
        LogicalKind::Member => ("member", numbered(value, 4, None)),
        LogicalKind::ConnectionPoint => ("connection point", numbered(value, 4, None)),
    }
}

fn link(port: &PortSegment) -> String {
    match (port.slot(), port.address()) {
        (Some(slot), _) if port.port() == 1 => format!("backplane, slot {slot}"),
        (Some(slot), _) => format!("link {slot}"),
        (None, Some(address)) => format!("address {address}"),
        (None, None) => format!("address {}", hex(port.link())),
    }
}

fn symbol(tree: &mut Tree<'_>) -> Option<()> {
    let mut ahead = tree.peek();
    // The segment byte is known; a missing length shows as a segment that is cut.
    let length = ahead.take(1).and_then(|_| ahead.u8()).map_or(0, usize::from);
    tree.leaf(2 + length.next_multiple_of(2), "symbol", |bytes| {
        name(bytes.get(2..2 + length).unwrap_or_default())
    })?;
    Some(())
}

fn name(bytes: &[u8]) -> String {
    ascii(bytes).map_or_else(|| hex(bytes), ToString::to_string)
}
