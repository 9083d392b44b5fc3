use alloc::string::{String, ToString};
use alloc::vec::Vec;

use super::*;

const NAME: &str = "0e03200124013007";

fn requests(text: &str) -> Vec<String> {
    let imported = import(text);
    let blocks = imported.blocks.iter().map(|found| {
        let plan = MessagePlan::of(&found.config).0.expect("a plan");
        alloc::format!("{:?} {}", found.lines, write_hex(plan.bytes()))
    });
    let remarks = imported.remarks.iter().map(ToString::to_string);
    blocks.chain(remarks).collect()
}

#[test]
fn every_spelling_is_read() {
    for text in [
        "0E 03 20 01 24 01 30 07",
        "0e03200124013007",
        "0x0E, 0x03, 0x20, 0x01, 0x24, 0x01, 0x30, 0x07",
        "{0x0E, 0x03, 0x20, 0x01, 0x24, 0x01, 0x30, 0x07};",
        "16#0E 16#03 16#20 16#01 16#24 16#01 16#30 16#07 # sixteen",
        "0Eh 03h 20h 01h 24h 01h 30h 07h",
        "0E-03-20-01-24-01-30-07",
        "0e03:2001:2401:3007 // words",
        "\\x0e\\x03\\x20\\x01\\x24\\x01\\x30\\x07",
        "0000  0e 03 20 01 24 01 30 07   .. .$.0.",
        "00000000: 0e03 2001 2401 3007                      .. .$.0.",
        "00000000  0e 03 20 01  24 01 30 07  |.. .$.0.|",
        "  0E 03 20 01 24 01 30 07  ",
    ] {
        assert_eq!(requests(text), [alloc::format!("1..2 {NAME}")], "{text}");
    }
}

#[test]
fn several_requests_stand_in_lines_and_one_may_go_on() {
    let text = "# two\n0E 03 20 01 24 01 30 07\n\n10 03 20 0F 24 27 30 01,\n0A 00\n
0000  4c 02 20 06 24 01 00 00 00 00 00 00 00 00 00 00  L. .$...........\n0010  41 42                                            AB";
    assert_eq!(
        requests(text),
        [
            alloc::format!("2..3 {NAME}"),
            "4..6 1003200f242730010a00".into(),
            "7..9 4c0220062401000000000000000000004142".into(),
        ]
    );
}

#[test]
fn what_is_no_request_is_told_with_its_place() {
    assert_eq!(
        requests("0E 3\n0E 03 20\nhello\n8E 00 00 00\n4C 03 91 04 54 41 47 31 01 00\n0010 zz"),
        [
            "1:4: error: bytes as two hexadecimal digits, such as 0E 03 20 01 is expected here: 0E 3",
            "2:1: error: no request for a message router: 5 more bytes expected at byte 3: 0E 03 20",
            "3:1: error: bytes as two hexadecimal digits, such as 0E 03 20 01 is expected here: hello",
            "4:1: error: no request for a message router: service of a request cannot be 0x8e at byte 0: 8E 00 00 00",
            "5:1: error: a MSG_CIPGENERIC sends to a class, an instance, an attribute and up to 3 members, in this \
             order: 4C 03 91 04 54 41 47 31 01 00",
            "6:6: error: bytes as two hexadecimal digits, such as 0E 03 20 01 is expected here: 0010 zz",
        ]
    );
}

#[test]
fn other_widths_and_the_missing_device_are_told() {
    let imported = import("0E 04 21 00 01 00 24 01 30 07");
    let told: Vec<String> = imported.blocks[0].remarks.iter().map(ToString::to_string).collect();
    assert!(
        told[0].contains("0E 04 21 00 01 00 24 01 30 07 -> 0E 03 20 01 24 01 30 07 (request)"),
        "{told:?}"
    );
    assert!(told[1].contains("warning") && told[1].contains("0,0"), "{told:?}");
}

#[test]
fn what_is_written_is_read_back() {
    let block = MsgCipGeneric::product_name("0,0").into();
    let Code { text, changes } = export(&block);
    assert_eq!(changes, Vec::new());
    assert_eq!(requests(&text), [alloc::format!("2..3 {NAME}")]);
    let block = MsgCipGeneric::product_name("4,10.0.0.1").into();
    assert_eq!(
        export(&block).changes[0].to_string(),
        "TargetCfg.Path 4,10.0.0.1 (lost): there is no such setting there; set it by other means if it matters"
    );
}
