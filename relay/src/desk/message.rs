//! The message that writes a tag, and whether the device took it.

use cipdeck_shared::tag::{self, Dialect, TagName, Type, Value, request};
use cipdeck_shared::wire::{GeneralStatus, MessageRouterReply, MessageRouterRequest};

/// Writes everything that has the name. `known` is the type that was read: a structure is written with the handle that
/// came with it.
pub(crate) fn whole(
    dialect: Dialect,
    name: &TagName,
    kind: &Type,
    known: Option<&Type>,
    value: &Value,
) -> Result<MessageRouterRequest, String> {
    let data = kind.encode(dialect, value).map_err(|error| error.to_string())?;
    let head = kind.head(dialect).or_else(|| known?.head(dialect));
    let head = head.ok_or("the device has not told the structure's handle: write its members")?;
    let elements = u16::try_from(kind.elements(dialect)).unwrap_or(u16::MAX);
    request::write(name.path(), head, elements, &data).map_err(|error| error.to_string())
}

/// Writes one bit of a number of a type. Only a Logix does so without touching the others.
pub(crate) fn one_bit(
    dialect: Dialect,
    name: &TagName,
    number: &Type,
    bit: u8,
    on: bool,
) -> Result<MessageRouterRequest, String> {
    if dialect != Dialect::Logix {
        return Err("this controller cannot write a single bit: write the whole number".to_owned());
    }
    let bits = match number {
        Type::Elementary(kind) => kind.bits().filter(|bits| bit < *bits),
        _ => None,
    };
    let size = bits.ok_or("there is no such bit: it is no whole number, or too small")? / 8;
    request::write_bit(name.path(), size.into(), bit, on).map_err(|error| error.to_string())
}

/// Why the device has not carried it out, in words.
pub(crate) fn refused(reply: &[u8]) -> Option<String> {
    match MessageRouterReply::decode(reply) {
        Ok(reply) if reply.status == GeneralStatus::Success => None,
        Ok(reply) => Some(tag::refusal(reply.status, reply.additional.words().next())),
        Err(error) => Some(error.to_string()),
    }
}
