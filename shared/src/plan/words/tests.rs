use alloc::string::{String, ToString};
use alloc::vec;
use alloc::vec::Vec;

use hex_literal::hex;

use super::*;
use crate::config::{BlockConfig, Endpoint, Target, read_words, write_words};
use crate::plan::TriggerType;

fn block(form: SendReqForm, address: &str, words: &str, length: i64) -> SendReq {
    let mut config = SendReq::new(form, "line 4");
    (config.address, config.data_to_send) = (address.into(), words.into());
    config.management_param = vec![0, 0, 30, length];
    config
}

fn etc100() -> SendReq {
    block(SendReqForm::Etc100, "ADDR('0.2.0.192.168.1.102')", "0000 030E 0120 0124 0730", 10)
}

fn checked(config: &SendReq) -> (Option<MessagePlan>, Vec<String>) {
    let (plan, findings) = MessagePlan::check(&BlockConfig::from(config.clone()));
    let said = |finding: &Finding| {
        let report = finding.communication_report().map(|report| alloc::format!(" ({report:02X})"));
        let severity = match finding.severity {
            Severity::Error => "error",
            Severity::Warning => "warning",
            Severity::Note => "note",
        };
        alloc::format!("{severity} {} {}{}", finding.field, finding.rule.name(), report.unwrap_or_default())
    };
    (plan, findings.iter().map(said).collect())
}

/// Names of what is found, of a block that cannot run.
fn refused(config: &SendReq) -> Vec<String> {
    let (plan, said) = checked(config);
    assert!(plan.is_none(), "{said:?}");
    said
}

#[test]
fn the_four_requests_of_the_manuals_are_these_bytes_and_lengths() {
    let device = Target::Network(Endpoint::of_ip([192, 168, 1, 102]));
    let registers = hex!("4E 02 20 44 24 01 00 00 0A 00");
    let rows = [
        (
            SendReqForm::Etc100,
            "ADDR('{1.2}0.2.0.192.168.1.102')",
            "0000 030E 0120 0124 0730",
            10,
            &hex!("0E 03 20 01 24 01 30 07")[..],
        ),
        (SendReqForm::Etc101, "ADDR('0.4.0')", "0000 C0A8 0166 024E 4420 0124 0000 000A", 16, &registers[..]),
        (
            SendReqForm::Etc100,
            "ADDR('0.2.0.192.168.1.102')",
            "0000 024E 4420 0124 0000 000A",
            12,
            &registers[..],
        ),
        (
            SendReqForm::DataExch,
            "ADDMX('0.2.0{192.168.1.102}UNC.CIP')",
            "024E 4420 0124 0000 000A",
            10,
            &registers[..],
        ),
    ];
    for (form, address, words, length, bytes) in rows {
        let config = block(form, address, words, length);
        let (plan, said) = checked(&config);
        let plan = plan.unwrap_or_else(|| panic!("{words}: {said:?}"));
        assert_eq!((&plan.bytes()[..], plan.target()), (bytes, &device), "{words}");
        assert_eq!(plan.access(), Access::Read, "{words}");
        assert_eq!((plan.ucmm_timeout_ms(), plan.connection()), (3_000, None));
        // And back: fields give the same words and the same length.
        let written = WordsFields::of_words(form, &read_words(words).unwrap()).unwrap().write(form).unwrap();
        assert_eq!((write_words(&written.0).as_str(), i64::from(written.1)), (words, length));
    }
}

#[test]
fn what_is_wide_in_the_words_is_wide_on_the_wire() {
    // Class 1 and instance 1 in two bytes each, as a program that uses one table for all numbers writes them.
    let words = "0000 050E 0021 0001 0025 0001 0730";
    let (plan, said) =
        checked(&SendReq { data_to_send: words.into(), management_param: vec![0, 0, 30, 14], ..etc100() });
    let plan = plan.unwrap_or_else(|| panic!("{said:?}"));
    let bytes = hex!("0E 05 21 00 01 00 25 00 01 00 30 07");
    assert_eq!(plan.bytes()[..], bytes);
    assert_eq!(plan.routed(crate::config::Profile::Auto).message(), bytes);
    assert_eq!((plan.access(), plan.effects()[0].class), (Access::Read, Some(1)));
}

