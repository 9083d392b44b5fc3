use alloc::string::{String, ToString};
use alloc::vec::Vec;

use super::*;
use crate::code::{Code, Found, Imported};
use crate::config::{MsgCipGeneric, read_hex, write_hex};
use crate::plan::MessagePlan;

fn told(imported: &Imported) -> Vec<String> {
    let blocks = imported.blocks.iter().flat_map(|found| &found.remarks);
    imported.remarks.iter().chain(blocks).map(ToString::to_string).collect()
}

fn request(found: &Found) -> String {
    write_hex(MessagePlan::of(&found.config).0.expect("a plan").bytes())
}

/// Comments are the only thing in it that begins with `(*`.
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
    let code = export(&MsgCipGeneric::product_name("4,192.168.1.100").into(), &[]);
    for part in [
        "product_name : MSG_CIPGENERIC;",
        "product_name_Res : ARRAY[1..490] OF USINT;",
        "product_name_App.Service := 14; (* 16#0E, 14 Get_Attribute_Single *)",
        "product_name_Target.Path := '4,192.168.1.100';",
        "product_name(product_name_IN, product_name_Ctrl, product_name_App, product_name_Target, product_name_Req, 0, \
         product_name_Res);",
    ] {
        assert!(code.text.contains(part), "{part}\n{}", code.text);
    }
    assert_eq!(code.losses().count(), 0);
}

#[test]
fn what_is_written_is_read_back_without_its_comments() {
    let mut full = MsgCipGeneric::product_name("4,10.0.0.1,1,3");
    full.name = "1. 'Größe' *) b".into();
    (full.ctrl_cfg.trigger_type, full.ctrl_cfg.cancel, full.ctrl_cfg.str_mode) = (500, true, 1);
    let app = &mut full.app_cfg;
    (app.service, app.class, app.instance, app.attribute) = (16, 0x374, 70_000, 300);
    (app.member_cnt, app.member_id) = (2, alloc::vec![1, 300, 0]);
    let target = &mut full.target_cfg;
    (target.cip_conn_mode, target.ucmm_timeout, target.conn_msg_timeout, target.conn_close) =
        (1, 700, 900, true);
    full.res_data_size = 12;
    let mut typed = full.clone();
    typed.req_layout = "run: BOOL; ref: INT; back: SINT; big: DINT; speed: UINT; total: UDINT; level: REAL; rest: BYTE[2]; text: STRING[2]".into();
    typed.res_layout = "REAL".into();
    typed.req_data = "01fbff80feffffffdc05ffffffff0000c03f0aff4142".into();
    full.req_data = "ff00".into();
    for config in [MsgCipGeneric::product_name("0,0"), full, typed] {
        let Code { text, changes } = export(&config.clone().into(), &[]);
        assert!(changes.iter().all(|change| !change.is_loss()), "{changes:?}");
        let imported = import(&without_comments(&text));
        assert!(
            told(&imported).iter().all(|remark| !remark.contains("error")),
            "{:?}\n{text}",
            told(&imported)
        );
        let [found] = imported.blocks.as_slice() else { panic!("one block in\n{text}") };
        let mut read = found.config.as_msg().unwrap().clone();
        assert_eq!(read.req_data, config.req_data, "{text}");
        (read.name, read.req_layout, read.res_layout) =
            (config.name.clone(), config.req_layout.clone(), config.res_layout.clone());
        assert_eq!(read, config, "{text}");
    }
}

#[test]
fn a_typed_variable_that_somebody_changes_changes_its_bytes() {
    let mut config = MsgCipGeneric::product_name("0,0");
    (config.app_cfg.service, config.req_layout, config.req_data) =
        (16, "ref: INT; total: UDINT".into(), "fbff01020304".into());
    let text = export(&config.into(), &[]).text.replace("_ref : INT := -5;", "_ref : INT := -300;");
    let text = text.replace("_total : UDINT := 67305985;", "_total : UDINT := 16#FFFEFDFC;");
    let found = &import(&text).blocks[0];
    assert_eq!(
        read_hex(&found.config.as_msg().unwrap().req_data).unwrap(),
        [0xD4, 0xFE, 0xFC, 0xFD, 0xFE, 0xFF]
    );
}

