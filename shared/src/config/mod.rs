//! What is stored: a block with the manual's names, and where it points.
//!
//! Numbers are wider than the manual's types, so that 300 or -1 arrives as a number and `plan` can say at which
//! field it is wrong. Members that this version does not know are kept and reported.

mod block;
mod block_config;
mod block_id;
mod channel;
mod device;
mod group;
mod hex;
mod msg_cip_generic;
mod number;
mod plant_id;
mod plc_address;
mod profile;
pub mod project;
mod send_req;
mod target_path;
mod variable;
mod words;

pub use self::block::Block;
pub use self::block_config::BlockConfig;
pub use self::block_id::BlockId;
pub use self::channel::{Channel, FurtherChannel, UnknownChannel};
pub use self::device::{Connecting, DEVICE_REQUESTS_PER_S, DEVICE_TIMEOUT_MS, Device, DeviceConfig};
pub use self::group::{GROUP_PERIOD_MS, Group, GroupConfig};
pub use self::hex::{HexError, HexErrorKind, read_hex, space_hex, write_hex};
pub use self::msg_cip_generic::{
    CipAppCfg, CipControlCfg, CipTargetCfg, Extra, MSG_CIPGENERIC, MsgCipGeneric,
};
pub use self::number::{NumberError, read_number};
pub use self::plant_id::{BadId, DeviceId, GroupId, VariableId};
pub use self::plc_address::{
    AddressDevice, AddressError, AddressErrorKind, AddressFunction, AddressMode, AddressPart, Needed,
    PlcAddress, Xway, device_target,
};
pub use self::profile::Profile;
pub use self::send_req::{DATA_EXCH, SEND_REQ, SendReq, SendReqDialect, SendReqForm};
pub use self::target_path::{CONTROLLER_HOPS, Endpoint, Host, MAX_PATH, PathError, Target, TargetPath};
pub use self::variable::{
    Choice, MAX_DEPTH, NewVariable, Variable, VariableConfig, full_addresses, join_address,
};
pub use self::words::{WordsError, WordsErrorKind, bytes_of, read_words, words_of, write_words};
pub use crate::tag::{Display as ValueDisplay, Scale};
