//! The simulated device, seen from the wire.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::indexing_slicing, reason = "a test may fail")]

#[cfg(not(target_arch = "wasm32"))]
mod any_bytes;
mod browse;
mod connections;
mod faults;
mod frames;
mod objects;
mod opening;
mod routes;
mod session;
mod tags;