#[test]
fn hand_written_variants_are_read() {
    let imported = import(
        "VAR
  Drive : MSG_CIPGENERIC;
  App : CIPAPPCFG := (Service := 16#10, Class := 147, Instance := 41, Attribute := 9);
  Req : ARRAY[0..1] OF USINT := [16#E8, 3];
  Res : ARRAY[0..31] OF USINT;
END_VAR
IF Start AND NOT Busy THEN
  Tgt.Path := '4,192.168.1.20'; Tgt.UcmmTimeout := 500;
END_IF;
Drive(IN := Start, CtrlCfg := Ctrl, AppCfg := App, TargetCfg := Tgt, ReqData := Req, ReqLength := 2, ResData := Res, Q => Done);
Other.AppCfg.Service := 1; Other.AppCfg.Class := 1; Other.AppCfg.Instance := 1;
Other.TargetCfg.Path := PathOfPlc;
PathOfPlc := '4,10.0.0.9';
Other(IN := Start, AppCfg := Other.AppCfg);
Lamp := Done;
Motor := 5;
",
    );
    assert_eq!(
        imported.blocks.iter().map(request).collect::<Vec<_>>(),
        ["100320932429 3009e803".replace(' ', ""), "010220012401".into()]
    );
    let first = imported.blocks[0].config.as_msg().unwrap();
    assert_eq!(
        (first.res_data_size, first.target_cfg.ucmm_timeout, imported.blocks[0].lines.clone()),
        (32, 500, 3..11)
    );
    assert_eq!(
        told(&imported),
        [
            "7:1: note: a condition changes nothing about the message: IF Start AND NOT Busy THEN",
            "16:1: note: statements that belong to no message begin here, left out: Motor := 5;",
        ]
    );
}

#[test]
fn a_value_that_no_constant_says_stays_bytes() {
    let mut config = MsgCipGeneric::product_name("4,192.168.1.100");
    (config.app_cfg.service, config.name) = (16, "m".into());
    config.req_layout = "nan: REAL; endless: LREAL; odd: BOOL; n: UINT".into();
    config.req_data = "0000c07f 000000000000f0ff 02 0500".into();
    let text = export(&config.clone().into(), &[]).text;
    for field in ["m_req_nan", "m_req_endless", "m_req_odd"] {
        assert!(!text.contains(field), "{field} has no value, and would be packed over the bytes\n{text}");
    }
    assert!(text.contains("m_req_n : UINT := 5;") && text.contains("m_Req[13] := 2;"), "{text}");
    assert_eq!(
        request(&import(&without_comments(&text)).blocks[0]),
        "100320012401300700 00c07f000000000000f0ff020500".replace(' ', "")
    );
}

#[test]
fn what_cannot_be_known_is_told_where_it_is() {
    let imported = import(
        "a.Service := Code; a.Class := 300000; a.Colour := 5;
t.Path := CONCAT('4,', Address);
r[1] := 300; r[3] := Speed;
m(In, c, a, t, r, 3, q);
m(AppCfg := 5, TargetCfg := t)",
    );
    assert_eq!(
        told(&imported),
        [
            "5:30: warning: ; is expected here: )",
            "1:51: error: colour is not known, left out: a.Colour := 5;",
            "1:14: error: AppCfg.Service is not a constant: write its value: a.Service := Code;",
            "1:31: warning: AppCfg.Class is 0 to 65535: a.Class := 300000;",
            "4:1: error: AppCfg.Instance is missing: m(In, c, a, t, r, 3, q);",
            "2:11: error: TargetCfg.Path is not a constant: write its value: t.Path := CONCAT('4,', Address);",
            "3:9: warning: ReqData[1] is 0 to 255: r[1] := 300;",
            "3:22: error: ReqData[3] is not a constant: write its value: r[3] := Speed;",
            "4:1: warning: ReqData: 1 elements from [2] to [2] are not set: they are 0: m(In, c, a, t, r, 3, q);",
            "5:1: error: a variable for AppCfg is expected here: m(AppCfg := 5, TargetCfg := t)",
            "2:11: error: TargetCfg.Path is not a constant: write its value: t.Path := CONCAT('4,', Address);",
        ]
    );
}

#[test]
fn a_text_without_a_message_is_told_line_by_line() {
    assert_eq!(
        told(&import("hello world\na := 5;\n")),
        [
            "1:7: error: := is expected here: hello world",
            "2:1: error: statements that belong to no message begin here, left out: a := 5;",
        ]
    );
}

#[test]
fn a_copy_into_the_request_is_told() {
    let text = "m_Req[1] := 1;\nCOP(TRUE, speed, 0, m_Req, 0, 4, FALSE);\nCOP(TRUE, m_Res, 0, found, 0, 4, FALSE);\n\
                MSG_CIPGENERIC(go, c, a, t, m_Req, 4, m_Res);\n";
    let imported = import(text);
    let remarks = imported.blocks[0].remarks.iter().filter(|remark| remark.to_string().contains("COP"));
    assert_eq!(remarks.map(|remark| remark.line).collect::<Vec<_>>(), [2]);
}

#[test]
fn a_copy_counts_elements_of_its_destination() {
    let mut config = MsgCipGeneric::product_name("4,10.0.0.1");
    (config.app_cfg.service, config.req_layout, config.req_data) =
        (16, "n: INT; level: REAL".into(), "01000000c03f".into());
    config.res_layout = "n: UINT; level: LREAL".into();
    let text = export(&config.into(), &[]).text;
    for part in [
        "    product_name_Copy : COP;",
        "product_name_Copy(TRUE, product_name_req_level, 0, product_name_Req, 2, 4, FALSE);",
        "    product_name_Copy(TRUE, product_name_Res, 2, product_name_res_level, 0, 1, FALSE);",
    ] {
        assert!(text.contains(part), "{part}\n{text}");
    }
}

#[test]
fn an_instance_is_known_by_the_name_that_the_editor_gives_it() {
    let imported = import(
        "a.Service := 14; a.Class := 1; a.Instance := 1; t.Path := '4,10.0.0.1';
COP_1(TRUE, Speed, 0, r, 0, 2, FALSE);
MSG_CIPGENERIC_2(IN := go, CtrlCfg := c, AppCfg := a, TargetCfg := t, ReqData := r, ReqLength := 2, ResData := q);",
    );
    assert_eq!(imported.blocks.len(), 1);
    assert_eq!(imported.blocks[0].config.as_msg().unwrap().name, "MSG_CIPGENERIC_2");
    assert!(told(&imported).iter().any(|it| it.contains("COP is not carried out here")));
}

#[test]
fn what_would_reach_another_device_does_not_run() {
    let code = export(&MsgCipGeneric::product_name("4,10.0.0.1:44820,1,0").into(), &[]);
    assert!(code.text.contains("product_name(FALSE AND product_name_IN, product_name_Ctrl,"));
    let losses: Vec<String> = code.losses().map(ToString::to_string).collect();
    let path = "TargetCfg.Path 4,10.0.0.1:44820,1,0 -> 4,10.0.0.1,1,0 (request): it always goes to TCP port 44818 there";
    assert_eq!(losses, [path]);
}

#[test]
fn a_text_of_logix_is_told_once() {
    let text = "CONTROLLER Line4\nTAG\n  Read : MESSAGE (MessageType := CIP Generic,\n    ServiceCode := 16#000E);\nEND_TAG\n";
    let told = told(&crate::code::import(text, None));
    assert_eq!(told.len(), 1, "{told:?}");
    assert!(told[0].starts_with("3:1: error: this is an L5K text"), "{told:?}");
}
