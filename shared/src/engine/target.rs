//! How a target looks: its session, its connections, and what is peculiar about it.

use alloc::vec::Vec;

use serde::{Deserialize, Serialize};

use crate::config::Profile;
use crate::wire::Epath;

use super::status::Cause;
use super::time::Instant;

/// One endpoint.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TargetView {
    /// The TCP connection and its session.
    pub state: TargetState,
    /// The last time that the target did not answer, until it does.
    pub error: Option<Cause>,
    /// What the device has said that it is, if that mattered.
    pub profile: Option<Profile>,
    /// The target does not echo sender contexts.
    pub no_context: bool,
    /// The target's replies carry the connection id of the requests.
    pub own_connection_id: bool,
    /// Open class 3 connections.
    pub connections: Vec<ConnectionView>,
    /// Frames that answered nothing.
    pub dropped: u64,
    /// When something last went to or came from the target.
    pub last_used: Instant,
}

/// An open class 3 connection.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ConnectionView {
    /// The hops behind the TCP endpoint.
    pub route: Epath,
    /// Bytes of a packet.
    pub size: u16,
    /// Requests answered over it.
    pub requests: u64,
}

/// The TCP connection and its session.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
#[serde(rename_all = "lowercase")]
pub enum TargetState {
    /// No session: nothing has been sent yet, or it was closed after use.
    Closed,
    /// TCP and RegisterSession are under way.
    Connecting,
    /// A session is open.
    Open,
    /// UnRegisterSession has been sent.
    Closing,
    /// No session, because the target did not answer.
    Down,
}
