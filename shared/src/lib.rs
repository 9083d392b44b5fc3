//! The core of cipdeck: every byte, every rule and every state of an EtherNet/IP explicit message.
//!
//! `no_std` + `alloc`, no I/O, no clock: the same code runs in the browser and in the relay.
//!
//! | module | job |
//! | --- | --- |
//! | [`wire`] | bytes ↔ types |
//! | [`table`] | codes → names, explanations and sources; which services write |
//! | [`engine`] | machines that are given bytes and time |
//! | [`sim`] | a simulated device |
#![no_std]
#![forbid(unsafe_code)]
extern crate alloc;

pub mod engine;
pub mod sim;
pub mod table;
pub mod wire;
