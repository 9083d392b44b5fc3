//! Whole texts: what a person pastes.

use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec;
use alloc::vec::Vec;

use super::*;
use crate::config::{MsgCipGeneric, SendReq, SendReqForm, write_hex};
use crate::plan::{MessagePlan, Severity};

fn message(number: u32) -> MsgCipGeneric {
    let mut config = MsgCipGeneric::product_name("4,192.168.1.102");
    config.name = format!("message {number}");
    config.app_cfg.instance = number.into();
    config
}

fn request(found: &Found) -> String {
    MessagePlan::of(&found.config).0.map_or_else(|| "no plan".into(), |plan| write_hex(plan.bytes()))
}

fn errors(imported: &Imported) -> Vec<String> {
    let blocks = imported.blocks.iter().flat_map(|found| &found.remarks);
    let all = imported.remarks.iter().chain(blocks);
    all.filter(|remark| remark.severity == Severity::Error).map(ToString::to_string).collect()
}

#[test]
fn what_a_conversion_sends_otherwise_does_not_run() {
    let mut words = SendReq::new(SendReqForm::Etc100, "turned");
    words.address = "ADDR('0.2.0.192.168.1.102')".into();
    // Instance before class: other bytes in every dialect that writes the path by itself.
    (words.data_to_send, words.management_param) = ("0000 030E 0124 0120 0730".into(), vec![0, 0, 30, 10]);
    let routed = MsgCipGeneric::product_name("4,192.168.1.102,1,3");
    let held = [
        (words.clone().into(), Dialect::CcwSt, "(FALSE AND "),
        (words.clone().into(), Dialect::L5x, "AFI()"),
        (words.clone().into(), Dialect::SysmacSt, "FALSE AND "),
        (words.clone().into(), Dialect::Pycomm3, "raise SystemExit(\"this script does not"),
        (words.clone().into(), Dialect::Rust, "return Err("),
        (words.into(), Dialect::Cli, "\nfalse && cipdeck send "),
        (routed.clone().into(), Dialect::SendReqEtc100, "IF FALSE AND "),
        (routed.into(), Dialect::DataExch, "IF FALSE AND "),
    ];
    for (block, dialect, guard) in held {
        let text = export(&block, dialect, &Options::default()).text;
        assert!(text.contains(guard), "{dialect}: {text}");
        let imported = import(&text, Some(dialect));
        assert_eq!((imported.blocks.len(), errors(&imported)), (1, Vec::new()), "{dialect}: {text}");
        let straight = export(&message(1).into(), dialect, &Options::default()).text;
        assert!(!straight.contains(guard), "{dialect}: {straight}");
    }
}

#[test]
fn twenty_messages_of_mixed_dialects_are_twenty_blocks_in_their_order() {
    use Dialect::{
        CcwSt, Cli, DataExch, Hex, Json, L5x, Pycomm3, Rust, SendReqEtc100, SendReqEtc101, SysmacSt,
    };
    let order = [
        CcwSt,
        SysmacSt,
        SendReqEtc100,
        Json,
        Hex,
        L5x,
        Cli,
        Pycomm3,
        Rust,
        DataExch,
        SendReqEtc101,
        Hex,
        CcwSt,
        Json,
        SendReqEtc100,
        SysmacSt,
        Cli,
        L5x,
    ];
    let mut text = String::new();
    for (number, dialect) in (1..).zip(order) {
        text.push_str(&export(&message(number).into(), dialect, &Options::default()).text);
        text.push('\n');
    }
    text.push_str(
        "Parâmetro\tValor\nServiço\t14\nClasse\t1\nInstância\t19\nAtributo\t7\nCaminho\t4,192.168.1.102\n\n",
    );
    text.push_str("| Case | Words | Length |\n|---|---|---|\n| ETC 100 | 0000 030E 0120 1424 0730 | 10 |\n");
    let imported = import(&text, None);
    assert_eq!(errors(&imported), Vec::<String>::new(), "{text}");
    let requests: Vec<String> = imported.blocks.iter().map(request).collect();
    let expected: Vec<String> = (1..=20).map(|number| format!("0e032001{}{number:02x}3007", 24)).collect();
    assert_eq!(requests, expected, "{text}");
    let dialects: Vec<Dialect> = imported.blocks.iter().map(|found| found.dialect).collect();
    assert_eq!(dialects, [&order[..], &[CcwSt, SendReqEtc100]].concat());
}

