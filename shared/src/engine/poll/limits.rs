//! What a device takes in one message, and how often it may be asked.

use crate::tag::Dialect;

/// Sizes are those of message router requests and replies, without what wraps them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DeviceLimits {
    /// How it lays values out, and which services read what is long.
    pub dialect: Dialect,
    /// Whether it takes several requests in one (Multiple Service Packet).
    pub packs: bool,
    /// Bytes of the longest request.
    pub request_max: usize,
    /// Bytes of the longest reply.
    pub reply_max: usize,
    /// Requests per second; 0 is no limit.
    pub max_requests_per_s: u32,
}

/// An unconnected message: libplctag and Panasonic FP7 EIPMBODY.
const UNCONNECTED: usize = 504;

/// An unconnected message of an Omron: aphyt `MAXIMUM_LENGTH`.
const OMRON_UNCONNECTED: usize = 502;

/// Connections as we open them (libplctag): 4,002 bytes to a Logix, 1,994 to an Omron, 504 to a Micro800. The sequence
/// count takes two of them.
const LOGIX_CONNECTED: usize = 4_000;
const OMRON_CONNECTED: usize = 1_992;
const MICRO800_CONNECTED: usize = 502;

impl DeviceLimits {
    /// What libplctag found for the family. A Micro800 refuses packets of several requests.
    pub const fn of(dialect: Dialect, connected: bool) -> Self {
        let bytes = match (dialect, connected) {
            (Dialect::Logix, true) => LOGIX_CONNECTED,
            (Dialect::Omron, true) => OMRON_CONNECTED,
            (Dialect::Micro800, true) => MICRO800_CONNECTED,
            (Dialect::Omron, false) => OMRON_UNCONNECTED,
            (_, false) => UNCONNECTED,
        };
        Self {
            dialect,
            packs: !matches!(dialect, Dialect::Micro800),
            request_max: bytes,
            reply_max: bytes,
            max_requests_per_s: 0,
        }
    }
}
