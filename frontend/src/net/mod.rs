//! The relay: its connections, its REST interface, and when to come back.

mod heard;
mod line;
mod link;
mod pulse;
mod reconnect;
mod relay;
pub mod rest;
mod sequence;
pub mod session;
mod socket;

pub use self::{
    line::{Carried, Line},
    link::{Link, Writing},
    reconnect::{Action, Input, Phase, Reconnect},
    relay::{Deck, Relay},
    sequence::Sequence,
    socket::Socket,
};
