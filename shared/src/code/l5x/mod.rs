//! Studio 5000: a `MESSAGE` tag of type CIP Generic with its arrays, and the rung that starts it, as a partial export.
//!
//! Attributes of `MessageParameters` and their spelling as in public exports (L5Sharp's test data among them) and in
//! 1756-RM084. A `MESSAGE` keeps its timeouts in members that an export does not show, so the rung sets them:
//! `.UnconnectedTimeout` in µs (30 s by default: Logix Designer help, Message object), and for a connection
//! `.ConnectionRate` in µs x 4, 8 or 16 as `.TimeoutMultiplier` is 0, 1 or 2 (from memory of the same help).

mod data;
mod logic;
mod parameters;
mod path;
mod read;
mod tag;
mod write;
mod xml;

pub(super) use self::path::link;
pub(super) use self::read::import;
pub(super) use self::write::export;

/// `.UnconnectedTimeout` of a `MESSAGE` that nothing sets, in ms.
const DEFAULT_UNCONNECTED_MS: i64 = 30_000;

/// The timeout of a connection that nothing sets, in ms: `.ConnectionRate` 7,500,000 µs x 4. From memory.
const DEFAULT_CONNECTED_MS: i64 = 30_000;

/// `TargetObject` in an L5X: 1756-RM084. The member `.Instance` itself is a DINT.
const MAX_TARGET_OBJECT: i64 = 65_535;

#[cfg(test)]
mod tests;
