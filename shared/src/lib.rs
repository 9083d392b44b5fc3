//! The core of cipdeck: every byte, every rule and every state of an EtherNet/IP explicit message.
//!
//! `no_std` + `alloc`, no I/O, no clock: the same code runs in the browser and in the relay.
//!
//! | module | job |
//! | --- | --- |
//! | [`wire`] | bytes ↔ types |
//! | [`tag`] | names, types and values of tags, as three families of controllers lay them out |
//! | [`table`] | codes → names, explanations and sources; which services write |
//! | [`dissect`] | bytes → what they mean, byte by byte |
//! | [`sim`] | a simulated device |
//! | [`config`] | what is stored: blocks with the manual's names |
//! | [`plan`] | a configuration → a message that can be sent, or all findings |
//! | [`engine`] | sans-IO machines: block, trigger, buffers, session, client; time is passed in |
//! | [`api`] | the REST and WebSocket types |
//!
//! The feature `openapi` derives descriptions of the types of the interface. Only what is derived uses `std`, and the
//! page is built without it.
#![cfg_attr(not(feature = "openapi"), no_std)]
#![forbid(unsafe_code)]
extern crate alloc;

pub mod api;
pub mod code;
pub mod config;
pub mod dissect;
pub mod engine;
pub mod plan;
pub mod sim;
pub mod table;
pub mod tag;
pub mod wire;
