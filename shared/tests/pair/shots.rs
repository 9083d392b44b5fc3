//! Requests that tell themselves apart: the answer names its request.

use std::fmt::Write as _;

use cipdeck_shared::config::{Channel, MsgCipGeneric, Profile};
use cipdeck_shared::plan::MessagePlan;

/// Digits of a request's number.
const DIGITS: u32 = 9;

/// One block of a test.
#[derive(Clone, Debug)]
pub(crate) struct BlockSpec {
    /// Which device.
    pub(crate) device: usize,
    /// The hops behind it.
    pub(crate) route: &'static str,
    pub(crate) connected: bool,
    pub(crate) conn_close: bool,
    pub(crate) monitor: bool,
    /// ms; 0 = one shot.
    pub(crate) period: i64,
    /// ms; 0 = none.
    pub(crate) keep_alive: i64,
    pub(crate) profile: Profile,
    /// `UcmmTimeout` and `ConnMsgTimeout`, ms.
    pub(crate) timeouts: (i64, i64),
}

impl BlockSpec {
    pub(crate) const fn plain(device: usize) -> Self {
        Self {
            device,
            route: "",
            connected: false,
            conn_close: false,
            monitor: true,
            period: 0,
            keep_alive: 0,
            profile: Profile::Auto,
            timeouts: (1_000, 1_500),
        }
    }

    pub(crate) const fn connected(device: usize) -> Self {
        Self { connected: true, ..Self::plain(device) }
    }

    /// The plan of one message. A one-shot message reads a list of attributes that is its number; a cyclic one reads an
    /// input that says when it was read.
    pub(crate) fn plan(&self, number: u32) -> MessagePlan {
        let mut config = MsgCipGeneric::product_name(&format!("4,10.0.0.{}{}", self.device + 1, self.route));
        if self.period > 0 {
            (config.app_cfg.class, config.app_cfg.instance, config.app_cfg.attribute) = (4, 100, 3);
        } else {
            (config.app_cfg.service, config.app_cfg.attribute) = (3, 0);
            config.req_data.clear();
            let words = [&[u16::try_from(DIGITS).unwrap()][..], &digits(number)].concat();
            for byte in words.iter().flat_map(|word| word.to_le_bytes()) {
                write!(config.req_data, "{byte:02x}").unwrap();
            }
        }
        config.channel = if self.monitor { Channel::Monitor } else { Channel::Controller };
        (config.ctrl_cfg.trigger_type, config.keep_alive) = (self.period, self.keep_alive);
        config.profile = self.profile;
        config.target_cfg.cip_conn_mode = self.connected.into();
        config.target_cfg.conn_close = self.conn_close;
        (config.target_cfg.ucmm_timeout, config.target_cfg.conn_msg_timeout) = self.timeouts;
        let (plan, findings) = MessagePlan::parse(&config);
        plan.unwrap_or_else(|| panic!("{findings:?}"))
    }

    /// The longest that a message can take, µs.
    pub(crate) fn longest(&self) -> u64 {
        let (ucmm, connected) = self.timeouts;
        let millis = if self.connected { ucmm + connected } else { ucmm };
        u64::try_from(millis).unwrap() * 1_000
    }
}

/// A number as attributes 1 to 3 of the Identity object.
fn digits(number: u32) -> Vec<u16> {
    (0..DIGITS).map(|place| u16::try_from(number / 3_u32.pow(place) % 3 + 1).unwrap()).collect()
}

/// The number of the request that this list answers.
pub(crate) fn number_of(reply: &[u8]) -> u32 {
    // UINT count, then attribute, status and value: UINTs, all of them.
    let attributes = reply[2..].chunks_exact(6).map(|attribute| u32::from(attribute[0]).wrapping_sub(1));
    attributes.rev().fold(0, |number, digit| number.wrapping_mul(3).wrapping_add(digit))
}

/// When an input was read, µs.
pub(crate) fn time_of(reply: &[u8]) -> u64 {
    u64::from(u32::from_le_bytes([reply[0], reply[1], reply[2], reply[3]])) * 1_000
}
