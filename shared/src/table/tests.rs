use super::*;
use crate::wire::ClassCode;
use alloc::string::{String, ToString};
use alloc::vec::Vec;

/// A table, its file, and the public function over it.
type Case = (&'static str, &'static str, fn(u32, Option<u32>) -> Option<Entry>);

fn small(code: u32) -> u16 {
    code.try_into().unwrap()
}

fn tiny(code: u32) -> u8 {
    code.try_into().unwrap()
}

const CASES: [Case; 11] = [
    ("services", include_str!("../../data/services.tsv"), |class, code| {
        // Common services are those of any class.
        let class = if class == 0 { 0xFFFF } else { small(class) };
        service(class, ServiceCode(tiny(code?)))
    }),
    ("classes", include_str!("../../data/classes.tsv"), |_, code| class(small(code?))),
    ("general status", include_str!("../../data/general_status.tsv"), |_, code| {
        general_status(GeneralStatus(tiny(code?)))
    }),
    (
        "connection manager",
        include_str!("../../data/extended_status_connection_manager.tsv"),
        |general, code| extended_status(GeneralStatus(tiny(general)), small(code?)),
    ),
    ("other extended", include_str!("../../data/extended_status_other.tsv"), |general, code| {
        extended_status(GeneralStatus(tiny(general)), small(code?))
    }),
    ("encapsulation", include_str!("../../data/encapsulation_status.tsv"), |_, code| {
        encapsulation_status(EncapsulationStatus(code?))
    }),
    ("block errors", include_str!("../../data/block_errors.tsv"), |error, code| {
        block_error(small(error), small(code.unwrap_or(0)))
    }),
    ("vendors", include_str!("../../data/vendors.tsv"), |_, code| vendor(small(code?))),
    ("device types", include_str!("../../data/device_types.tsv"), |_, code| device_type(small(code?))),
    ("reports", include_str!("../../data/reports.tsv"), |group, code| match (group, code?) {
        (0, code) => communication_report(tiny(code)),
        (1, code) => operation_report(ReportList::Etc100, 0, tiny(code)),
        (2, code) => operation_report(ReportList::Etc100, MESSAGE_REFUSED, tiny(code)),
        (3, code) => operation_report(ReportList::DataExch, MESSAGE_REFUSED, tiny(code)),
        (_, code) => module_event(small(code)),
    }),
    ("data types", include_str!("../../data/data_types.tsv"), |_, code| data_type(small(code?))),
];

fn parse(text: &str) -> Option<u32> {
    match text.strip_prefix("0x") {
        Some(hex) => u32::from_str_radix(hex, 16).ok(),
        None => text.parse().ok(),
    }
}

#[test]
fn every_row_of_every_table_is_found_with_all_its_columns() {
    let mut rows = 0;
    for (file, text, look_up) in CASES {
        for line in text.lines().skip(1) {
            let columns: Vec<&str> = line.split('\t').collect();
            let found = look_up(parse(columns[0]).unwrap_or(0), parse(columns[1]));
            let entry = found.unwrap_or_else(|| panic!("{file}: not found: {line}"));
            let printed = [entry.name, entry.meaning, entry.hint].map(String::from);
            assert_eq!(printed, [columns[2], columns[3], columns[4]].map(String::from), "{file}");
            let word = columns[5].to_lowercase().replace('_', " ");
            assert_eq!((entry.confidence.word().to_string(), entry.source), (word, columns[6]), "{file}");
            assert_eq!(Some(entry.code), parse(columns[1]).or(parse(columns[0])), "{file}: {line}");
            assert!(!entry.name.is_empty() && !entry.source.is_empty(), "{file}: {line}");
            assert!(line.is_ascii(), "{file}: {line}");
            rows += 1;
        }
    }
    assert_eq!(rows, 660, "a table has grown or shrunk: is the change wanted?");
}

#[test]
fn a_service_number_means_what_its_class_says() {
    let name = |class: ClassCode, code| service(class.0, ServiceCode(code)).map(|entry| entry.name);
    assert_eq!(name(ClassCode::ConnectionManager, 0x4E), Some("Forward_Close"));
    assert_eq!(name(ClassCode(0x44), 0x4E), Some("Read_Holding_Registers"));
    assert_eq!(name(ClassCode::EthernetLink, 0x4C), Some("Get_And_Clear"));
    assert_eq!(name(ClassCode::Identity, 0x4C), None);
    assert_eq!(name(ClassCode(0xEE), 0x0E), Some("Get_Attribute_Single"));
}