#[test]
fn a_connection_is_asked_for_in_word_0_or_in_the_address() {
    let typed = SendReq { data_to_send: "0001 030E 0120 0124 0730".into(), ..etc100() };
    let address = "ADDM('0.0.3{10.0.0.1}CON.CIP')";
    let addressed = block(SendReqForm::DataExch, address, "034B 0021 0410 0124", 8);
    for config in [typed, addressed] {
        let plan = MessagePlan::of(&config.into()).0.unwrap();
        assert_eq!(plan.connection(), Some(ConnectionPlan { timeout_ms: 3_000, close: false }));
        assert!(plan.words().unwrap().connected);
    }
}

#[test]
fn the_timeout_counts_tenths_of_a_second_and_0_is_said_loudly() {
    let config = SendReq { management_param: vec![0, 0, 65_535, 10], ..etc100() };
    assert_eq!(MessagePlan::of(&config.into()).0.unwrap().ucmm_timeout_ms(), 6_553_500);
    let config = SendReq { management_param: vec![0, 0, 0, 10], ..etc100() };
    let (plan, said) = checked(&config);
    assert_eq!(said, ["warning Management_Param[2] waits_for_ever"]);
    let plan = plan.unwrap();
    assert_eq!((plan.ucmm_timeout_ms(), plan.words().unwrap().timeout_ms), (u32::MAX, None));
}

#[test]
fn bytes_may_stay_behind_but_never_half_a_path() {
    let with = |words: &str, length| {
        checked(&SendReq { management_param: vec![0, 0, 30, length], data_to_send: words.into(), ..etc100() })
    };
    let (plan, said) = with("0000 0310 0120 0124 0730 1234", 11);
    assert_eq!(said, ["note Management_Param[3] length_under_words"]);
    assert_eq!(plan.unwrap().bytes()[..], hex!("10 03 20 01 24 01 30 07 34"));
    // The high byte of the last word is only there because words have two.
    let (plan, said) = with("0000 0310 0120 0124 0730 0034", 11);
    assert!(plan.is_some() && said.is_empty(), "{said:?}");
    let (plan, said) = with("0000 030E 0120 0124 0730", 9);
    assert!(plan.is_none());
    assert_eq!(
        said,
        ["note Management_Param[3] length_under_words", "error Management_Param[3] words_too_short (0E)"]
    );
}

#[test]
fn each_form_wants_its_own_address() {
    let exchange = |address: &str| block(SendReqForm::DataExch, address, "030E 0120 0124 0730", 8);
    let etc101 =
        |address: &str| block(SendReqForm::Etc101, address, "0000 C0A8 0166 030E 0120 0124 0730", 14);
    let etc100 = |address: &str| SendReq { address: address.into(), ..etc100() };
    for (config, name) in [
        (etc100(""), "address_unreadable"),
        (etc100("ADDR('0.2')"), "address_unreadable"),
        (etc100("ADDR('0.2.0')"), "address_shape"),
        (etc100("ADDR('0.2.0{10.0.0.1}UNC.CIP')"), "address_shape"),
        (etc101("ADDR('0.2.0.192.168.1.102')"), "address_with_ip"),
        (etc101("ADDR('0.2.0{10.0.0.1}UNC.CIP')"), "address_shape"),
        (exchange("ADDMX('0.2.0.192.168.1.102')"), "address_shape"),
        (exchange("ADDMX('0.2.0')"), "address_shape"),
    ] {
        assert_eq!(refused(&config), [alloc::format!("error Address {name} (03)")], "{}", config.address);
    }
    for (config, said) in [
        (etc100("{1.2}0.2.0.10.0.0.1"), vec!["warning Address address_xway"]),
        (etc100("0.2.3.10.0.0.1"), vec!["note Address address_channel"]),
        (etc100("0.2.1.10.0.0.1:44820"), vec!["warning Address address_channel", "warning Address tcp_port"]),
        (etc100("ADDM('0.2.0.10.0.0.1')"), vec!["warning Address address_function"]),
        (exchange("ADDR('0.2.0{10.0.0.1}UNC.CIP')"), vec!["warning Address address_function"]),
        (etc101("0.4.0"), vec![]),
    ] {
        let (plan, found) = checked(&config);
        assert!(plan.is_some());
        assert_eq!(found, said, "{}", config.address);
    }
}

