//! `[local]` and `[[allow.…]]`: who acts without signing in, and what may be reached.

use cipdeck_shared::api::{NewAllowedTarget, NewAllowedWrite, Role};
use serde::Deserialize;

/// The lists of the configuration file.
#[derive(Clone, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Allow {
    /// `[[allow.target]]`
    #[serde(default)]
    pub target: Vec<NewAllowedTarget>,
    /// `[[allow.write]]`
    #[serde(default)]
    pub write: Vec<NewAllowedWrite>,
}

/// `[local]`
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Local {
    /// `role = "engineer"`
    pub role: Role,
}
