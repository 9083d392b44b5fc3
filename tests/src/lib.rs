//! Test harness: a relay, targets that nobody here wrote, a target that follows a script, and the clients of the
//! relay (REST, WebSocket, command line, browser). Everything listens on a free port of the loopback interface,
//! waits for conditions with a deadline, and ends what it started.
//!
//! A tool that is missing makes a test fail and says what to run; nothing is skipped silently.

#![expect(clippy::missing_panics_doc, reason = "a harness fails its test by panicking, everywhere")]

pub mod block;
pub mod browser;
mod chromium;
pub mod command;
pub mod fake_plc;
pub mod frame;
pub mod gateway;
pub mod live;
pub mod managed;
pub mod measure;
pub mod namespace;
pub mod peers;
pub mod process;
pub mod random;
pub mod relay;
pub mod rest;
pub mod secure;
pub mod shipped;
pub mod tools;
pub mod tshark;
pub mod viewer;
pub mod wait;

/// Long enough for anything on a busy machine that does not wait for a timeout of the product; nothing waits this
/// long unless it fails.
pub const PATIENCE: std::time::Duration = std::time::Duration::from_secs(20);