#[test]
fn what_the_words_cannot_be_is_said_at_its_member_with_the_controllers_report() {
    let words = |words: &str| SendReq {
        data_to_send: words.into(),
        management_param: vec![
            0,
            0,
            30,
            2 * i64::try_from(read_words(words).unwrap_or_default().len().max(1)).unwrap(),
        ],
        ..etc100()
    };
    let management = |words: Vec<i64>| SendReq { management_param: words, ..etc100() };
    for (config, said) in [
        (SendReq { request_code: 0x50, ..etc100() }, "error Request_Code modbus_tcp (06)"),
        (SendReq { request_code: 15, ..etc100() }, "error Request_Code request_code (06)"),
        (words(""), "error Data_to_Send missing (06)"),
        (words("0000 3E"), "error Data_to_Send words_unreadable (06)"),
        (words("0002 030E 0120 0124 0730"), "error Data_to_Send message_type (06)"),
        (words("0000"), "error Data_to_Send words_too_short (0E)"),
        (words("0000 040E 0120 0124 0730"), "error Data_to_Send words_too_short (0E)"),
        (words("0000 000E"), "error Data_to_Send path_size_zero"),
        (words("0000 0300 0120 0124 0730"), "error Data_to_Send service"),
        (words("0000 038E 0120 0124 0730"), "error Data_to_Send service"),
        (words("0000 030E 0120 0434 0730"), "error Data_to_Send path_unreadable"),
        (management(vec![0, 0, 30]), "error Management_Param management_count (05)"),
        (management(vec![0, 0, 65_536, 10]), "error Management_Param[2] out_of_range (05)"),
        (management(vec![-1, 0, 30, 10]), "error Management_Param[0] out_of_range (05)"),
        (management(vec![0, 0, 30, 0]), "error Management_Param[3] length_zero (0E)"),
        (management(vec![0, 0, 30, 11]), "error Management_Param[3] length_over_words (0E)"),
        (management(vec![0, 0, 30, -1]), "error Management_Param[3] out_of_range (0E)"),
        (SendReq { received_data_size: 1, ..etc100() }, "error Received_Data_Size out_of_range"),
        (SendReq { period: 65_536, ..etc100() }, "error Period out_of_range"),
        (SendReq { kind: "SEND".into(), ..etc100() }, "error kind unknown_kind"),
        (SendReq { res_layout: "REEL".into(), ..etc100() }, "error ResLayout layout"),
        (
            SendReq { resume: true, ..words("0000 0310 0120 0124 0730 0001") },
            "error Resume resume_needs_read",
        ),
    ] {
        assert_eq!(refused(&config), [said], "{config:?}");
    }
    let (plan, said) = checked(&SendReq { req_layout: "UINT".into(), ..etc100() });
    assert!(plan.is_some());
    assert_eq!(said, ["warning ReqLayout layout_length"]);
    let (plan, said) = checked(&management(vec![256, 1, 30, 10]));
    assert!(plan.is_some());
    assert_eq!(said, ["note Management_Param[0] system_word", "note Management_Param[1] system_word"]);
}

#[test]
fn an_exchange_has_its_own_members() {
    let exchange = block(SendReqForm::DataExch, "ADDMX('0.2.0{10.0.0.1}UNC.CIP')", "030E 0120 0124 0730", 8);
    let wrong = SendReq { exchange_type: 2, ..exchange.clone() };
    assert_eq!(refused(&wrong), ["error Type exchange_type (06)"]);
    let strange = SendReq { dialect: etc100().dialect, request_code: 0x50, ..exchange };
    let (plan, said) = checked(&strange);
    assert!(plan.is_some());
    assert_eq!(said, ["warning Dialect not_of_form", "warning Request_Code not_of_form"]);
}