#[test]
fn an_unknown_sub_error_gives_the_row_of_its_error() {
    let name = |error, sub| block_error(error, sub).map(|entry| entry.name);
    assert_eq!(name(33, 50), Some("Bad service code"));
    assert_eq!(name(33, 99), Some("Parameter configuration error"));
    assert_eq!(name(224, 5), Some("CIP response error"));
    assert_eq!(name(0, 0), None);
    assert_eq!(name(1, 0), None);
}

#[test]
fn a_vendors_word_names_its_family() {
    let entry = extended_status(GeneralStatus(0xFF), 0x2107).unwrap();
    assert!(entry.meaning.contains("Logix"), "{}", entry.meaning);
    assert!(extended_status(GeneralStatus(0x20), 0x8017).unwrap().meaning.contains("Omron"));
    assert_eq!(extended_status(GeneralStatus::ConnectionFailure, 0x0204).unwrap().code, 0x0204);
}

#[test]
fn doubt_counts_as_a_write() {
    let rows = [
        ("reading an attribute", 0x0E, 0x01, Access::Read),
        ("reading an attribute of a class nobody knows", 0x0E, 0xEE, Access::Read),
        ("writing an attribute", 0x10, 0x04, Access::Write),
        ("a reset", 0x05, 0x01, Access::Write),
        ("reading counters clears them", 0x4C, 0xF6, Access::Write),
        ("the same number at another class", 0x4C, 0x6B, Access::Read),
        ("a vendor's service", 0x4C, 0x01, Access::Unknown),
        ("a route: what is inside?", 0x52, 0x06, Access::Unknown),
        ("several requests: what is inside?", 0x0A, 0x02, Access::Unknown),
        ("opening a connection", 0x54, 0x06, Access::Unknown),
        ("a read whose number is only inferred", 0x4B, 0x44, Access::Unknown),
        ("Modbus holding registers", 0x4E, 0x44, Access::Read),
        ("IO-Link", 0x4D, 0x3A3, Access::Read),
        ("a reply is no request", 0x8E, 0x01, Access::Unknown),
    ];
    for (name, code, class, access) in rows {
        assert_eq!(classify(ServiceCode(code), class), access, "{name}");
        assert_eq!(access.may_write(), access != Access::Read, "{name}");
    }
}

#[test]
fn every_service_says_what_it_does_and_only_confirmed_ones_read() {
    for row in SERVICES.rows() {
        let name = row.entry().name;
        assert!(matches!(row.access, "read" | "write" | "unknown"), "{name}");
        assert!(row.access != "read" || row.entry().confidence == Confidence::Confirmed, "{name}");
    }
}

#[test]
fn known_attributes_have_types_and_drive_parameters_do_not() {
    let names = |class, instance, number| -> Option<Vec<&str>> {
        Some(attribute(class, instance, number)?.iter().map(|field| field.kind.type_name()).collect())
    };
    let all = alloc::vec!["UINT", "UINT", "UINT", "USINT", "USINT", "WORD", "UDINT", "SHORT_STRING"];
    assert_eq!(names(1, 1, 0), Some(all));
    assert_eq!(names(1, 1, 4), Some(alloc::vec!["USINT", "USINT"]));
    assert_eq!(names(1, 1, 5), Some(alloc::vec!["WORD"]));
    assert_eq!(names(1, 1, 7), Some(alloc::vec!["SHORT_STRING"]));
    assert_eq!(names(1, 1, 8), None);
    assert_eq!(names(1, 0, 1), Some(alloc::vec!["UINT"]));
    assert_eq!(names(245, 1, 5).map(|names| names.len()), Some(6));
    assert_eq!(names(246, 1, 3), Some(alloc::vec!["USINT[6]"]));
    assert_eq!(names(246, 1, 0), None);
    assert_eq!(names(147, 1, 9), None);
    assert_eq!(names(4, 100, 3), None);
}
