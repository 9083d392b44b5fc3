//! `MSG_CIPGENERIC`: the block's inputs, spelled as the manual spells them.

use alloc::collections::BTreeMap;
use alloc::string::{String, ToString};
use alloc::vec::Vec;

use serde::{Deserialize, Serialize};

use super::channel::Channel;
use super::profile::Profile;

/// The `kind` of a block of the Micro800.
pub const MSG_CIPGENERIC: &str = "MSG_CIPGENERIC";

/// Members that this version does not know. They are kept.
pub type Extra = BTreeMap<String, serde_json::Value>;

/// The configuration of one block.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct MsgCipGeneric {
    /// What the user calls it.
    pub name: String,
    /// [`MSG_CIPGENERIC`].
    #[serde(default = "kind")]
    pub kind: String,
    /// Whose limits apply.
    #[serde(rename = "Channel", default)]
    pub channel: Channel,
    /// Restore IN after a start of the relay; for reads only.
    #[serde(rename = "Resume", default)]
    pub resume: bool,
    /// What kind of device the target is.
    #[serde(rename = "Profile", default, skip_serializing_if = "is_default")]
    pub profile: Profile,
    /// ms; the idle session is kept alive by a read every so often. 0 = it is not; 1000..=60000.
    #[serde(rename = "KeepAlive", default, skip_serializing_if = "is_default")]
    pub keep_alive: i64,
    /// When to trigger.
    #[serde(rename = "CtrlCfg", default)]
    pub ctrl_cfg: CipControlCfg,
    /// Service and path.
    #[serde(rename = "AppCfg", default)]
    pub app_cfg: CipAppCfg,
    /// Device and timeouts.
    #[serde(rename = "TargetCfg", default)]
    pub target_cfg: CipTargetCfg,
    /// Request data as hexadecimal text.
    #[serde(rename = "ReqData", default)]
    pub req_data: String,
    /// How many bytes of `ReqData` are sent; absent = all. 0..=490.
    #[serde(rename = "ReqLength", default, skip_serializing_if = "Option::is_none")]
    pub req_length: Option<i64>,
    /// Size of the `ResData` array. 1..=490.
    #[serde(rename = "ResDataSize", default = "res_data_size")]
    pub res_data_size: i64,
    /// What the bytes of `ReqData` are: `REAL`, or `speed: REAL; run: BOOL`. Empty: nobody says.
    #[serde(rename = "ReqLayout", default, skip_serializing_if = "String::is_empty")]
    pub req_layout: String,
    /// What the bytes of `ResData` are. Empty: as the attribute is known, or a guess.
    #[serde(rename = "ResLayout", default, skip_serializing_if = "String::is_empty")]
    pub res_layout: String,
    /// Unknown members.
    #[serde(flatten)]
    #[cfg_attr(feature = "openapi", schema(ignore))]
    pub extra: Extra,
}

/// CIPCONTROLCFG: execution of the block.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct CipControlCfg {
    /// An input, stored FALSE.
    #[serde(rename = "Cancel", default)]
    pub cancel: bool,
    /// 0 = once per rising edge of IN; 1..=65535 = period in ms while IN is TRUE.
    #[serde(rename = "TriggerType", default)]
    pub trigger_type: i64,
    /// Reserved.
    #[serde(rename = "StrMode", default)]
    pub str_mode: i64,
    /// Unknown members.
    #[serde(flatten)]
    #[cfg_attr(feature = "openapi", schema(ignore))]
    pub extra: Extra,
}

/// CIPAPPCFG: service and path. 2080-RM001D p. 189.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct CipAppCfg {
    /// 1..=127.
    #[serde(rename = "Service")]
    pub service: i64,
    /// 1..=65535.
    #[serde(rename = "Class")]
    pub class: i64,
    /// 0..=4294967295.
    #[serde(rename = "Instance")]
    pub instance: i64,
    /// 1..=65535; 0 = no attribute segment.
    #[serde(rename = "Attribute", default)]
    pub attribute: i64,
    /// 0..=3 member segments.
    #[serde(rename = "MemberCnt", default)]
    pub member_cnt: i64,
    /// 0..=65535 each.
    #[serde(rename = "MemberId", default = "member_id")]
    pub member_id: Vec<i64>,
    /// Unknown members.
    #[serde(flatten)]
    #[cfg_attr(feature = "openapi", schema(ignore))]
    pub extra: Extra,
}

