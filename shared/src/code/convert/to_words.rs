//! `MSG_CIPGENERIC` → `SEND_REQ` or `DATA_EXCH`.

use alloc::string::{String, ToString};
use alloc::vec;
use alloc::vec::Vec;

use crate::code::change::{Change, Grade, Why};
use crate::config::{
    AddressDevice, AddressMode, Endpoint, Extra, Host, MsgCipGeneric, PlcAddress, SendReq, SendReqForm,
    Target, bytes_of, words_of, write_words,
};
use crate::plan::MessagePlan;

/// ms of one count of `Management_Param[2]`.
const STEP: u32 = 100;

/// Bytes of a reply before its data, without additional status.
pub(super) const REPLY_HEAD: i64 = 4;

/// Makes the words. Without a plan there are none: the block has errors.
pub(super) fn convert(msg: &MsgCipGeneric, form: SendReqForm, changes: &mut Vec<Change>) -> SendReq {
    let mut words = SendReq::new(form, &msg.name);
    common(msg, &mut words);
    unsaid(msg, changes);
    // A size with a finding may be any number.
    words.received_data_size = (msg.res_data_size.saturating_add(REPLY_HEAD + 1) / 2).max(2);
    if msg.res_data_size % 2 != 0 {
        let (from, to) = (msg.res_data_size, words.received_data_size);
        changes.push(Change::new(
            &"ResDataSize",
            &from,
            &alloc::format!("{to} words"),
            Grade::Carried,
            Why::WholeWords,
        ));
    }
    let Some(plan) = MessagePlan::parse(msg).0 else { return words };
    if !plan.routed(plan.profile()).route().is_empty() {
        let path = &msg.target_cfg.path;
        changes.push(Change::new(
            &"TargetCfg.Path",
            path,
            &"without its route",
            Grade::Request,
            Why::NoRoute,
        ));
    }
    let connected = plan.connection().is_some();
    let device = device(plan.target(), changes);
    words.address = address(form, device.clone(), connected);
    let assumed = Change::new(&"Address", &"", &words.address, Grade::Carried, Why::ModulePlace);
    changes.push(assumed);
    let head = head(form, &device, connected, changes);
    let bytes = [bytes_of(&head), plan.bytes().to_vec()].concat();
    words.data_to_send = write_words(&words_of(&bytes));
    let timeout = timeout(msg, &plan, changes);
    words.management_param = vec![0, 0, timeout, i64::try_from(bytes.len()).unwrap_or(i64::MAX)];
    words
}

fn common(msg: &MsgCipGeneric, words: &mut SendReq) {
    words.channel = msg.channel;
    words.resume = msg.resume;
    words.profile = msg.profile;
    words.keep_alive = msg.keep_alive;
    words.period = msg.ctrl_cfg.trigger_type;
    words.req_layout.clone_from(&msg.req_layout);
    words.res_layout.clone_from(&msg.res_layout);
    words.extra.clone_from(&msg.extra);
}

/// Members that the other side does not have.
fn unsaid(msg: &MsgCipGeneric, changes: &mut Vec<Change>) {
    let mut lost = |member: &str, from: &dyn ToString, why: Why| {
        changes.push(Change::new(&member, &from.to_string(), &"", Grade::Lost, why));
    };
    if msg.ctrl_cfg.str_mode != 0 {
        lost("CtrlCfg.StrMode", &msg.ctrl_cfg.str_mode, Why::NoSuchMember);
    }
    if msg.target_cfg.conn_close && msg.target_cfg.cip_conn_mode == 1 {
        lost("TargetCfg.ConnClose", &true, Why::ConnectionStays);
    }
    let nested: [(&str, &Extra); 3] = [
        ("CtrlCfg.", &msg.ctrl_cfg.extra),
        ("AppCfg.", &msg.app_cfg.extra),
        ("TargetCfg.", &msg.target_cfg.extra),
    ];
    for (prefix, extra) in nested {
        for (name, value) in extra {
            lost(&alloc::format!("{prefix}{name}"), value, Why::OursAlone);
        }
    }
}

/// Where the message goes; the built-in device and a name have no address there.
fn device(target: &Target, changes: &mut Vec<Change>) -> Endpoint {
    let none = Endpoint::of_ip([0; 4]);
    match target {
        Target::BuiltIn => none,
        Target::Network(endpoint) if matches!(endpoint.host, Host::Ip(_)) => endpoint.clone(),
        Target::Network(endpoint) => {
            let to = "0.0.0.0, the built-in simulated device";
            changes.push(Change::new(
                &"TargetCfg.Path",
                &endpoint.host,
                &to,
                Grade::Request,
                Why::NoHostName,
            ));
            none
        }
    }
}

/// The device in an address, if it stands there.
pub(super) fn addressed(form: SendReqForm, endpoint: Endpoint, connected: bool) -> Option<AddressDevice> {
    let mode = if connected { AddressMode::Connected } else { AddressMode::Unconnected };
    match form {
        SendReqForm::Etc100 => Some(AddressDevice::Dotted(endpoint)),
        SendReqForm::Etc101 => None,
        SendReqForm::DataExch => Some(AddressDevice::Braced(endpoint, mode)),
    }
}

/// Where the module is nobody knows: rack 0, module 2, channel 0, as in the examples.
fn address(form: SendReqForm, endpoint: Endpoint, connected: bool) -> String {
    let device = addressed(form, endpoint, connected);
    PlcAddress { function: None, xway: None, rack: 0, module: 2, channel: 0, device }.to_string()
}

/// The words before the CIP request.
pub(super) fn head(
    form: SendReqForm,
    device: &Endpoint,
    connected: bool,
    changes: &mut Vec<Change>,
) -> Vec<u16> {
    match form {
        SendReqForm::DataExch => Vec::new(),
        SendReqForm::Etc100 => vec![connected.into()],
        SendReqForm::Etc101 => {
            if device.has_unusual_port() {
                let to = Endpoint::of_ip([0; 4]).port;
                changes.push(Change::new(&"TCP port", &device.port, &to, Grade::Request, Why::NoTcpPort));
            }
            let ip = if let Host::Ip(ip) = device.host { ip } else { [0; 4] };
            let [a, b, c, d] = ip;
            vec![connected.into(), u16::from_be_bytes([a, b]), u16::from_be_bytes([c, d])]
        }
    }
}

/// `Management_Param[2]`.
fn timeout(msg: &MsgCipGeneric, plan: &MessagePlan, changes: &mut Vec<Change>) -> i64 {
    let ucmm = plan.ucmm_timeout_ms();
    let (member, used) = match plan.connection() {
        Some(connection) => ("TargetCfg.ConnMsgTimeout", connection.timeout_ms),
        None => ("TargetCfg.UcmmTimeout", ucmm),
    };
    let count = used.div_ceil(STEP);
    let to = alloc::format!("{} ms", count * STEP);
    if count * STEP != used {
        let from = alloc::format!("{used} ms");
        changes.push(Change::new(&member, &from, &to, Grade::Adjusted, Why::TimeoutStep(STEP)));
    }
    if plan.connection().is_some() && ucmm != used {
        let from = alloc::format!("{ucmm} ms");
        changes.push(Change::new(&"TargetCfg.UcmmTimeout", &from, &to, Grade::Adjusted, Why::OneTimeout));
    } else if plan.connection().is_none() && msg.target_cfg.conn_msg_timeout != 0 {
        let from = alloc::format!("{} ms", msg.target_cfg.conn_msg_timeout);
        changes.push(Change::new(&"TargetCfg.ConnMsgTimeout", &from, &"", Grade::Carried, Why::Unused));
    }
    count.into()
}
