//! The relay: its connection, its REST interface, and when to come back.

mod heard;
mod reconnect;
mod relay;
pub mod rest;
mod sequence;
mod socket;

pub use self::{
    reconnect::{Action, Input, Phase, Reconnect},
    relay::{Link, Relay},
    sequence::Sequence,
    socket::Socket,
};
