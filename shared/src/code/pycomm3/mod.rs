//! Python with pycomm3: a script that sends the same bytes.
//!
//! Seen in pycomm3 1.2.16: `generic_message` wraps unconnected messages only with `unconnected_send=True`, and otherwise
//! appends the route to the request unless `route_path` is False; Unconnected_Send always says 5120 ms (tick 0A, 5
//! ticks); a 32-bit segment is written with 0x27 instead of 0x26, and ports from 15 up as one byte; an attribute that is
//! 0 is none; the timeout of the socket counts for each connect, send and receive.

mod call;
mod read;
mod write;

pub(super) use self::read::import;
pub(super) use self::write::export;

#[cfg(test)]
mod tests;
