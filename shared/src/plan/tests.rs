use super::*;
use alloc::string::{String, ToString};
use hex_literal::hex;

fn block() -> MsgCipGeneric {
    MsgCipGeneric::product_name("4,192.168.1.100")
}

fn findings(change: impl FnOnce(&mut MsgCipGeneric)) -> Vec<(String, Severity, String)> {
    let mut config = block();
    change(&mut config);
    let (plan, findings) = MessagePlan::parse(&config);
    let errors = findings.iter().any(|finding| finding.severity == Severity::Error);
    assert_eq!(plan.is_none(), errors, "a plan exists only without errors");
    findings.iter().map(|f| (f.field.to_string(), f.severity, f.rule.name().to_string())).collect()
}

fn one(change: impl FnOnce(&mut MsgCipGeneric)) -> (String, Severity, String) {
    let all = findings(change);
    assert_eq!(all.len(), 1, "{all:?}");
    all.into_iter().next().unwrap()
}

fn row(field: &str, severity: Severity, rule: &str) -> (String, Severity, String) {
    (field.into(), severity, rule.into())
}

#[test]
fn the_first_message_has_no_finding() {
    let (plan, findings) = MessagePlan::parse(&block());
    assert_eq!(findings, []);
    let plan = plan.unwrap();
    assert_eq!(plan.request().bytes(), hex!("0E 03 20 01 24 01 30 07"));
    assert_eq!((plan.ucmm_timeout_ms(), plan.res_data_size(0)), (3000, 490));
    assert_eq!((plan.access(), plan.trigger()), (Access::Read, TriggerType::Once));
}

#[test]
fn path_order_is_class_instance_attribute_members() {
    let mut config = block();
    config.app_cfg.class = 0x374;
    config.app_cfg.instance = 274;
    config.app_cfg.attribute = 1;
    config.app_cfg.member_cnt = 2;
    config.app_cfg.member_id = alloc::vec![1, 300, 9];
    let plan = MessagePlan::parse(&config).0.unwrap();
    assert_eq!(plan.request().bytes(), hex!("0E 08 21 00 74 03 25 00 12 01 30 01 28 01 29 00 2C 01"));
    config.app_cfg.attribute = 0;
    config.app_cfg.member_cnt = 0;
    let plan = MessagePlan::parse(&config).0.unwrap();
    assert_eq!(plan.request().bytes(), hex!("0E 04 21 00 74 03 25 00 12 01"), "attribute 0 means none");
}

#[test]
fn every_range_is_checked_at_both_ends() {
    type Set = fn(&mut MsgCipGeneric, i64);
    let rows: [(&str, Set, i64, i64); 12] = [
        ("AppCfg.Service", |c, v| c.app_cfg.service = v, 1, 127),
        ("AppCfg.Class", |c, v| c.app_cfg.class = v, 1, 65_535),
        ("AppCfg.Instance", |c, v| c.app_cfg.instance = v, 0, 4_294_967_295),
        ("AppCfg.Attribute", |c, v| c.app_cfg.attribute = v, 0, 65_535),
        ("AppCfg.MemberCnt", |c, v| c.app_cfg.member_cnt = v, 0, 3),
        ("AppCfg.MemberId[1]", |c, v| c.app_cfg.member_id[1] = v, 0, 65_535),
        ("CtrlCfg.TriggerType", |c, v| c.ctrl_cfg.trigger_type = v, 0, 65_535),
        ("CtrlCfg.StrMode", |c, v| c.ctrl_cfg.str_mode = v, 0, 255),
        ("TargetCfg.UcmmTimeout", |c, v| c.target_cfg.ucmm_timeout = v, 0, 4_294_967_295),
        ("TargetCfg.ConnMsgTimeout", |c, v| c.target_cfg.conn_msg_timeout = v, 0, 4_294_967_295),
        ("ResDataSize", |c, v| c.res_data_size = v, 1, 490),
        ("ReqLength", |c, v| (c.req_data, c.req_length) = ("00".repeat(490), Some(v)), 0, 490),
    ];
    for (field, set, min, max) in rows {
        for (value, fits) in [(min - 1, false), (min, true), (max, true), (max + 1, false)] {
            let errors = findings(|config| set(config, value));
            let refused = errors.contains(&row(field, Severity::Error, "out_of_range"));
            assert_eq!(refused, !fits, "{field} = {value}: {errors:?}");
        }
    }
}

#[test]
fn all_findings_come_at_once() {
    let all = findings(|config| {
        config.app_cfg.service = 300;
        config.app_cfg.class = 0;
        config.target_cfg.path = "6,1".into();
        config.req_data = "0".into();
    });
    let fields: Vec<_> = all.iter().map(|(field, ..)| field.as_str()).collect();
    assert_eq!(fields, ["AppCfg.Service", "AppCfg.Class", "TargetCfg.Path", "ReqData"]);
}

