//! Rust with rseip: a program that sends the same bytes.
//!
//! Seen in rseip 0.3.1: its clients always wrap what they send unconnected in an Unconnected_Send, so that a direct message
//! goes through `EipContext`; an instance is a `u16`, and a port from 15 up is written with its high byte first.

mod read;
mod request;
mod way;
mod write;

pub(super) use self::read::import;
pub(super) use self::write::export;

#[cfg(test)]
mod tests;
