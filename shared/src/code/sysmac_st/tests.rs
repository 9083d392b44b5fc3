use alloc::string::{String, ToString};
use alloc::vec::Vec;

use super::*;
use crate::code::{Code, Grade, Imported};
use crate::config::{MsgCipGeneric, write_hex};
use crate::plan::MessagePlan;

fn told(imported: &Imported) -> Vec<String> {
    let blocks = imported.blocks.iter().flat_map(|found| &found.remarks);
    imported.remarks.iter().chain(blocks).map(ToString::to_string).collect()
}

fn without_comments(text: &str) -> String {
    let (tokens, _) = crate::code::text::tokens(text, true);
    let mut plain: Vec<u8> = text.bytes().collect();
    for token in tokens.iter().filter(|token| token.lexeme == crate::code::text::Lexeme::Comment) {
        plain[token.place.at..token.end()].fill(b' ');
    }
    String::from_utf8(plain).unwrap()
}

#[test]
fn a_read_looks_as_in_the_manual() {
    let text = export(&MsgCipGeneric::product_name("4,192.168.250.2,1,0").into(), &[]).text;
    for part in [
        "product_name : CIPUCMMSend;",
        "product_name_Path : _sREQUEST_PATH_EX;",
        "product_name_Path.ClassIDLogicalFormat := _eCIP_LOGICAL_FORMAT#_8BIT;",
        "RoutePath := '02\\192.168.250.2\\01\\#00',",
        "TimeOut := UINT#30, (* 3000 ms *)",
        "ServiceCode := BYTE#16#0E,",
    ] {
        assert!(text.contains(part), "{part}\n{text}");
    }
}

#[test]
fn what_is_written_is_read_back_without_its_comments() {
    let mut write = MsgCipGeneric::product_name("4,10.0.0.1,2,10.0.0.2");
    let app = &mut write.app_cfg;
    (app.service, app.class, app.instance, app.attribute) = (16, 0x374, 70_000, 0);
    (write.req_data, write.res_data_size) = ("00ff10".into(), 12);
    let mut connected = write.clone();
    let target = &mut connected.target_cfg;
    (target.cip_conn_mode, target.ucmm_timeout, target.conn_msg_timeout, target.conn_close) =
        (1, 900, 900, true);
    for config in [MsgCipGeneric::product_name("0,0"), write, connected] {
        let Code { text, changes } = export(&config.clone().into(), &[]);
        assert!(changes.iter().all(|change| !change.is_loss()), "{changes:?}");
        let imported = import(&without_comments(&text));
        assert_eq!(told(&imported), Vec::<String>::new(), "{text}");
        let read = imported.blocks[0].config.as_msg().unwrap();
        let (before, after) = (MessagePlan::parse(&config).0.unwrap(), MessagePlan::parse(read).0.unwrap());
        assert_eq!(write_hex(before.bytes()), write_hex(after.bytes()), "{text}");
        assert_eq!((before.target(), before.connection()), (after.target(), after.connection()));
        assert_eq!(
            (before.ucmm_timeout_ms(), read.res_data_size),
            (after.ucmm_timeout_ms(), config.res_data_size)
        );
    }
}

#[test]
fn what_sysmac_cannot_say_is_told() {
    let mut config = MsgCipGeneric::product_name("4,drive:44820,18,10.0.0.2");
    (config.app_cfg.member_cnt, config.app_cfg.member_id) = (1, alloc::vec![5, 0, 0]);
    (config.target_cfg.ucmm_timeout, config.ctrl_cfg.trigger_type) = (1250, 500);
    let code = export(&config.into(), &[]);
    let losses: Vec<(String, Grade, &str)> =
        code.losses().map(|it| (it.member.clone(), it.grade, it.why.name())).collect();
    let loss = |member: &str, grade, why| (String::from(member), grade, why);
    assert_eq!(
        losses,
        [
            loss("CtrlCfg.TriggerType", Grade::Lost, "program_does"),
            loss("TargetCfg.Path", Grade::Request, "no_tcp_port"),
            loss("TargetCfg.Path", Grade::Request, "no_host_name"),
            loss("TargetCfg.Path", Grade::Request, "no_route"),
            loss("AppCfg.MemberId", Grade::Request, "no_member_segments"),
            loss("TargetCfg.UcmmTimeout", Grade::Adjusted, "timeout_step"),
        ]
    );
}

