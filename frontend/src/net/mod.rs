//! The relay: its connection, its REST interface, and when to come back.

mod heard;
mod reconnect;
mod relay;
pub mod rest;
mod sequence;
pub mod session;
mod socket;

pub use self::{
    reconnect::{Action, Input, Phase, Reconnect},
    relay::{Link, Relay, Writing},
    sequence::Sequence,
    socket::Socket,
};
