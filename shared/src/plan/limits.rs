//! Limits of the block, each with its source.

/// Upper bound of request data. 2080-RM001D p. 196 (confirmed for CIP serial; headers may leave less).
pub const MAX_REQUEST_DATA: usize = 490;

/// Size limits of `ResData`: as the request's.
pub const MAX_RESPONSE_DATA: i64 = 490;

/// Usual limit of a whole unconnected message: service, path size, path and data. Panasonic FP7 EIPMBODY table.
pub const USUAL_MESSAGE: usize = 504;

/// Characters of a block's name. Our own limit.
pub const MAX_NAME: usize = 64;

/// A timeout of the manual: 0 is the default, everything else is moved into the range.
#[derive(Clone, Copy, Debug)]
pub struct TimeoutRange {
    /// ms
    pub default: u32,
    /// ms
    pub min: u32,
    /// ms
    pub max: u32,
}

/// `UcmmTimeout`. Document 13032001 on Micro800 CIP messages, CIPTARGETCFG.
pub const UCMM_TIMEOUT: TimeoutRange = TimeoutRange { default: 3_000, min: 250, max: 10_000 };

/// `KeepAlive`. Our own limits: more often is polling, which a cyclic block does.
pub const KEEP_ALIVE: TimeoutRange = TimeoutRange { default: 0, min: 1_000, max: 60_000 };

/// `ConnMsgTimeout`. Document 13032001 on Micro800 CIP messages, CIPTARGETCFG.
pub const CONN_MSG_TIMEOUT: TimeoutRange = TimeoutRange { default: 10_000, min: 800, max: 10_000 };

/// A timeout that never comes: `Management_Param[2]` 0. Control Expert help D-SE-0006482.
pub const FOR_EVER: u32 = u32::MAX;

/// Words of `Received_Data`: service and status, up to 1 KiB. Our own limits.
pub const RECEIVED_WORDS: core::ops::RangeInclusive<i64> = 2..=512;