#[test]
fn the_standard_path_of_hand_written_code_is_read_and_its_widths_are_told() {
    let imported = import(
        "VAR Path : _sREQUEST_PATH; Send : CIPUCMMSend; Speed : UINT := 1500; Route : STRING[40] := '02\\10.0.0.7'; END_VAR
Path.ClassID := UINT#1; Path.InstanceID := 1; Path.isAttributeID := TRUE; Path.AttributeID := 7;
Send(Execute := Go, RoutePath := Route, ServiceCode := 16#10, RqPath := Path, ServiceDat := Speed, Size := 1, RespServiceDat := Dummy);",
    );
    let plan = MessagePlan::of(&imported.blocks[0].config).0.unwrap();
    assert_eq!(
        (write_hex(plan.bytes()), plan.target().to_string()),
        ("1003200124013007dc05".into(), "10.0.0.7:44818".into())
    );
    let told = told(&imported);
    assert!(told[0].contains("TimeOut is not given: 20 tenths"), "{told:?}");
    assert!(
        told[1].contains("path 21 00 01 00 25 00 01 00 31 00 07 00 -> 20 01 24 01 30 07 (request)"),
        "{told:?}"
    );
    assert_eq!(told.len(), 2, "{told:?}");
}

#[test]
fn what_cannot_be_known_is_told() {
    let imported = import(
        "CIPSend(Handle := h, ServiceCode := Code, RqPath := p, Size := 2, ServiceDat := d[0], Foo := 1);\nCIPUCMMSend(Execute := x, RoutePath := '01\\#00', TimeOut := 999, RqPath := q, ServiceCode := 1, Size := 0);",
    );
    let told: Vec<String> = told(&imported)
        .into_iter()
        .map(|it| it.rsplit_once(": CIP").map_or(it.clone(), |(it, _)| it.into()))
        .collect();
    assert_eq!(
        told,
        [
            "1:1: error: Foo is not known, left out",
            "1:1: error: ServiceCode is not a constant: write its value",
            "1:1: error: the CIPOpen of this handle is missing",
            "1:1: warning: ServiceDat: 2 elements from [0] to [1] are not set: they are 0",
            "1:1: error: RqPath.ClassID is missing",
            "1:1: error: RqPath.InstanceID is missing",
            "2:1: error: a route path such as 02\\192.168.250.2\\01\\#00 instead of 01\\#00 is expected here",
            "2:1: warning: TargetCfg.UcmmTimeout 99900 ms -> 10000 ms (adjusted): timeouts are 250 to 10000 ms there; it is moved into that range",
            "2:1: error: RqPath.ClassID is missing",
            "2:1: error: RqPath.InstanceID is missing",
        ]
    );
}

#[test]
fn a_program_as_the_manual_writes_it_is_one_message() {
    let imported = import(
        "IF DoIt THEN
  Path.ClassID := UINT#16#0F; Path.InstanceID := UINT#41; Path.isAttributeID := TRUE; Path.AttributeID := UINT#1;
  CIPUCMMSend_instance(Execute := FALSE, ServiceDat := Data[0], RespServiceDat := Resp[0]);
  Stage := INT#1;
END_IF;
IF Stage = INT#1 THEN
  CIPUCMMSend_instance(Execute := TRUE, RoutePath := '02\\192.168.250.2', TimeOut := UINT#25, ServiceCode := BYTE#16#10,
    RqPath := Path, ServiceDat := Data[0], Size := SizeOfAry(Data), RespServiceDat := Resp[0]);
END_IF;
VAR Data : ARRAY[0..1] OF BYTE := [16#E8, 16#03]; END_VAR",
    );
    let [found] = imported.blocks.as_slice() else { panic!("{:?}", imported.blocks) };
    let config = found.config.as_msg().unwrap();
    assert_eq!((config.name.as_str(), config.req_data.as_str()), ("CIPUCMMSend_instance", "e803"));
    assert_eq!((config.target_cfg.ucmm_timeout, config.app_cfg.attribute), (2_500, 1));
    let severities = |severity| told(&imported).iter().filter(|it| it.contains(severity)).count();
    assert_eq!((severities(": error"), severities("Execute := FALSE changes nothing")), (0, 1));
}

#[test]
fn arguments_without_names_stand_in_their_order() {
    let imported = import(
        "p.ClassID := 1; p.InstanceID := 1; p.AttributeID := 7;
CIPUCMMSend1(go, '02\\10.0.0.7', 20, 16#0E, p, d, 0, r);
CIPOpen1(go, '02\\10.0.0.8', 30);
CIPSend1(CIPOpen1.Done, CIPOpen1.Handle, 16#0E, p, d, 0, r);
CIPClose1(CIPSend1.Done, CIPOpen1.Handle);",
    );
    let read: Vec<_> = imported.blocks.iter().map(|found| found.config.as_msg().unwrap()).collect();
    let [direct, connected] = read.as_slice() else { panic!("{:?}", told(&imported)) };
    assert_eq!((direct.target_cfg.path.as_str(), direct.target_cfg.ucmm_timeout), ("4,10.0.0.7", 2_000));
    let target = &connected.target_cfg;
    assert_eq!((target.path.as_str(), target.cip_conn_mode, target.conn_close), ("4,10.0.0.8", 1, true));
    // The one timeout is that of the connection.
    assert_eq!((target.ucmm_timeout, target.conn_msg_timeout), (3_000, 3_000));
    let told = told(&imported);
    let has = |part: &str| told.iter().any(|it| it.contains(part));
    assert!(
        has("note: arguments without names are read in this order: Execute, Handle, ServiceCode"),
        "{told:?}"
    );
    assert!(has("RqPath.AttributeID is not sent: isAttributeID is not TRUE"), "{told:?}");
    assert!(!told.iter().any(|it| it.contains(": error")), "{told:?}");
}

#[test]
fn a_connection_has_one_timeout() {
    let mut config = MsgCipGeneric::product_name("4,10.0.0.1");
    let target = &mut config.target_cfg;
    (target.cip_conn_mode, target.ucmm_timeout, target.conn_msg_timeout) = (1, 700, 900);
    let code = export(&config.into(), &[]);
    let losses: Vec<_> =
        code.losses().map(|it| (it.member.as_str(), it.to.as_str(), it.why.name())).collect();
    // A connection that stays would be opened anew at each start.
    let expected = [
        ("TargetCfg.UcmmTimeout", "900", "one_timeout"),
        ("TargetCfg.ConnClose", "TRUE", "connection_stays"),
    ];
    assert_eq!(losses, expected);
    assert!(
        code.text.contains("_Close(Execute := ") && code.text.contains("Error => product_name_OpenError")
    );
    assert_eq!(code.text.matches("TimeOut :=").count(), 1);
    assert!(code.text.contains("TimeOut := UINT#9, (* 900 ms *)\n    Handle => "), "{}", code.text);
}

#[test]
fn the_comment_shows_what_is_sent() {
    let mut config = MsgCipGeneric::product_name("4,10.0.0.1");
    (config.app_cfg.member_cnt, config.app_cfg.member_id) = (1, alloc::vec![5, 0, 0]);
    assert!(export(&config.into(), &[]).text.contains("(* request 0E 03 20 01 24 01 30 07 *)"));
}

#[test]
fn what_would_reach_something_else_does_not_run() {
    let mut config = MsgCipGeneric::product_name("4,10.0.0.1");
    assert!(!export(&config.clone().into(), &[]).text.contains("FALSE AND"));
    (config.app_cfg.member_cnt, config.app_cfg.member_id) = (1, alloc::vec![5, 0, 0]);
    assert!(export(&config.clone().into(), &[]).text.contains("(Execute := FALSE AND product_name_Start,"));
    config.target_cfg.cip_conn_mode = 1;
    assert!(export(&config.into(), &[]).text.contains("_Open(Execute := FALSE AND product_name_Start,"));
}
