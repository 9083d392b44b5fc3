//! The audit as the page reads it. docs/AUDIT.md describes the records.

use alloc::collections::BTreeMap;
use alloc::string::String;
use alloc::vec::Vec;

use serde::{Deserialize, Serialize};
use serde_json::Value;

/// One record.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct AuditRecord {
    /// Its number; the first one has 1.
    pub seq: u64,
    /// When (RFC 3339, microseconds, UTC).
    pub at: String,
    /// What has happened.
    pub event: String,
    /// Who: a name, `token:` or `view:` and a name, `local`, or `relay`.
    pub actor: String,
    /// The address of their machine, or empty.
    pub from: String,
    /// SHA-256 of the record before.
    pub prev: String,
    /// SHA-256 of this one.
    pub hash: String,
    /// What belongs to the event.
    #[serde(flatten)]
    pub members: BTreeMap<String, Value>,
}

/// `GET /api/v1/audit`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct AuditPage {
    /// The newest first.
    pub records: Vec<AuditRecord>,
    /// There may be older ones: ask again with this as `before`.
    pub more: Option<u64>,
}

/// `GET /api/v1/audit/state`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct AuditState {
    /// The number of the newest record.
    pub records: u64,
    /// False: nothing is written to a device.
    pub writable: bool,
    /// Why not, and what to do.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub trouble: Option<String>,
    /// The chain has been read from its beginning since the relay's start, and holds.
    pub verified: bool,
    /// The newest record. Whoever writes it down elsewhere can tell later that nothing before it was changed.
    pub head: AuditHead,
}

/// The end of the chain.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct AuditHead {
    /// Its number.
    pub seq: u64,
    /// Its SHA-256.
    pub hash: String,
}