/// CIPTARGETCFG: device, connection mode and timeouts.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct CipTargetCfg {
    /// `"4,192.168.1.100"`: at most 80 characters and two hops.
    #[serde(rename = "Path")]
    pub path: String,
    /// 0 = unconnected, 1 = class 3 connection.
    #[serde(rename = "CipConnMode", default)]
    pub cip_conn_mode: i64,
    /// ms; 0 = 3000; 250..=10000.
    #[serde(rename = "UcmmTimeout", default)]
    pub ucmm_timeout: i64,
    /// ms; 0 = 10000; 800..=10000.
    #[serde(rename = "ConnMsgTimeout", default)]
    pub conn_msg_timeout: i64,
    /// Close the connection when the message completes.
    #[serde(rename = "ConnClose", default)]
    pub conn_close: bool,
    /// Unknown members.
    #[serde(flatten)]
    #[cfg_attr(feature = "openapi", schema(ignore))]
    pub extra: Extra,
}

/// Nothing is asked: one that is left out has errors at its numbers.
impl Default for CipAppCfg {
    fn default() -> Self {
        Self {
            service: 0,
            class: 0,
            instance: 0,
            attribute: 0,
            member_cnt: 0,
            member_id: member_id(),
            extra: Extra::new(),
        }
    }
}

impl MsgCipGeneric {
    /// Without a name, a request and a device.
    pub(super) fn empty() -> Self {
        Self {
            name: String::new(),
            kind: kind(),
            channel: Channel::Controller,
            resume: false,
            profile: Profile::Auto,
            keep_alive: 0,
            ctrl_cfg: CipControlCfg::default(),
            app_cfg: CipAppCfg::default(),
            target_cfg: CipTargetCfg::default(),
            req_data: String::new(),
            req_length: None,
            res_data_size: res_data_size(),
            req_layout: String::new(),
            res_layout: String::new(),
            extra: Extra::new(),
        }
    }

    /// The product name of a device: what the first message usually is.
    pub fn product_name(path: &str) -> Self {
        Self {
            name: "product-name".to_string(),
            app_cfg: CipAppCfg { service: 14, class: 1, instance: 1, attribute: 7, ..CipAppCfg::default() },
            target_cfg: CipTargetCfg { path: path.to_string(), ..CipTargetCfg::default() },
            ..Self::empty()
        }
    }
}

fn kind() -> String {
    MSG_CIPGENERIC.to_string()
}

pub(super) fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}

fn member_id() -> Vec<i64> {
    alloc::vec![0; 3]
}

const fn res_data_size() -> i64 {
    490
}

#[cfg(test)]
mod tests {
    use crate::config::Block;

    const STORED: &str = r#"{"id":"b7","revision":3,"name":"drive-current","kind":"MSG_CIPGENERIC","Channel":"controller","Resume":false,
        "CtrlCfg":{"Cancel":false,"TriggerType":0,"StrMode":0},
        "AppCfg":{"Service":300,"Class":-1,"Instance":1,"Attribute":7,"MemberCnt":0,"MemberId":[0,0,0],"Extended":true},
        "TargetCfg":{"Path":"4,192.168.1.100","CipConnMode":0,"UcmmTimeout":0,"ConnMsgTimeout":0,"ConnClose":false},
        "ReqData":"","ReqLength":0,"ResDataSize":490,"Colour":"red"}"#;

    #[test]
    fn a_stored_block_keeps_wrong_numbers_and_unknown_members() {
        let block: Block = serde_json::from_str(STORED).unwrap();
        let config = block.config.as_msg().unwrap();
        assert_eq!((config.app_cfg.service, config.app_cfg.class), (300, -1));
        assert_eq!(config.extra["Colour"], "red");
        assert_eq!(config.app_cfg.extra["Extended"], true);
        let again = serde_json::to_value(&block).unwrap();
        assert_eq!(again, serde_json::from_str::<serde_json::Value>(STORED).unwrap());
    }

    #[test]
    fn a_number_that_is_not_whole_is_refused() {
        let text = STORED.replace("\"Service\":300", "\"Service\":1.5");
        assert!(serde_json::from_str::<Block>(&text).is_err());
    }
}