#[test]
fn a_text_that_is_too_long_is_not_read_and_one_with_too_many_messages_in_part() {
    let imported = import(&" ".repeat(MAX_TEXT + 1), None);
    assert_eq!(
        imported.remarks[0].to_string(),
        "1:1: error: a text has at most 1048576 bytes; nothing of it was read"
    );
    let imported = import(&"0E 03 20 01 24 01 30 07\n".repeat(MAX_BLOCKS + 5), None);
    assert_eq!(imported.blocks.len(), MAX_BLOCKS);
    assert_eq!(imported.remarks[0].line, MAX_BLOCKS + 1);
    let imported = import(&"?\n".repeat(5000), None);
    assert_eq!(imported.remarks.len(), MAX_REMARKS + 1);
    assert!(imported.remarks[MAX_REMARKS].to_string().contains("4000 more"));
}

#[test]
fn a_text_without_a_message_is_not_passed_over_in_silence() {
    for text in ["VAR", "END_IF;", ";;", "(* m(); *)", "# 0E 03", "<!-- -->", "$ "] {
        for dialect in Dialect::ALL.map(Some).into_iter().chain([None]) {
            let imported = import(text, dialect);
            assert!(imported.blocks.is_empty() && !imported.remarks.is_empty(), "{dialect:?}: {text}");
        }
    }
    assert_eq!(import(" \r\n", None), Imported::default());
}

#[test]
fn a_mebibyte_of_brackets_is_refused_in_time() {
    for unit in [
        "(",
        "[\n",
        "{\n",
        "<a>\n",
        "f(",
        "a := (",
        "0E 03\n",
        "IF a THEN\n",
        "Service\t1\n",
        "cipdeck send \\\n",
        "a[",
        "a : ARRAY[0..1] OF ",
        "a := 1;\n",
        "m(a,b,c,d,e,f,g);\n",
        "SEND_REQ(a,b,c,d,e);\n",
        "{},",
        "let a=(",
        "connect(",
    ] {
        let text = unit.repeat((1 << 14) / unit.len());
        for dialect in Dialect::ALL.map(Some).into_iter().chain([None]) {
            let _ = import(&text, dialect);
        }
    }
}

#[test]
fn the_size_of_a_table_of_memory_words_costs_nothing() {
    for size in ["99999999999", "18446744073709551615"] {
        let text = format!("SEND_REQ(ADDR('0.2.0.10.0.0.1'), 14, %MW0:{size}, %MW9:{size}, %MW20:{size});");
        let imported = import(&text, Some(Dialect::SendReqEtc100));
        assert_eq!(imported.blocks.len(), 1, "{:?}", imported.remarks);
    }
}

#[test]
fn a_short_text_that_says_much_is_not_calculated_for_ever() {
    let sum = format!("u : CIPUCMMSend;\nx := 1{};\n", "+1".repeat(4900));
    let bytes: Vec<String> = (0..490).map(|at| format!("d[{at}] := x;")).collect();
    let many = |call: &str| sum.clone() + &bytes.concat() + &call.repeat(100);
    for (call, dialect) in [
        ("m(1, c, a, t, d, 490, r);\n", Dialect::CcwSt),
        ("SEND_REQ(ADDR('0.2.0.10.0.0.1'), 14, d, d, r);\n", Dialect::SendReqEtc100),
        ("u(RqPath := p, ServiceCode := 1, ServiceDat := d[0], Size := 490);\n", Dialect::SysmacSt),
    ] {
        let imported = import(&many(call), Some(dialect));
        let told = imported.remarks.iter().any(|remark| remark.to_string().contains("too many values"));
        assert!(told && imported.blocks.len() == 100, "{dialect}: {:?}", imported.remarks);
    }
    let doubled = "a = b'0123456789abcdef'\n".to_string() + &"a = a + a + a + a\n".repeat(40);
    let script = doubled + "p = CIPDriver('10.0.0.1')\np.generic_message(14, 1, 1, request_data=a)\n";
    let imported = import(&script, Some(Dialect::Pycomm3));
    assert!(errors(&imported)[0].contains("request_data is not a constant"), "{:?}", errors(&imported));
}

