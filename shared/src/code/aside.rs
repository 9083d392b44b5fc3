//! The two kinds of blocks, until `config` has them.
#![allow(missing_docs, reason = "replaced by config::BlockConfig and config::SendReq")]

use alloc::string::String;
use alloc::vec::Vec;

use crate::config::{Channel, Extra, MsgCipGeneric, Profile};

#[derive(Clone, Debug, PartialEq)]
pub enum BlockConfig {
    MsgCipGeneric(MsgCipGeneric),
    SendReq(SendReq),
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SendReqDialect {
    #[default]
    Etc100,
    Etc101,
}

#[derive(Clone, Debug, PartialEq)]
pub struct SendReq {
    pub name: String,
    pub kind: String,
    pub dialect: Option<SendReqDialect>,
    pub channel: Channel,
    pub resume: bool,
    pub profile: Profile,
    pub keep_alive: i64,
    pub period: i64,
    pub address: String,
    pub request_code: i64,
    pub exchange_type: i64,
    pub data_to_send: String,
    pub management_param: Vec<i64>,
    pub received_data_size: i64,
    pub req_layout: String,
    pub res_layout: String,
    pub extra: Extra,
}

impl BlockConfig {
    pub fn name(&self) -> &str {
        match self {
            Self::MsgCipGeneric(config) => &config.name,
            Self::SendReq(config) => &config.name,
        }
    }

    pub fn kind(&self) -> &str {
        match self {
            Self::MsgCipGeneric(config) => &config.kind,
            Self::SendReq(config) => &config.kind,
        }
    }

    pub const fn as_msg(&self) -> Option<&MsgCipGeneric> {
        match self {
            Self::MsgCipGeneric(config) => Some(config),
            Self::SendReq(_) => None,
        }
    }

    pub const fn as_send_req(&self) -> Option<&SendReq> {
        match self {
            Self::MsgCipGeneric(_) => None,
            Self::SendReq(config) => Some(config),
        }
    }
}

impl From<MsgCipGeneric> for BlockConfig {
    fn from(config: MsgCipGeneric) -> Self {
        Self::MsgCipGeneric(config)
    }
}
