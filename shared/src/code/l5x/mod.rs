//! Studio 5000: a `MESSAGE` tag of type CIP Generic with its arrays, and the rung that starts it, as a partial export.
//!
//! Attributes of `MessageParameters` and their spelling as in public exports (L5Sharp's test data among them) and in
//! 1756-RM084: there `ConnectedFlag` is 1 with `CacheConnections` and 2 without, so 2 is unconnected. A `MESSAGE` keeps its
//! timeouts in members that an export does not show, so the rung sets them (1756-RM003N p. 157 to 159, Logix Designer help,
//! Message object; the defaults also in CalAmp's Viper SC+ manual p. 191): `.UnconnectedTimeout` in µs, 30 s by default, and
//! for a connection `.ConnectionRate` in µs, 7.5 s by default, times 4 as `.TimeoutMultiplier` is 0. That 1 and 2 are 8 and
//! 16 says a trade site alone (industrialmonitordirect).

mod data;
mod logic;
mod modules;
mod parameters;
mod path;
mod project;
mod read;
mod source;
mod structured;
mod tag;
mod timing;
mod write;
mod xml;

pub(super) use self::path::link;
pub(super) use self::read::import;
pub(super) use self::write::export;

/// `.UnconnectedTimeout` of a `MESSAGE` that nothing sets, in ms.
const DEFAULT_UNCONNECTED_MS: i64 = 30_000;

/// The timeout of a connection that nothing sets, in ms: `.ConnectionRate` 7,500,000 µs x 4.
const DEFAULT_CONNECTED_MS: i64 = 30_000;

/// `TargetObject` in an L5X: 1756-RM084. The member `.Instance` itself is a DINT.
const MAX_TARGET_OBJECT: i64 = 65_535;

#[cfg(test)]
mod tests;
