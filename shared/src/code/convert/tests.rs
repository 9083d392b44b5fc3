use alloc::string::String;
use alloc::vec::Vec;

use super::*;
use crate::config::{MsgCipGeneric, SendReq, SendReqForm};

/// `member from -> to (grade)`, without the carried ones.
fn losses(converted: &Converted) -> Vec<String> {
    let told = |change: &Change| {
        alloc::format!("{} {} -> {} ({})", change.member, change.from, change.to, change.grade.name())
    };
    converted.changes.iter().filter(|change| change.is_loss()).map(told).collect()
}

fn words(converted: &Converted) -> &SendReq {
    converted.config.as_send_req().expect("words")
}

#[test]
fn a_read_becomes_the_words_of_the_manual_in_all_three_forms() {
    let msg = MsgCipGeneric::product_name("4,192.168.1.102").into();
    for (to, address, data, length) in [
        (Kind::SendReqEtc100, "ADDR('0.2.0.192.168.1.102')", "0000 030E 0120 0124 0730", 10),
        (Kind::SendReqEtc101, "ADDR('0.2.0')", "0000 C0A8 0166 030E 0120 0124 0730", 14),
        (Kind::DataExch, "ADDMX('0.2.0{192.168.1.102}UNC.CIP')", "030E 0120 0124 0730", 8),
    ] {
        let converted = convert(&msg, to);
        let found = words(&converted);
        assert_eq!((found.address.as_str(), found.data_to_send.as_str()), (address, data));
        assert_eq!(found.management_param, [0, 0, 30, length]);
        assert_eq!(losses(&converted), [""; 0], "{to}");
        let back = convert(&converted.config, Kind::MsgCipGeneric);
        assert_eq!(losses(&back), [""; 0], "{to}");
        let (msg, back) = (MessagePlan::of(&msg).0.unwrap(), MessagePlan::of(&back.config).0.unwrap());
        assert_eq!(
            (msg.bytes(), msg.target(), msg.ucmm_timeout_ms()),
            (back.bytes(), back.target(), back.ucmm_timeout_ms())
        );
    }
}

#[test]
fn what_the_words_cannot_say_is_told() {
    let mut msg = MsgCipGeneric::product_name("4,drive-3.line:44820,1,0");
    msg.target_cfg.ucmm_timeout = 3050;
    msg.ctrl_cfg.str_mode = 1;
    assert_eq!(
        losses(&convert(&msg.into(), Kind::SendReqEtc100)),
        [
            "CtrlCfg.StrMode 1 ->  (lost)",
            "TargetCfg.Path 4,drive-3.line:44820,1,0 -> without its route (request)",
            "TargetCfg.Path drive-3.line -> 0.0.0.0, the built-in simulated device (request)",
            "TargetCfg.UcmmTimeout 3050 ms -> 3100 ms (adjusted)",
            "target drive-3.line:44820, route 0100 -> 0,0 (request)",
        ]
    );
    let mut msg = MsgCipGeneric::product_name("4,10.0.0.1:44820");
    (msg.target_cfg.cip_conn_mode, msg.target_cfg.conn_close) = (1, true);
    assert_eq!(
        losses(&convert(&msg.into(), Kind::SendReqEtc101)),
        [
            "TargetCfg.ConnClose true ->  (lost)",
            "TCP port 44820 -> 44818 (request)",
            "TargetCfg.UcmmTimeout 3000 ms -> 10000 ms (adjusted)",
            "target 10.0.0.1:44820 -> 10.0.0.1:44818 (request)",
        ]
    );
}

#[test]
fn a_block_with_errors_is_converted_as_far_as_it_can_be_read_and_says_so() {
    let mut msg = MsgCipGeneric::product_name("4,10.0.0.1");
    msg.app_cfg.service = 300;
    msg.res_data_size = i64::MAX;
    let converted = convert(&msg.into(), Kind::DataExch);
    assert_eq!(words(&converted).name, "product-name");
    assert!(
        losses(&converted)[0].starts_with("request AppCfg.Service: 300 is outside 1 to 127 -> "),
        "{:?}",
        losses(&converted)
    );
}

#[test]
fn words_that_a_msg_cipgeneric_cannot_say_are_told_with_both_requests() {
    let read = |data: &str, length: i64| {
        let mut words = SendReq::new(SendReqForm::Etc100, "x");
        words.address = "ADDR('{1.2}0.3.0.10.0.0.1')".into();
        (words.data_to_send, words.management_param) = (data.into(), alloc::vec![0, 0, 0, length]);
        convert(&words.into(), Kind::MsgCipGeneric)
    };
    // The class in 16 bits, although 8 would do.
    let wide = read("0000 040E 0021 0001 0124 0730", 12);
    assert_eq!(
        losses(&wide),
        [
            "Address {1.2} ->  (lost)",
            "Management_Param[2] for ever -> 10000 ms (adjusted)",
            "request 0e042100010024013007 -> 0e03200124013007 (request)",
        ]
    );
    // A connection point in the path.
    let told = losses(&read("0000 030E 0420 0124 642C", 10));
    let point = |it: &String| it.starts_with("path 200424012c64 -> ") && it.ends_with("(request)");
    assert!(told.iter().any(point), "{told:?}");
}