#[test]
fn a_bad_path_is_shown_where_it_is_in_the_words() {
    let config = SendReq { data_to_send: "0000 030E 0120 0434 0730".into(), ..etc100() };
    let findings = MessagePlan::of(&config.into()).1;
    assert_eq!(
        findings[0].rule.to_string(),
        "16#34 at byte 6 (word 3, low byte) is no path segment that is understood"
    );
}

#[test]
fn a_period_is_when_it_triggers() {
    for (period, trigger) in [(0, TriggerType::Once), (1, TriggerType::Fast), (500, TriggerType::Every(500))]
    {
        let plan = MessagePlan::of(&SendReq { period, ..etc100() }.into()).0.unwrap();
        assert_eq!(plan.trigger(), trigger);
    }
}

#[test]
fn the_read_of_a_write_keeps_its_path_and_its_registers() {
    let write = |words: &str| {
        let length = 2 * i64::try_from(read_words(words).unwrap().len()).unwrap();
        let config =
            SendReq { data_to_send: words.into(), management_param: vec![0, 0, 0, length], ..etc100() };
        MessagePlan::of(&config.into()).0.unwrap()
    };
    let set = write("0001 0510 0021 0004 0025 0096 0330 0201");
    let read = set.reader().unwrap();
    assert_eq!(read.bytes()[..], hex!("0E 05 21 00 04 00 25 00 96 00 30 03"));
    assert_eq!((set.written(), read.access()), (&hex!("01 02")[..], Access::Read));
    assert!(
        read.words().is_none() && read.ucmm_timeout_ms() == 10_000,
        "a read of our own does not wait for ever"
    );
    assert_eq!(read.connection().map(|connection| connection.timeout_ms), Some(10_000));
    let registers = write("0000 0250 4420 0124 0005 0001 002A");
    let read = registers.reader().unwrap();
    assert_eq!(read.bytes()[..], hex!("4E 02 20 44 24 01 05 00 01 00"));
    assert_eq!(registers.written(), hex!("2A 00"));
}

#[test]
fn fields_are_named_and_what_is_no_object_stays_as_it_is() {
    let words = read_words("0001 C0A8 0166 030E 0120 0124 0730 0011").unwrap();
    let fields = WordsFields::read(SendReqForm::Etc101, &words, 15).unwrap();
    let object = WordsObject { class: 1, instance: Some(1), attribute: Some(7), members: vec![] };
    assert_eq!(
        fields,
        WordsFields {
            message_type: 1,
            ip: [192, 168, 1, 102],
            service: 0x0E,
            path: WordsPath::Object(object),
            data: vec![0x11],
            behind: vec![],
        }
    );
    for (path, object) in [
        (&hex!("21 00 01 00 24 01")[..], false),
        (&hex!("24 01"), false),
        (&hex!("91 03 41 42 43 00"), false),
        (&hex!("34 04 01 00"), false),
        (&hex!("20 04 24 96 28 01 28 02"), true),
        (&hex!("20 04"), true),
        (&hex!("20 04 30 01"), false),
    ] {
        let found = WordsPath::of(path);
        assert_eq!(
            (matches!(found, WordsPath::Object(_)), found.bytes()),
            (object, path.to_vec()),
            "{path:02x?}"
        );
    }
}

#[test]
fn every_preset_is_a_block_without_findings_in_every_form() {
    for preset in Preset::ALL {
        for form in SendReqForm::ALL {
            let config = preset.block(form, [192, 168, 1, 102]);
            let (plan, said) = checked(&config);
            assert_eq!(said, [""; 0], "{} {form}", preset.id);
            let device = Target::Network(Endpoint::of_ip([192, 168, 1, 102]));
            assert_eq!(plan.unwrap().target(), &device);
        }
        assert_eq!(Preset::of_id(preset.id), Some(preset));
    }
    let read = Preset::of_id("modbus-read").unwrap().block(SendReqForm::Etc101, [192, 168, 1, 102]);
    let words = "0000 C0A8 0166 024E 4420 0124 0000 000A";
    assert_eq!((read.data_to_send.as_str(), read.management_param[3]), (words, 16));
}

