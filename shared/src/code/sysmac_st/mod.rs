//! Sysmac Studio: `CIPUCMMSend`, or `CIPOpen`, `CIPSend` and `CIPClose` for a class 3 connection.
//!
//! From W502 (p. 750, 765, 766) and W506 8-2-5: the inputs, the order of those of `CIPSend`, which has no timeout of its own,
//! `_sCIP_HANDLE`, the structures `_sREQUEST_PATH` (always segments of 16 bits) and `_sREQUEST_PATH_EX` (segments as wide as
//! told, `_8BIT` or `_16BIT`), and the form of a route path. From memory: the type `_eCIP_LOGICAL_FORMAT` and its `_32BIT`, the
//! member `AttributeIDLogicalFormat`, that `TimeOut` counts 0.1 s and is 20 where it is not given, that the one of `CIPOpen`
//! bounds what is sent over the connection, too, and the order of the inputs of the other instructions.

mod block;
mod data;
mod instruction;
mod path;
mod read;
mod route;
mod write;

pub(super) use self::read::{import, is_instance};
pub(super) use self::write::export;

/// Members of a request path: what the number is called, what its width is called.
const SEGMENTS: [(&str, &str); 3] = [
    ("ClassID", "ClassIDLogicalFormat"),
    ("InstanceID", "InstanceIDLogicalFormat"),
    ("AttributeID", "AttributeIDLogicalFormat"),
];

/// How wide the number of a segment has to be.
const fn width(value: u32) -> &'static str {
    match value {
        0..=0xFF => "_8BIT",
        0x100..=0xFFFF => "_16BIT",
        _ => "_32BIT",
    }
}

#[cfg(test)]
mod tests;
