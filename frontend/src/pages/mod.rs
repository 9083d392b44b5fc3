//! What people see.

pub mod block;
pub mod connection;
pub mod connections;
pub mod deck;
pub mod help;
pub mod monitor;
pub mod not_found;
