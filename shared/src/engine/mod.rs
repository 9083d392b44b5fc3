//! Machines that are given bytes and time.

pub mod time;