#[cfg(not(target_arch = "wasm32"))]
mod properties {
    use proptest::prelude::*;

    use super::*;

    /// Parts of texts that mean something somewhere.
    fn part() -> impl Strategy<Value = String> {
        let known = proptest::sample::select(alloc::vec![
            "m1(",
            "IN := TRUE",
            "AppCfg := a",
            ")",
            ";",
            "\n",
            "(*",
            "*)",
            "//",
            "'",
            "\"",
            "$",
            "VAR",
            "END_VAR",
            ": MSG_CIPGENERIC",
            "a.Service := 14",
            "a.Class := 16#",
            "ARRAY[0..4] OF INT",
            ":=",
            "[",
            "]",
            "2(0)",
            "SEND_REQ(",
            "ADDR('0.2.0.10.0.0.1')",
            "%MW10:5",
            "16#030E",
            "LD ",
            "CIPUCMMSend(",
            "RoutePath := '02\\10.0.0.1'",
            "RqPath := p",
            "<Tag",
            "<![CDATA[",
            "<?xml",
            "</",
            "/>",
            "&amp;",
            "{\"name\":",
            "[{",
            "}",
            "0E 03 20 01",
            "0000  0e 03",
            "\t",
            "|",
            "Serviço\t14",
            "cipdeck send 4,1.2.3.4",
            "--class",
            "with CIPDriver('",
            "generic_message(",
            "service=0x0E,",
            "let ",
            "use rseip",
            "EPath::",
            ".await",
            "IF",
            "THEN",
            "CASE",
            "OF",
            "ü",
            "\u{feff}",
            "\r\n",
        ]);
        prop_oneof![4 => known.prop_map(String::from), 1 => ".{0,6}", 1 => "[0-9]{1,4}"]
    }

    proptest! {
        #[test]
        fn any_text_is_read_without_panic_and_every_remark_has_a_place(parts in proptest::collection::vec(part(), 0..60)) {
            let text = parts.concat();
            let lines = text.lines().count().max(1);
            for dialect in Dialect::ALL.map(Some).into_iter().chain([None]) {
                let imported = import(&text, dialect);
                let remarks = imported.blocks.iter().flat_map(|found| &found.remarks);
                for remark in imported.remarks.iter().chain(remarks) {
                    prop_assert!((1..=lines + 1).contains(&remark.line) && remark.column > 0, "{remark} of {lines}");
                }
                for found in &imported.blocks {
                    prop_assert!(found.lines.start >= 1 && found.lines.start < found.lines.end);
                }
                if let Some(dialect) = dialect {
                    let mut at = 0;
                    for (range, _) in highlight(dialect, &text) {
                        prop_assert!(range.start >= at && text.get(range.clone()).is_some());
                        at = range.end;
                    }
                }
            }
        }

        #[test]
        fn no_name_breaks_out_of_a_text(name in ".{0,40}") {
            let mut config = message(1);
            config.name = name;
            prop_assume!(MessagePlan::parse(&config).0.is_some());
            for dialect in Dialect::ALL {
                let code = export(&config.clone().into(), dialect, &Options::default());
                let imported = import(&code.text, Some(dialect));
                prop_assert_eq!(imported.blocks.len(), 1, "{}", code.text);
                prop_assert_eq!(request(&imported.blocks[0]), "0e03200124013007", "{}", code.text);
            }
        }
    }
}
