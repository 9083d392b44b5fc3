//! `SEND_REQ` and `DATA_EXCH`: the inputs of Control Expert's blocks for explicit messages, spelled as its help does.
//!
//! Source: "Configuring explicit messaging using SEND_REQ" (TSX ETC 100), Control Expert help for TSX ETC 101 and
//! BMX NOC 0401.

use alloc::string::{String, ToString};
use alloc::vec::Vec;
use core::fmt;

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::channel::Channel;
use super::msg_cip_generic::{Extra, MsgCipGeneric, is_default};
use super::profile::Profile;

/// The `kind` of a block for TSX ETC 100 and TSX ETC 101.
pub const SEND_REQ: &str = "SEND_REQ";

/// The `kind` of a block for BMX NOC 0401 and M580.
pub const DATA_EXCH: &str = "DATA_EXCH";

/// The configuration of a `SEND_REQ`, or of a `DATA_EXCH`, which differs in its address and has no message type word.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub struct SendReq {
    /// What the user calls it.
    pub name: String,
    /// [`SEND_REQ`] or [`DATA_EXCH`].
    pub kind: String,
    /// Which module a `SEND_REQ` is for; absent = [`SendReqDialect::Etc100`]. A `DATA_EXCH` has none.
    #[serde(rename = "Dialect", default, skip_serializing_if = "Option::is_none")]
    pub dialect: Option<SendReqDialect>,
    /// Whose limits apply.
    #[serde(rename = "Channel", default)]
    pub channel: Channel,
    /// Restore EN after a start of the relay; for reads only.
    #[serde(rename = "Resume", default)]
    pub resume: bool,
    /// What kind of device the target is.
    #[serde(rename = "Profile", default, skip_serializing_if = "is_default")]
    pub profile: Profile,
    /// ms; the idle session is kept alive by a read every so often. 0 = it is not; 1000..=60000.
    #[serde(rename = "KeepAlive", default, skip_serializing_if = "is_default")]
    pub keep_alive: i64,
    /// ms; what the program around the block does: 0 = one exchange per rising edge of EN; 1..=65535 = the next one
    /// so long after the start of the last, while EN is TRUE.
    #[serde(rename = "Period", default)]
    pub period: i64,
    /// `ADDR('0.2.0.192.168.1.102')`, as it is written in the program.
    #[serde(rename = "Address")]
    pub address: String,
    /// Always 14 (16#000E), a CIP request; `SEND_REQ` only.
    #[serde(rename = "Request_Code", default = "request_code", skip_serializing_if = "is_request_code")]
    pub request_code: i64,
    /// 1 = transmission, then reception; `DATA_EXCH` only.
    #[serde(rename = "Type", default = "exchange_type", skip_serializing_if = "is_exchange_type")]
    pub exchange_type: i64,
    /// Words as hexadecimal text, `0000 030E 0120`: low byte first on the wire.
    #[serde(rename = "Data_to_Send")]
    pub data_to_send: String,
    /// Four words. The first two are the system's. `[2]`: timeout x 100 ms, 0 = for ever. `[3]`: bytes of
    /// `Data_to_Send`.
    #[serde(rename = "Management_Param", default = "management_param")]
    pub management_param: Vec<i64>,
    /// Words of the array `Received_Data`. 2..=512.
    #[serde(rename = "Received_Data_Size", default = "received_data_size")]
    pub received_data_size: i64,
    /// What the bytes of the CIP request's data are: `REAL`, or `speed: REAL; run: BOOL`. Empty: nobody says.
    #[serde(rename = "ReqLayout", default, skip_serializing_if = "String::is_empty")]
    pub req_layout: String,
    /// What the bytes of the CIP reply's data are. Empty: as the attribute is known, or a guess.
    #[serde(rename = "ResLayout", default, skip_serializing_if = "String::is_empty")]
    pub res_layout: String,
    /// Unknown members.
    #[serde(flatten)]
    #[cfg_attr(feature = "openapi", schema(ignore))]
    pub extra: Extra,
}

/// The module that a `SEND_REQ` goes through.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[cfg_attr(feature = "openapi", derive(utoipa::ToSchema))]
pub enum SendReqDialect {
    /// TSX ETC 100: the IP address is in `Address`.
    #[default]
    #[serde(rename = "ETC100")]
    Etc100,
    /// TSX ETC 101: the IP address is in words 1 and 2 of `Data_to_Send`.
    #[serde(rename = "ETC101")]
    Etc101,
}

/// How a block's words are laid out.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum SendReqForm {
    /// Word 0 is the message type, the CIP request begins at byte 2, the IP address is in `Address`.
    Etc100,
    /// Word 0 is the message type, words 1 and 2 the IP address, the CIP request begins at byte 6.
    Etc101,
    /// The CIP request begins at byte 0; address and message type are in `Address`.
    DataExch,
}

impl SendReqForm {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Etc100, Self::Etc101, Self::DataExch];

    /// Words before the CIP request.
    pub const fn head(self) -> usize {
        match self {
            Self::Etc100 => 1,
            Self::Etc101 => 3,
            Self::DataExch => 0,
        }
    }

    /// The `kind` of such a block.
    pub const fn kind(self) -> &'static str {
        match self {
            Self::Etc100 | Self::Etc101 => SEND_REQ,
            Self::DataExch => DATA_EXCH,
        }
    }

    /// The `Dialect` of such a block.
    pub const fn dialect(self) -> Option<SendReqDialect> {
        match self {
            Self::Etc100 => Some(SendReqDialect::Etc100),
            Self::Etc101 => Some(SendReqDialect::Etc101),
            Self::DataExch => None,
        }
    }
}

