//! Requests of the tag services. Sources: Omron W506 8-6, pycomm3 services.py.

use alloc::vec::Vec;

use super::data::TagHead;
use crate::wire::{Epath, MessageRouterRequest, Segment, ServiceCode, SimpleDataSegment, TooLong};

/// Read Tag: so many elements, from the one that the path names.
pub fn read(path: Epath, elements: u16) -> Result<MessageRouterRequest, TooLong> {
    MessageRouterRequest::new(ServiceCode::ReadTag, path, elements.to_le_bytes().to_vec())
}

/// Read Tag Fragmented, from a byte of the value on. Logix.
pub fn read_fragment(path: Epath, elements: u16, offset: u32) -> Result<MessageRouterRequest, TooLong> {
    let data = [&elements.to_le_bytes()[..], &offset.to_le_bytes()].concat();
    MessageRouterRequest::new(ServiceCode::READ_TAG_FRAGMENTED, path, data)
}

/// Read Tag of some bytes of a value. Omron.
pub fn read_part(path: Epath, part: SimpleDataSegment) -> Result<MessageRouterRequest, TooLong> {
    read(path.with(Segment::SimpleData(part)), 1)
}

/// Write Tag: all elements.
pub fn write(
    path: Epath,
    head: TagHead,
    elements: u16,
    data: &[u8],
) -> Result<MessageRouterRequest, TooLong> {
    let mut out = Vec::with_capacity(6 + data.len());
    head.encode(&mut out);
    out.extend_from_slice(&elements.to_le_bytes());
    out.extend_from_slice(data);
    MessageRouterRequest::new(ServiceCode::WriteTag, path, out)
}

/// Write Tag Fragmented: a part of what is written, at its byte. Logix.
pub fn write_fragment(
    path: Epath,
    head: TagHead,
    elements: u16,
    offset: u32,
    data: &[u8],
) -> Result<MessageRouterRequest, TooLong> {
    let mut out = Vec::with_capacity(10 + data.len());
    head.encode(&mut out);
    out.extend_from_slice(&elements.to_le_bytes());
    out.extend_from_slice(&offset.to_le_bytes());
    out.extend_from_slice(data);
    MessageRouterRequest::new(ServiceCode::WriteTagFragmented, path, out)
}

/// Read Modify Write Tag: one bit of a number of so many bytes; the controller leaves the others alone. Logix.
///
/// `UINT size | OR mask | AND mask`. Source: pycomm3 packets/logix.py.
pub fn write_bit(path: Epath, size: u16, bit: u8, on: bool) -> Result<MessageRouterRequest, TooLong> {
    let mask = 1_u64.checked_shl(bit.into()).unwrap_or(0);
    let (set, keep) = if on { (mask, u64::MAX) } else { (0, !mask) };
    let bytes = usize::from(size).min(8);
    let mut data = size.to_le_bytes().to_vec();
    data.extend(set.to_le_bytes().iter().take(bytes));
    data.extend(keep.to_le_bytes().iter().take(bytes));
    MessageRouterRequest::new(ServiceCode::READ_MODIFY_WRITE_TAG, path, data)
}