#[test]
fn one_finding_never_hides_another() {
    let all = findings(|config| {
        config.req_data = "00".repeat(491);
        config.req_length = Some(491);
        config.app_cfg.member_id = alloc::vec![0; 2];
        config.app_cfg.member_cnt = 4;
    });
    let fields: Vec<_> = all.iter().map(|(field, ..)| field.as_str()).collect();
    assert_eq!(fields, ["AppCfg.MemberId", "AppCfg.MemberCnt", "ReqLength", "ReqData"]);
}

#[test]
fn errors_carry_the_numbers_of_the_controller() {
    type Change = fn(&mut MsgCipGeneric);
    type Ids = Option<(u16, Option<u16>)>;
    let rows: [(Change, Ids); 9] = [
        (|c| c.app_cfg.service = 300, Some((33, Some(50)))),
        (|c| c.app_cfg.class = 0, Some((33, Some(43)))),
        (|c| c.app_cfg.member_cnt = 4, Some((33, Some(43)))),
        (|c| c.target_cfg.path = "6,1".into(), Some((33, Some(32)))),
        (|c| c.target_cfg.path = String::new(), Some((33, Some(49)))),
        (|c| c.target_cfg.path = "4,10.0.0.1,1,0,1,1".into(), Some((33, Some(49)))),
        (|c| c.target_cfg.cip_conn_mode = 2, Some((33, Some(36)))),
        (|c| c.req_data = "00".repeat(491), Some((33, Some(51)))),
        (|c| c.req_length = Some(1), Some((33, Some(48)))),
    ];
    for (change, ids) in rows {
        let mut config = block();
        change(&mut config);
        let (_, findings) = MessagePlan::parse(&config);
        assert_eq!(findings.iter().map(Finding::error_ids).collect::<Vec<_>>(), [ids], "{findings:?}");
    }
}

#[test]
fn a_direct_message_is_sent_as_it_is_and_a_routed_one_by_unconnected_send() {
    let mut config = block();
    let direct = MessagePlan::parse(&config).0.unwrap();
    assert_eq!(direct.routed(Profile::Auto).message(), direct.request().bytes());
    config.target_cfg.path = "4,192.168.1.100,1,0".into();
    let routed = MessagePlan::parse(&config).0.unwrap();
    // layout of pycomm3 wrap_unconnected_send; UcmmTimeout 3000 ms is 188 x 16 ms
    let golden = hex!("52 02 20 06 24 01 04 BC 08 00 0E 03 20 01 24 01 30 07 01 00 01 00");
    assert_eq!(routed.routed(Profile::Logix).message(), golden);
    assert_eq!(routed.routed(Profile::Micro800), direct.routed(Profile::Auto), "no route to its own slot");
    config.target_cfg.path = "4,192.168.1.100,2,10.0.0.9,1,0".into();
    let far = MessagePlan::parse(&config).0.unwrap();
    assert_eq!(far.routed(Profile::Micro800).route().bytes(), b"\x12\x0810.0.0.9");
}

#[test]
fn a_route_that_a_controller_would_not_take_is_told() {
    let far = one(|config| config.target_cfg.path = "4,192.168.1.100,1,3,2,192.168.1.20".into());
    assert_eq!(far, row("TargetCfg.Path", Severity::Warning, "three_hops"));
    let own = one(|config| {
        config.target_cfg.path = "4,192.168.1.100,1,0".into();
        config.profile = Profile::Micro800;
    });
    assert_eq!(own, row("TargetCfg.Path", Severity::Note, "own_slot"));
}

#[test]
fn a_connected_message_has_the_timeout_of_connections() {
    for (given, used) in [(0, 10_000), (1, 800), (800, 800), (9_999, 9_999), (20_000, 10_000)] {
        let mut config = block();
        config.target_cfg.cip_conn_mode = 1;
        config.target_cfg.conn_msg_timeout = given;
        config.target_cfg.conn_close = true;
        let plan = MessagePlan::parse(&config).0.unwrap();
        assert_eq!(plan.connection(), Some(ConnectionPlan { timeout_ms: used, close: true }), "{given}");
    }
    assert_eq!(MessagePlan::parse(&block()).0.unwrap().connection(), None);
}

