//! `[history]`: what is kept of runs.

use serde::Deserialize;

use super::SettingsError;

/// What is kept of runs: `[history]`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct HistorySettings {
    /// FALSE keeps nothing.
    pub enabled: bool,
    /// MB (1,048,576 bytes) that `history.sqlite` may take: 1..=1,000,000. The oldest go first.
    pub max_mb: u32,
    /// Days that a run is kept: 1..=36,500.
    pub max_days: u32,
}

impl Default for HistorySettings {
    fn default() -> Self {
        Self { enabled: true, max_mb: 512, max_days: 30 }
    }
}

impl HistorySettings {
    pub(super) fn checked(self) -> Result<Self, SettingsError> {
        let rows = [("max_mb", self.max_mb, 1_000_000), ("max_days", self.max_days, 36_500)];
        match rows.into_iter().find(|(_, value, max)| !(1..=*max).contains(value)) {
            Some((key, value, max)) => Err(SettingsError::History { key, value, max }),
            None => Ok(self),
        }
    }
}
