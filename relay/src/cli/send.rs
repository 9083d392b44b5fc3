//! `cipdeck send`.

use cipdeck_shared::config::{MsgCipGeneric, read_number};
use clap::Args;

use super::Exit;
use super::once::{Mode, execute};

/// One message, spelled out.
#[derive(Debug, Args)]
#[command(after_help = "Numbers are decimal, or marked as hexadecimal: 147, 0x93, 93h, 16#93")]
pub(super) struct Send {
    /// Where to, as in TargetCfg.Path: 4,192.168.1.100
    #[arg(value_name = "PATH")]
    path: String,
    /// AppCfg.Service, 1 to 127
    #[arg(long, value_name = "N", value_parser = number, allow_negative_numbers = true)]
    service: i64,
    /// AppCfg.Class, 1 to 65535
    #[arg(long, value_name = "N", value_parser = number, allow_negative_numbers = true)]
    class: i64,
    /// AppCfg.Instance, 0 to 4294967295
    #[arg(long, value_name = "N", value_parser = number, allow_negative_numbers = true)]
    instance: i64,
    /// AppCfg.Attribute, 1 to 65535; 0 = none
    #[arg(long, value_name = "N", value_parser = number, allow_negative_numbers = true, default_value = "0")]
    attribute: i64,
    /// AppCfg.MemberId, up to three times, 0 to 65535 each
    #[arg(long = "member", value_name = "N", value_parser = number, allow_negative_numbers = true)]
    members: Vec<i64>,
    /// ReqData: bytes in hexadecimal, such as 0a0b or "0A 0B"
    #[arg(long, value_name = "HEX", default_value = "")]
    data: String,
    /// CipConnMode 1: over a class 3 connection
    #[arg(long)]
    connected: bool,
    /// UcmmTimeout, and ConnMsgTimeout with --connected; 0 = default
    #[arg(long, value_name = "MS", value_parser = number, allow_negative_numbers = true, default_value = "0")]
    timeout: i64,
    #[command(flatten)]
    mode: Mode,
}

impl Send {
    /// Sends and prints.
    pub(super) async fn execute(self) -> Exit {
        let mode = self.mode.clone();
        execute(&self.config().into(), &mode).await
    }

    fn config(self) -> MsgCipGeneric {
        let mut config = MsgCipGeneric::product_name(&self.path);
        "send".clone_into(&mut config.name);
        let app = &mut config.app_cfg;
        (app.service, app.class, app.instance) = (self.service, self.class, self.instance);
        app.attribute = self.attribute;
        app.member_cnt = i64::try_from(self.members.len()).unwrap_or(i64::MAX);
        app.member_id = self.members;
        // Too many are told by MemberCnt; too few are filled up as the array of the block is.
        app.member_id.resize(3, 0);
        let target = &mut config.target_cfg;
        target.cip_conn_mode = self.connected.into();
        target.ucmm_timeout = self.timeout;
        if self.connected {
            target.conn_msg_timeout = self.timeout;
        }
        config.req_data = self.data;
        config
    }
}

fn number(text: &str) -> Result<i64, String> {
    read_number(text).map_err(|error| error.to_string())
}