#[cfg(not(target_arch = "wasm32"))]
mod any {
    use super::*;
    use proptest::prelude::*;

    fn forms() -> impl Strategy<Value = SendReqForm> {
        prop::sample::select(SendReqForm::ALL.to_vec())
    }

    fn objects() -> impl Strategy<Value = WordsPath> {
        let number = || prop_oneof![0..300_u32, any::<u32>()];
        (
            number(),
            prop::option::of((number(), prop::option::of(number()))),
            prop::collection::vec(number(), 0..4),
        )
            .prop_map(|(class, rest, members)| {
                let (instance, attribute) = rest.unzip();
                WordsPath::Object(WordsObject { class, instance, attribute: attribute.flatten(), members })
            })
    }

    prop_compose! {
        fn any_fields()(
            form in forms(), service: u8, path in objects(), data in prop::collection::vec(any::<u8>(), 0..40),
            ip: [u8; 4], message_type: u16, behind in prop::collection::vec(any::<u8>(), 0..6),
        ) -> (SendReqForm, WordsFields) {
            let message_type = if form == SendReqForm::DataExch { 0 } else { message_type };
            let ip = if form == SendReqForm::Etc101 { ip } else { [0; 4] };
            // Words have two bytes: there is one behind an odd length.
            let odd = data.len() % 2 == 1;
            let mut behind = behind;
            if odd == (behind.len() % 2 == 0) && !(odd && behind.is_empty()) {
                behind.push(7);
            }
            (form, WordsFields { message_type, ip, service, path, data, behind })
        }
    }

    proptest! {
        #[test]
        fn words_become_fields_and_the_same_words(
            form in forms(), words in prop::collection::vec(any::<u16>(), 0..40), cut in 0..5_usize,
        ) {
            let length = (2 * words.len()).saturating_sub(cut);
            if let Ok(fields) = WordsFields::read(form, &words, length) {
                let (again, sent) = fields.write(form).unwrap();
                prop_assert_eq!((again, usize::from(sent)), (words, length));
            }
        }

        #[test]
        fn fields_become_words_and_the_same_fields((form, fields) in any_fields()) {
            prop_assume!(fields.behind != [0]);
            let (words, length) = fields.write(form).unwrap();
            prop_assert_eq!(WordsFields::read(form, &words, length.into()), Ok(fields));
        }

        #[test]
        fn requests_with_a_path_become_fields(
            form in forms(), service: u8, path in objects(), data in prop::collection::vec(any::<u8>(), 0..40),
        ) {
            let fields = WordsFields {
                message_type: 0, ip: [0; 4], service, path, data, behind: vec![],
            };
            let (words, length) = fields.write(form).unwrap();
            let config = BlockConfig::from(SendReq {
                management_param: vec![0, 0, 30, length.into()],
                ..block(form, match form {
                    SendReqForm::Etc100 => "0.2.0.10.0.0.1",
                    SendReqForm::Etc101 => "0.2.0",
                    SendReqForm::DataExch => "0.2.0{10.0.0.1}UNC.CIP",
                }, &write_words(&words), 0)
            });
            let plan = MessagePlan::check(&config).0;
            prop_assert_eq!(plan.is_some(), (1..=127).contains(&service));
            if let Some(plan) = plan {
                let expected = [&[service, u8::try_from(fields.path.bytes().len() / 2).unwrap()], &fields.path.bytes()[..], &fields.data].concat();
                prop_assert_eq!(&plan.bytes()[..], &expected[..]);
                prop_assert_eq!(plan.routed(crate::config::Profile::Auto).message(), &expected[..]);
            }
        }

        #[test]
        fn any_text_is_taken(address in ".{0,60}", words in "[0-9A-F #x;]{0,60}", length: i64, timeout: i64) {
            for form in SendReqForm::ALL {
                let config = SendReq {
                    management_param: vec![0, 0, timeout, length],
                    ..block(form, &address, &words, 0)
                };
                let (plan, findings) = MessagePlan::check(&config.into());
                let sound = findings.iter().all(|finding| finding.severity != Severity::Error);
                prop_assert_eq!(plan.is_some(), sound);
            }
        }
    }
}
