//! The configuration of a block, of either kind.

use alloc::string::{String, ToString};

use serde::{Deserialize, Deserializer, Serialize};
use serde_json::{Map, Value};

use super::channel::Channel;
use super::msg_cip_generic::MsgCipGeneric;
use super::profile::Profile;
use super::send_req::{DATA_EXCH, SEND_REQ, SendReq};

/// What a block is: its `kind` says which. One of an unknown kind is read as a `MSG_CIPGENERIC`, so that the finding
/// about its kind stands beside all others.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
#[serde(untagged)]
pub enum BlockConfig {
    /// Rockwell Micro800.
    MsgCipGeneric(MsgCipGeneric),
    /// Schneider Control Expert: `SEND_REQ` and `DATA_EXCH`.
    SendReq(SendReq),
}

impl BlockConfig {
    /// What the user calls it.
    pub fn name(&self) -> &str {
        match self {
            Self::MsgCipGeneric(config) => &config.name,
            Self::SendReq(config) => &config.name,
        }
    }

    /// Calls it something else.
    pub fn set_name(&mut self, name: String) {
        match self {
            Self::MsgCipGeneric(config) => config.name = name,
            Self::SendReq(config) => config.name = name,
        }
    }

    /// `MSG_CIPGENERIC`, `SEND_REQ` or `DATA_EXCH`; anything else is wrong.
    pub fn kind(&self) -> &str {
        match self {
            Self::MsgCipGeneric(config) => &config.kind,
            Self::SendReq(config) => &config.kind,
        }
    }

    /// Whose limits apply.
    pub const fn channel(&self) -> Channel {
        match self {
            Self::MsgCipGeneric(config) => config.channel,
            Self::SendReq(config) => config.channel,
        }
    }

    /// Whether it is to go on after a start of the relay.
    pub const fn resume(&self) -> bool {
        match self {
            Self::MsgCipGeneric(config) => config.resume,
            Self::SendReq(config) => config.resume,
        }
    }

    /// What kind of device the target is said to be.
    pub const fn profile(&self) -> Profile {
        match self {
            Self::MsgCipGeneric(config) => config.profile,
            Self::SendReq(config) => config.profile,
        }
    }

    /// `TargetCfg.Path` or `Address`, as it was typed.
    pub fn target_text(&self) -> &str {
        match self {
            Self::MsgCipGeneric(config) => &config.target_cfg.path,
            Self::SendReq(config) => &config.address,
        }
    }

    /// What the data of the request is.
    pub fn req_layout(&self) -> &str {
        match self {
            Self::MsgCipGeneric(config) => &config.req_layout,
            Self::SendReq(config) => &config.req_layout,
        }
    }

    /// What the data of the reply is.
    pub fn res_layout(&self) -> &str {
        match self {
            Self::MsgCipGeneric(config) => &config.res_layout,
            Self::SendReq(config) => &config.res_layout,
        }
    }

    /// The `MSG_CIPGENERIC`, if it is one.
    pub const fn as_msg(&self) -> Option<&MsgCipGeneric> {
        match self {
            Self::MsgCipGeneric(config) => Some(config),
            Self::SendReq(_) => None,
        }
    }

    /// The `SEND_REQ` or `DATA_EXCH`, if it is one.
    pub const fn as_send_req(&self) -> Option<&SendReq> {
        match self {
            Self::MsgCipGeneric(_) => None,
            Self::SendReq(config) => Some(config),
        }
    }

    /// By its members.
    pub fn from_members(members: Map<String, Value>) -> Result<Self, String> {
        let read: MsgCipGeneric =
            serde_json::from_value(Value::Object(members)).map_err(|error| error.to_string())?;
        Self::of_kind(read)
    }

    /// Everything is read as a `MSG_CIPGENERIC` first, whose unknown members have what is another kind's own: one way
    /// to read configurations instead of two saves 10 kB of the page.
    pub(super) fn of_kind(read: MsgCipGeneric) -> Result<Self, String> {
        match read.kind.as_str() {
            SEND_REQ | DATA_EXCH => read.try_into().map(Self::SendReq),
            _ => Ok(Self::MsgCipGeneric(read)),
        }
    }
}

impl From<MsgCipGeneric> for BlockConfig {
    fn from(config: MsgCipGeneric) -> Self {
        Self::MsgCipGeneric(config)
    }
}

impl From<SendReq> for BlockConfig {
    fn from(config: SendReq) -> Self {
        Self::SendReq(config)
    }
}

impl<'de> Deserialize<'de> for BlockConfig {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Self::of_kind(MsgCipGeneric::deserialize(deserializer)?).map_err(serde::de::Error::custom)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::{Block, SendReqForm};

    const STORED: &str = r#"{"id":"b8","revision":2,"name":"etc-identity","kind":"SEND_REQ","Dialect":"ETC101","Channel":"monitor","Resume":false,
        "Period":500,"Address":"ADDR('0.2.0')","Data_to_Send":"0000 7F00 0001 030E 0120 0124 0730",
        "Management_Param":[0,0,30,14],"Received_Data_Size":64,"Colour":"red"}"#;

    #[test]
    fn a_block_is_read_by_its_kind_and_keeps_what_nobody_knows() {
        let block: Block = serde_json::from_str(STORED).unwrap();
        let config = block.config.as_send_req().unwrap();
        assert_eq!(
            (config.form(), config.period, config.extra["Colour"].as_str()),
            (SendReqForm::Etc101, 500, Some("red"))
        );
        let again = serde_json::to_value(&block).unwrap();
        assert_eq!(again, serde_json::from_str::<Value>(STORED).unwrap());
    }

    #[test]
    fn what_is_missing_or_of_another_type_is_named() {
        for (cut, with, said) in [
            (r#""Address":"ADDR('0.2.0')","#, "", "missing field `Address`"),
            (r#""Period":500"#, r#""Period":1.5"#, "`Period`"),
            ("ETC101", "ETC102", "`Dialect`"),
        ] {
            let error = serde_json::from_str::<Block>(&STORED.replace(cut, with)).unwrap_err().to_string();
            assert!(error.contains(said), "{error}");
        }
    }
}
