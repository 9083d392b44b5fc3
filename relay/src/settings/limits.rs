//! `[limits]`: what one client or one target may take.

use serde::Deserialize;

/// `[limits]`
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Limits {
    /// Messages that one target gets per second; 0 = no limit.
    pub messages_per_second: u32,
}

impl Default for Limits {
    fn default() -> Self {
        Self { messages_per_second: 1_000 }
    }
}