#[test]
fn a_keep_alive_is_off_or_not_too_often() {
    for (given, used) in [(0, 0), (1, 1_000), (5_000, 5_000), (70_000, 60_000)] {
        let mut config = block();
        config.keep_alive = given;
        let (plan, findings) = MessagePlan::parse(&config);
        assert_eq!(
            (plan.unwrap().keep_alive_ms(), findings.len()),
            (used, usize::from(i64::from(used) != given))
        );
    }
    assert_eq!(one(|config| config.keep_alive = -1), row("KeepAlive", Severity::Error, "out_of_range"));
}

#[test]
fn timeouts_are_clamped_with_a_note() {
    for (given, used) in [(0, 3000), (1, 250), (249, 250), (250, 250), (10_000, 10_000), (10_001, 10_000)] {
        let mut config = block();
        config.target_cfg.ucmm_timeout = given;
        let (plan, findings) = MessagePlan::parse(&config);
        assert_eq!(plan.unwrap().ucmm_timeout_ms(), used, "{given}");
        let noted = findings.iter().any(|f| f.severity == Severity::Note && f.field == Field::UcmmTimeout);
        assert_eq!(noted, given != 0 && i64::from(used) != given, "{given}");
    }
    let note = one(|config| config.target_cfg.conn_msg_timeout = 799);
    assert_eq!(note, row("TargetCfg.ConnMsgTimeout", Severity::Note, "clamped"));
}

#[test]
fn req_length_cuts_the_data_with_a_note() {
    let mut config = block();
    config.req_data = "01 02 03".into();
    config.req_length = Some(2);
    let (plan, findings) = MessagePlan::parse(&config);
    assert_eq!(plan.unwrap().request().data(), [1, 2]);
    assert_eq!(findings.first().map(|f| (&f.field, f.severity)), Some((&Field::ReqLength, Severity::Note)));
    config.req_length = None;
    assert_eq!(MessagePlan::parse(&config).0.unwrap().request().data(), [1, 2, 3]);
}

#[test]
fn odd_hex_is_a_finding_with_its_place() {
    let mut config = block();
    config.req_data = "0A 0".into();
    let (_, findings) = MessagePlan::parse(&config);
    assert_eq!(
        findings[0].rule.to_string(),
        "half a byte at character 4: each byte needs two hexadecimal digits"
    );
}

#[test]
fn resume_is_for_reads() {
    let read = findings(|config| config.resume = true);
    assert_eq!(read, []);
    for service in [16, 75] {
        let refused = one(|config| (config.resume, config.app_cfg.service) = (true, service));
        assert_eq!(refused, row("Resume", Severity::Error, "resume_needs_read"));
    }
}

#[test]
fn an_unknown_member_is_a_warning_with_its_place() {
    let warning = one(|config| {
        config.app_cfg.extra.insert("Atribute".into(), 7.into());
    });
    assert_eq!(warning, row("AppCfg.Atribute", Severity::Warning, "unknown_member"));
}

#[test]
fn member_id_has_three_entries() {
    for count in [0, 2, 4] {
        let error = one(|config| config.app_cfg.member_id = alloc::vec![0; count]);
        assert_eq!(error, row("AppCfg.MemberId", Severity::Error, "member_id_count"), "{count}");
    }
}

#[test]
fn a_trigger_type_over_255_is_a_note() {
    let note = one(|config| config.ctrl_cfg.trigger_type = 256);
    assert_eq!(note, row("CtrlCfg.TriggerType", Severity::Note, "over_usint"));
}

#[test]
fn every_rule_has_a_key_that_is_listed() {
    for rule in [Rule::Missing, Rule::Reserved, Rule::ThreeHops, Rule::OverUsint] {
        assert!(Rule::KEYS.contains(&rule.key()) && Rule::KEYS.contains(&rule.name()));
    }
}

#[test]
fn a_layout_that_cannot_be_read_is_no_block_and_one_that_does_not_fit_is_a_warning() {
    let mut config = MsgCipGeneric::product_name("4,10.0.0.1");
    (config.res_layout, config.req_layout) = ("speed: REEL".into(), "UINT".into());
    config.req_data = "0102030405".into();
    let (plan, findings) = MessagePlan::check(&config.clone().into());
    let said: Vec<_> = findings.iter().map(|it| alloc::format!("{}: {}", it.field, it.rule)).collect();
    assert!(plan.is_none());
    assert_eq!(
        said,
        [
            "ResLayout: \"REEL\" is neither a type nor a layout that is known at character 8; write REAL, or speed: \
             REAL; run: BOOL",
            "ReqLayout: the layout has 2 bytes, ReqData has 5",
        ]
    );
    config.res_layout = "speed: REAL".into();
    let (plan, findings) = MessagePlan::check(&config.clone().into());
    assert!(plan.is_some() && findings.len() == 1, "a layout changes nothing that is sent");
}
