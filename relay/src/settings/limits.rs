//! `[limits]`: what one client or one target may take.

use serde::Deserialize;

use super::SettingsError;

/// `[limits]`
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Limits {
    /// Messages that one target gets per second; 0 = no limit.
    pub messages_per_second: u32,
    /// Connections in all: 8..=65,536.
    pub connections: usize,
    /// Connections from one address: 1..=`connections`.
    pub connections_per_client: usize,
}

impl Default for Limits {
    fn default() -> Self {
        Self { messages_per_second: 1_000, connections: 512, connections_per_client: 128 }
    }
}

impl Limits {
    pub(super) fn checked(self) -> Result<Self, SettingsError> {
        let refused = |words: &str| Err(SettingsError::OutOfRange(words.to_owned()));
        if !(8..=65_536).contains(&self.connections) {
            return refused("limits.connections must be 8 to 65536");
        }
        if !(1..=self.connections).contains(&self.connections_per_client) {
            return refused("limits.connections_per_client must be 1 to limits.connections");
        }
        Ok(self)
    }
}
