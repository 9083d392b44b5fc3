//! Common packet format: `UINT item count, then {UINT type, UINT length, data}`. Source: OpENer `cpf.h`.

use alloc::vec::Vec;

use super::cursor::{DecodeError, Reader};

open_enum! {
    /// Type of an item. Source: Wireshark packet-enip.c, icsnpp-enip consts.pac.
    pub struct ItemType(u16, width 6) {
        /// No address: the session is enough.
        NullAddress = 0x0000,
        /// Reply to ListIdentity.
        ListIdentity = 0x000C,
        /// Connection id of a class 3 message.
        ConnectedAddress = 0x00A1,
        /// Sequence count and message of a class 3 connection.
        ConnectedData = 0x00B1,
        /// A message router request or reply.
        UnconnectedData = 0x00B2,
        /// Reply to ListServices.
        ListServices = 0x0100,
        /// Socket address, originator to target.
        SocketAddressOT = 0x8000,
        /// Socket address, target to originator.
        SocketAddressTO = 0x8001,
        /// Connection id and sequence number of I/O.
        SequencedAddress = 0x8002,
    }
}

/// Items that have been checked to be whole.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CommonPacketFormat<'a> {
    count: u16,
    items: &'a [u8],
    at: usize,
}

impl<'a> CommonPacketFormat<'a> {
    /// Reads the item count and all items, and nothing after them.
    pub fn read(reader: &mut Reader<'a>) -> Result<Self, DecodeError> {
        let count = reader.u16()?;
        let at = reader.at();
        let mut walk = reader.clone();
        for _ in 0..count {
            read_item(&mut walk)?;
        }
        let items = reader.take(walk.at() - at)?;
        Ok(Self { count, items, at })
    }

    /// How many items there are.
    pub const fn count(&self) -> u16 {
        self.count
    }

    /// The items in order.
    pub const fn items(&self) -> Items<'a> {
        Items { reader: Reader::starting_at(self.items, self.at) }
    }

    /// The first item of a type.
    pub fn find(&self, kind: ItemType) -> Option<Item<'a>> {
        self.items().find(|item| item.kind == kind)
    }
}

/// One item.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Item<'a> {
    /// What it is.
    pub kind: ItemType,
    /// The position of its first data byte in the whole.
    pub at: usize,
    /// Its data.
    pub data: &'a [u8],
}

impl Item<'_> {
    /// Appends the item whose `data` is at most 65,535 bytes: `length` is its proof.
    pub(super) fn encode(kind: ItemType, length: u16, data: &[u8], out: &mut Vec<u8>) {
        out.extend_from_slice(&kind.0.to_le_bytes());
        out.extend_from_slice(&length.to_le_bytes());
        out.extend_from_slice(data);
    }
}

/// Iterates over items.
#[derive(Clone, Debug)]
pub struct Items<'a> {
    reader: Reader<'a>,
}

impl<'a> Iterator for Items<'a> {
    type Item = Item<'a>;

    fn next(&mut self) -> Option<Item<'a>> {
        if self.reader.is_empty() {
            return None;
        }
        read_item(&mut self.reader).ok()
    }
}

fn read_item<'a>(reader: &mut Reader<'a>) -> Result<Item<'a>, DecodeError> {
    let kind = ItemType(reader.u16()?);
    let length = usize::from(reader.u16()?);
    let at = reader.at();
    Ok(Item { kind, at, data: reader.take(length)? })
}
