//! A target in JSON.

use alloc::string::{String, ToString};
use alloc::vec::Vec;

use serde::{Deserialize, Serialize};

use crate::config::{Profile, Target};
use crate::engine::{Cause, TargetState, TargetView};
use crate::wire::{Epath, Segment};

/// One endpoint: its session, its connections, and what is peculiar about it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct TargetStatus {
    /// `192.168.1.100:44818`, or `0,0` for the built-in device.
    pub target: String,
    /// The TCP connection and its session.
    pub state: TargetState,
    /// Since when it is in this state.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub since: Option<String>,
    /// The last time that the target did not answer, until it does.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub error: Option<Cause>,
    /// What the device has said that it is, if that mattered for a message.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub profile: Option<Profile>,
    /// The target does not echo sender contexts: its replies are matched by their order alone.
    #[serde(default, skip_serializing_if = "core::ops::Not::not")]
    pub no_context: bool,
    /// The target's replies carry the connection id of the requests.
    #[serde(default, skip_serializing_if = "core::ops::Not::not")]
    pub own_connection_id: bool,
    /// Open class 3 connections.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub connections: Vec<ConnectionStatus>,
    /// Frames that answered nothing, since the relay started.
    pub dropped: u64,
    /// ms since something last went to or came from the target; at the moment of this message.
    pub idle_ms: u64,
}

/// An open class 3 connection.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct ConnectionStatus {
    /// The hops behind the TCP endpoint, as in a path: `1,0`; empty for the endpoint itself.
    pub route: String,
    /// Bytes of a packet.
    pub size: u16,
    /// Requests answered over it, when this was told.
    pub requests: u64,
}

impl TargetStatus {
    /// From what the engine shows.
    pub fn new(target: &Target, view: &TargetView, since: Option<String>, idle_ms: u64) -> Self {
        let connections = view.connections.iter().map(|connection| ConnectionStatus {
            route: hops(&connection.route),
            size: connection.size,
            requests: connection.requests,
        });
        Self {
            target: target.to_string(),
            state: view.state,
            since,
            error: view.error.clone(),
            profile: view.profile,
            no_context: view.no_context,
            own_connection_id: view.own_connection_id,
            connections: connections.collect(),
            dropped: view.dropped,
            idle_ms,
        }
    }
}

/// A route as it is written in a path.
fn hops(route: &Epath) -> String {
    let hops: Vec<_> = route.segments().iter().filter_map(hop).collect();
    hops.join(",")
}

fn hop(segment: &Segment) -> Option<String> {
    let Segment::Port(port) = segment else { return None };
    let address = match (port.slot(), port.address()) {
        (Some(slot), _) => slot.to_string(),
        (None, Some(address)) => address.to_string(),
        (None, None) => "?".to_string(),
    };
    Some(alloc::format!("{},{address}", port.port()))
}
