//! `SEND_REQ` or `DATA_EXCH` → `MSG_CIPGENERIC`.

use alloc::string::{String, ToString};
use alloc::vec::Vec;

use super::to_words::REPLY_HEAD;
use crate::code::change::{Change, Grade, Why};
use crate::config::{MsgCipGeneric, PlcAddress, SendReq, Target, write_hex};
use crate::plan::MessagePlan;
use crate::plan::limits::{
    CONN_MSG_TIMEOUT, MAX_REQUEST_DATA, MAX_RESPONSE_DATA, TimeoutRange, UCMM_TIMEOUT,
};
use crate::wire::{Epath, LogicalKind, Segment};

/// Reads the words. Without a plan nothing of them is known: the block has errors.
pub(super) fn convert(words: &SendReq, changes: &mut Vec<Change>) -> MsgCipGeneric {
    let mut msg = MsgCipGeneric::product_name("");
    common(words, &mut msg);
    let size = words.received_data_size.saturating_mul(2).saturating_sub(REPLY_HEAD);
    msg.res_data_size = size.clamp(1, MAX_RESPONSE_DATA);
    if size > MAX_RESPONSE_DATA {
        let from = alloc::format!("{size} bytes");
        let why = Why::DataLimit(MAX_REQUEST_DATA);
        changes.push(Change::new(&"Received_Data_Size", &from, &MAX_RESPONSE_DATA, Grade::Adjusted, why));
    }
    let Some(plan) = MessagePlan::of(&words.clone().into()).0 else { return msg };
    msg.target_cfg.path = path(plan.target());
    place(&words.address, changes);
    let app = &mut msg.app_cfg;
    app.service = plan.request().service().0.into();
    if !object(plan.request().path(), &mut msg) {
        let from = write_hex(&plan.request().path().bytes());
        let said = MessagePlan::parse(&msg).0.map(|plan| write_hex(&plan.request().path().bytes()));
        changes.push(Change::new(
            &"path",
            &from,
            &said.unwrap_or_default(),
            Grade::Request,
            Why::OtherSegments,
        ));
    }
    let data = plan.request().data();
    msg.req_data = write_hex(data);
    if data.len() > MAX_REQUEST_DATA {
        let from = alloc::format!("{} bytes", data.len());
        let why = Why::DataLimit(MAX_REQUEST_DATA);
        changes.push(Change::new(&"Data_to_Send", &from, &"", Grade::Request, why));
    }
    let connected = plan.connection().is_some();
    msg.target_cfg.cip_conn_mode = connected.into();
    timeouts(words, connected, &mut msg, changes);
    msg
}

fn common(words: &SendReq, msg: &mut MsgCipGeneric) {
    msg.name.clone_from(&words.name);
    msg.channel = words.channel;
    msg.resume = words.resume;
    msg.profile = words.profile;
    msg.keep_alive = words.keep_alive;
    msg.ctrl_cfg.trigger_type = words.period;
    msg.req_layout.clone_from(&words.req_layout);
    msg.res_layout.clone_from(&words.res_layout);
    msg.extra.clone_from(&words.extra);
}

fn path(target: &Target) -> String {
    match target {
        Target::BuiltIn => "0,0".to_string(),
        Target::Network(endpoint) if endpoint.has_unusual_port() => alloc::format!("4,{endpoint}"),
        Target::Network(endpoint) => alloc::format!("4,{}", endpoint.host),
    }
}

/// The way through the controller's own racks is not the message's.
fn place(address: &str, changes: &mut Vec<Change>) {
    let Ok(place) = address.parse::<PlcAddress>() else { return };
    changes.push(Change::new(&"Address", &place, &"", Grade::Carried, Why::ModulePlace));
    if let Some(xway) = place.xway {
        let from = alloc::format!("{{{}.{}}}", xway.network, xway.station);
        changes.push(Change::new(&"Address", &from, &"", Grade::Lost, Why::NoBridge));
    }
}

/// Class, instance, attribute and members, in this order; false if the path is not made of these alone.
pub(in crate::code) fn object(path: &Epath, msg: &mut MsgCipGeneric) -> bool {
    let mut kinds = Vec::new();
    let app = &mut msg.app_cfg;
    (app.class, app.instance, app.attribute, app.member_cnt) = (0, 0, 0, 0);
    for segment in path.segments() {
        let Segment::Logical(logical) = segment else { return false };
        let value = i64::from(logical.value);
        match logical.kind {
            LogicalKind::Class => app.class = value,
            LogicalKind::Instance => app.instance = value,
            LogicalKind::Attribute => app.attribute = value,
            LogicalKind::Member => {
                let Some(member) =
                    usize::try_from(app.member_cnt).ok().and_then(|at| app.member_id.get_mut(at))
                else {
                    return false;
                };
                *member = value;
                app.member_cnt += 1;
            }
            LogicalKind::ConnectionPoint => return false,
        }
        kinds.push(logical.kind);
    }
    let members = kinds.iter().filter(|kind| **kind == LogicalKind::Member).count();
    let (head, tail) = kinds.split_at(kinds.len() - members);
    let in_order = matches!(
        head,
        [LogicalKind::Class, LogicalKind::Instance]
            | [LogicalKind::Class, LogicalKind::Instance, LogicalKind::Attribute]
    );
    // Attribute 0 would be left out.
    in_order
        && tail.iter().all(|kind| *kind == LogicalKind::Member)
        && (head.len() == 2 || app.attribute != 0)
}

fn timeouts(words: &SendReq, connected: bool, msg: &mut MsgCipGeneric, changes: &mut Vec<Change>) {
    let count = words.management_param.get(2).copied().unwrap_or_default();
    let mut moved = |range: TimeoutRange| {
        let (low, high) = (i64::from(range.min), i64::from(range.max));
        let wanted = count.saturating_mul(100);
        let (from, used) = match count {
            0 => ("for ever".to_string(), high),
            _ => (alloc::format!("{wanted} ms"), wanted.clamp(low, high)),
        };
        if used != wanted {
            let to = alloc::format!("{used} ms");
            let why = Why::TimeoutBounds(range.min, range.max);
            changes.push(Change::new(&"Management_Param[2]", &from, &to, Grade::Adjusted, why));
        }
        used
    };
    if connected {
        msg.target_cfg.conn_msg_timeout = moved(CONN_MSG_TIMEOUT);
    }
    msg.target_cfg.ucmm_timeout = moved(UCMM_TIMEOUT);
}
