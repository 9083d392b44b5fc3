//! The core of cipdeck: every byte, every rule and every state of an EtherNet/IP explicit message.
//!
//! `no_std` + `alloc`, no I/O, no clock: the same code runs in the browser and in the relay.
//!
//! | module | job |
//! | --- | --- |
//! | [`wire`] | bytes ↔ types |
//! | [`table`] | code → name, explanation, source; (service, class) → read, write or unknown |
//! | [`dissect`] | bytes → a tree of (byte range, name, text) |
//! | [`config`] | what is stored: blocks with the manual's names |
//! | [`plan`] | a configuration → a message that can be sent, or all findings |
//! | [`engine`] | sans-IO machines: block, trigger, channel, session, client; time is passed in |
//! | [`sim`] | sans-IO simulated device |
//! | [`api`] | the REST and WebSocket types |
#![no_std]
#![forbid(unsafe_code)]
extern crate alloc;

pub mod wire;