/// `SEND_REQ for TSX ETC 100` …
impl fmt::Display for SendReqForm {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Etc100 => "SEND_REQ for TSX ETC 100",
            Self::Etc101 => "SEND_REQ for TSX ETC 101",
            Self::DataExch => "DATA_EXCH",
        })
    }
}

impl SendReq {
    /// A block with nothing to send yet: 3 s to answer, 247 words for the reply.
    pub fn new(form: SendReqForm, name: &str) -> Self {
        Self {
            name: name.to_string(),
            kind: form.kind().to_string(),
            dialect: form.dialect(),
            channel: Channel::Controller,
            resume: false,
            profile: Profile::Auto,
            keep_alive: 0,
            period: 0,
            address: String::new(),
            request_code: request_code(),
            exchange_type: exchange_type(),
            data_to_send: String::new(),
            management_param: management_param(),
            received_data_size: received_data_size(),
            req_layout: String::new(),
            res_layout: String::new(),
            extra: Extra::new(),
        }
    }

    /// How its words are laid out.
    pub fn form(&self) -> SendReqForm {
        match (self.kind.as_str(), self.dialect.unwrap_or_default()) {
            (DATA_EXCH, _) => SendReqForm::DataExch,
            (_, SendReqDialect::Etc100) => SendReqForm::Etc100,
            (_, SendReqDialect::Etc101) => SendReqForm::Etc101,
        }
    }
}

/// Members that a block of words does not have.
const NOT_OURS: &str =
    "`CtrlCfg`, `AppCfg`, `TargetCfg`, `ReqData`, `ReqLength` and `ResDataSize` belong to MSG_CIPGENERIC";

/// By hand, of a block that has been read already: what serde derives is several times as much of the page.
impl TryFrom<MsgCipGeneric> for SendReq {
    type Error = String;

    fn try_from(read: MsgCipGeneric) -> Result<Self, String> {
        let empty = MsgCipGeneric::empty();
        let own = (
            &read.ctrl_cfg,
            &read.app_cfg,
            &read.target_cfg,
            &read.req_data,
            read.req_length,
            read.res_data_size,
        );
        if own
            != (
                &empty.ctrl_cfg,
                &empty.app_cfg,
                &empty.target_cfg,
                &empty.req_data,
                empty.req_length,
                empty.res_data_size,
            )
        {
            return Err(NOT_OURS.to_string());
        }
        let mut members = Members(read.extra);
        Ok(Self {
            name: read.name,
            kind: read.kind,
            dialect: members.dialect()?,
            channel: read.channel,
            resume: read.resume,
            profile: read.profile,
            keep_alive: read.keep_alive,
            period: members.number("Period", 0)?,
            address: members.text("Address")?,
            request_code: members.number("Request_Code", request_code())?,
            exchange_type: members.number("Type", exchange_type())?,
            data_to_send: members.text("Data_to_Send")?,
            management_param: members.numbers("Management_Param")?,
            received_data_size: members.number("Received_Data_Size", received_data_size())?,
            req_layout: read.req_layout,
            res_layout: read.res_layout,
            extra: members.0,
        })
    }
}

/// The members of a block that have not been taken yet.
struct Members(Extra);

impl Members {
    fn text(&mut self, name: &str) -> Result<String, String> {
        match self.0.remove(name) {
            Some(Value::String(text)) => Ok(text),
            Some(_) => Err(alloc::format!("`{name}` is a text")),
            None => Err(alloc::format!("missing field `{name}`")),
        }
    }

    fn number(&mut self, name: &str, default: i64) -> Result<i64, String> {
        let Some(value) = self.0.remove(name) else { return Ok(default) };
        value.as_i64().ok_or_else(|| alloc::format!("`{name}` is a whole number"))
    }

    fn numbers(&mut self, name: &str) -> Result<Vec<i64>, String> {
        let Some(value) = self.0.remove(name) else { return Ok(management_param()) };
        let numbers = value.as_array().and_then(|all| all.iter().map(Value::as_i64).collect());
        numbers.ok_or_else(|| alloc::format!("`{name}` is a list of whole numbers"))
    }

    fn dialect(&mut self) -> Result<Option<SendReqDialect>, String> {
        match self.0.remove("Dialect").as_ref().map(|value| value.as_str()) {
            None => Ok(None),
            Some(Some("ETC100")) => Ok(Some(SendReqDialect::Etc100)),
            Some(Some("ETC101")) => Ok(Some(SendReqDialect::Etc101)),
            Some(_) => Err("`Dialect` is ETC100 or ETC101".to_string()),
        }
    }
}

const fn request_code() -> i64 {
    14
}

#[allow(clippy::trivially_copy_pass_by_ref, reason = "serde passes references; on wasm32 it is no finding")]
const fn is_request_code(code: &i64) -> bool {
    *code == request_code()
}

const fn exchange_type() -> i64 {
    1
}

#[allow(clippy::trivially_copy_pass_by_ref, reason = "serde passes references; on wasm32 it is no finding")]
const fn is_exchange_type(code: &i64) -> bool {
    *code == exchange_type()
}

fn management_param() -> Vec<i64> {
    alloc::vec![0, 0, 30, 0]
}

/// A reply with as much data as a `MSG_CIPGENERIC` takes: 490 bytes behind a head of four.
const fn received_data_size() -> i64 {
    247
}
