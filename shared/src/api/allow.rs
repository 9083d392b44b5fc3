//! The lists of what may be reached and written.

use alloc::string::String;
use alloc::vec::Vec;

use serde::{Deserialize, Serialize};

/// A target that may be reached.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct AllowedTarget {
    /// Names it for DELETE; none for one of the configuration file, which is changed there.
    pub id: Option<u64>,
    /// `192.168.1.10`, `192.168.1.0/24`, `plc-4.plant.local`, with `:PORT` or `:*`, and ` via 1,0` or ` via *`.
    pub target: String,
    /// Why it is there.
    #[serde(default)]
    pub note: String,
    /// Addresses that a name was resolved to; they hold until the lists change.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub pinned: Vec<String>,
}

/// `POST /api/v1/allow/targets`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct NewAllowedTarget {
    /// As in [`AllowedTarget`].
    pub target: String,
    /// Why it is there.
    #[serde(default)]
    pub note: String,
}

/// A write that an operator may send.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct AllowedWrite {
    /// Names it for DELETE; none for one of the configuration file.
    pub id: Option<u64>,
    /// What.
    #[serde(flatten)]
    pub write: NewAllowedWrite,
}

/// `POST /api/v1/allow/writes`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct NewAllowedWrite {
    /// As in [`AllowedTarget`]; the target has to be allowed as well.
    pub target: String,
    /// 1 to 127.
    #[cfg_attr(feature = "openapi", schema(minimum = 1, maximum = 127))]
    pub service: u8,
    /// The class.
    pub class: u16,
    /// Left out: any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub instance: Option<u32>,
    /// Left out: any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub attribute: Option<u16>,
    /// Why it is there.
    #[serde(default)]
    pub note: String,
}
