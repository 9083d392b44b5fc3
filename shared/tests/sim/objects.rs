//! The objects, asked without a session.

use cipdeck_shared::sim::{Device, Registers, SimConfig};
use hex_literal::hex;

use super::frames::{MOVING, ask, at};

#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

#[test]
fn identity_answers_each_attribute_and_all_of_them() {
    let mut device = Device::default();
    let mut single = Vec::new();
    for number in 1..=7 {
        let (status, data) = ask(&mut device, &[0x0E, 3, 0x20, 1, 0x24, 1, 0x30, number], at(0));
        assert_eq!(status, 0, "attribute {number}");
        single.extend(data);
    }
    let (status, all) = ask(&mut device, &hex!("01 02 20 01 24 01"), at(0));
    assert_eq!((status, all.as_slice()), (0, single.as_slice()));
    assert!(all.ends_with(b"\x12cipdeck demo drive"));
}

#[test]
fn network_objects_say_where_the_device_is() {
    let mut device = Device::default();
    let (status, data) = ask(&mut device, &hex!("0E 03 20 F5 24 01 30 05"), at(0));
    assert_eq!((status, data.len(), &data[..8]), (0, 22, &hex!("01 00 00 7F 00 FF FF FF")[..]));
    assert_eq!(ask(&mut device, &hex!("0E 03 20 F6 24 01 30 01"), at(0)), (0, hex!("64 00 00 00").to_vec()));
    assert_eq!(ask(&mut device, &hex!("0E 03 20 F6 24 01 30 02"), at(0)), (0, hex!("0F 00 00 00").to_vec()));
    assert_eq!(ask(&mut device, &hex!("0E 03 20 F6 24 01 30 03"), at(0)).1.len(), 6);
}

#[test]
fn what_the_device_cannot_do_is_refused_with_the_right_status() {
    let mut write_31 = hex!("10 03 20 04 24 96 30 03").to_vec();
    write_31.extend([0; 31]);
    let mut write_33 = write_31.clone();
    write_33.extend([0; 2]);
    let rows: [(&str, &[u8], u8); 27] = [
        ("unknown class", &hex!("0E 03 20 EE 24 01 30 01"), 0x05),
        ("unknown class at class level", &hex!("0E 03 20 EE 24 00 30 01"), 0x05),
        ("unknown instance", &hex!("0E 03 20 01 24 02 30 01"), 0x05),
        ("unknown assembly", &hex!("0E 03 20 04 24 01 30 03"), 0x05),
        ("unknown parameter", &hex!("0E 03 20 93 24 02 30 09"), 0x05),
        ("unknown attribute of a class", &hex!("0E 03 20 01 24 00 30 04"), 0x14),
        ("read only class", &hex!("10 03 20 01 24 00 30 01 00 00"), 0x0E),
        ("all attributes of a class", &hex!("01 02 20 01 24 00"), 0x08),
        ("unknown attribute", &hex!("0E 03 20 01 24 01 30 63"), 0x14),
        ("no attribute", &hex!("0E 02 20 01 24 01"), 0x14),
        ("write to an unknown attribute", &hex!("10 03 20 01 24 01 30 63 00"), 0x14),
        ("unknown service", &hex!("4C 03 20 01 24 01 30 01"), 0x08),
        ("all attributes where they are not defined", &hex!("01 02 20 04 24 64"), 0x08),
        ("routed request without a message", &hex!("52 02 20 06 24 01 0A F0 00 00 01 00 01 00"), 0x20),
        ("routed request to another class", &hex!("52 02 20 01 24 01 0A F0 00 00 01 00 01 00"), 0x08),
        ("several requests in one", &hex!("0A 02 20 02 24 01 00 00"), 0x08),
        ("opening nothing", &hex!("54 02 20 06 24 01"), 0x13),
        ("closing nothing", &hex!("4E 02 20 06 24 01"), 0x13),
        ("read only identity", &hex!("10 03 20 01 24 01 30 07 00"), 0x0E),
        ("read only input", &hex!("10 03 20 04 24 64 30 03 00"), 0x0E),
        ("read only parameter", &hex!("10 03 20 93 24 01 30 09 00 00"), 0x0E),
        ("one byte too few", &write_31, 0x13),
        ("one byte too many", &write_33, 0x15),
        ("symbolic path", &hex!("4C 03 91 04 54 41 47 31 01 00"), 0x04),
        ("path longer than the message", &hex!("0E 09 20 01"), 0x26),
        ("a reply instead of a request", &hex!("8E 00"), 0x08),
        ("nothing", &[], 0x13),
    ];
    let mut device = Device::default();
    for (name, request, status) in rows {
        assert_eq!(ask(&mut device, request, at(0)), (status, Vec::new()), "{name}");
    }
}

#[test]
fn output_is_remembered_and_seen_in_the_input() {
    let mut device = Device::default();
    let value: Vec<u8> = (1..=32).collect();
    let write = [&hex!("10 03 20 04 24 96 30 03")[..], &value].concat();
    assert_eq!(ask(&mut device, &write, at(0)), (0, Vec::new()));
    assert_eq!(ask(&mut device, &hex!("0E 03 20 04 24 96 30 03"), at(5)), (0, value.clone()));
    let (_, input) = ask(&mut device, &MOVING, at(0));
    assert_eq!((input.len(), &input[16..]), (32, &value[..16]));
}

#[test]
fn input_and_drive_parameters_move_with_the_time_that_is_passed_in() {
    let mut device = Device::default();
    let (_, input) = ask(&mut device, &MOVING, at(1_000));
    assert_eq!(&input[..9], &hex!("E8 03 00 00 0A 00 E8 03 10")[..]);
    for parameter in [hex!("0E 03 20 93 24 01 30 09"), hex!("0E 03 20 93 24 07 30 09")] {
        let (first, later) = (ask(&mut device, &parameter, at(0)), ask(&mut device, &parameter, at(700)));
        assert_eq!((first.0, later.0), (0, 0));
        assert_ne!(first.1, later.1);
        assert_eq!(ask(&mut device, &parameter, at(700)), later);
    }
}

#[test]
fn drive_parameters_take_values_of_their_own_type() {
    let mut device = Device::default();
    let acceleration = hex!("0E 03 20 93 24 29 30 09");
    assert_eq!(ask(&mut device, &acceleration, at(0)), (0, hex!("E8 03").to_vec()));
    assert_eq!(ask(&mut device, &hex!("10 03 20 93 24 29 30 09 F4 01"), at(0)).0, 0);
    assert_eq!(ask(&mut device, &acceleration, at(9)), (0, hex!("F4 01").to_vec()));
    assert_eq!(ask(&mut device, &hex!("10 03 20 93 24 29 30 09 F4"), at(0)).0, 0x13);
    assert_eq!(ask(&mut device, &hex!("10 03 20 93 24 29 30 09 F4 01 00"), at(0)).0, 0x15);
    assert_eq!(ask(&mut device, &hex!("10 03 20 93 24 2B 30 09 00 00 48 42"), at(0)).0, 0);
    assert_eq!(ask(&mut device, &hex!("0E 03 20 93 24 2B 30 09"), at(0)), (0, hex!("00 00 48 42").to_vec()));
}

#[test]
fn several_attributes_are_read_at_once_each_with_its_own_status() {
    let mut device = Device::default();
    let list = |device: &mut Device, request: &[u8]| ask(device, request, at(0));
    assert_eq!(
        list(&mut device, &hex!("03 02 20 01 24 01 03 00 01 00 06 00 04 00")),
        (0, hex!("03 00 01 00 00 00 FF FF 06 00 00 00 C0 DE C1 00 04 00 00 00 01 01").to_vec())
    );
    assert_eq!(
        list(&mut device, &hex!("03 02 20 01 24 01 02 00 63 00 02 00")),
        (0x0A, hex!("02 00 63 00 14 00 02 00 00 00 02 00").to_vec())
    );
    assert_eq!(
        list(&mut device, &hex!("03 02 20 02 24 01 01 00 01 00")),
        (0x0A, hex!("01 00 01 00 14 00").to_vec())
    );
    assert_eq!(
        list(&mut device, &hex!("03 02 20 93 24 29 01 00 09 00")),
        (0, hex!("01 00 09 00 00 00 E8 03").to_vec())
    );
    assert_eq!(list(&mut device, &hex!("03 02 20 F6 24 01 00 00")), (0, hex!("00 00").to_vec()));
    assert_eq!(list(&mut device, &hex!("03 02 20 01 24 01")).0, 0x13);
    assert_eq!(list(&mut device, &hex!("03 02 20 01 24 01 02 00 01 00")).0, 0x13);
    assert_eq!(list(&mut device, &hex!("03 02 20 01 24 01 01 00 01 00 02")).0, 0x15);
    assert_eq!(list(&mut device, &hex!("03 02 20 EE 24 01 01 00 01 00")).0, 0x05);
    let mut endless = hex!("03 02 20 04 24 64 FF 7F").to_vec();
    endless.extend([3, 0].repeat(0x7FFF));
    assert_eq!(list(&mut device, &endless), (0x11, Vec::new()), "longer than a frame");
}

#[test]
fn every_class_says_its_revision_and_its_instances() {
    let mut device = Device::default();
    for (class, revision, max, number) in [
        (0x01, 1, 1, 1),
        (0x02, 1, 1, 1),
        (0x04, 2, 150, 2),
        (0x06, 1, 1, 1),
        (0x93, 1, 43, 5),
        (0xF5, 1, 1, 1),
        (0xF6, 1, 1, 1),
    ] {
        for (attribute, value) in [(1, revision), (2, max), (3, number)] {
            let read = ask(&mut device, &[0x0E, 3, 0x20, class, 0x24, 0, 0x30, attribute], at(0));
            assert_eq!(read, (0, vec![value, 0]), "class {class:#x}, attribute {attribute}");
        }
    }
    let list = ask(&mut device, &hex!("03 02 20 04 24 00 02 00 01 00 03 00"), at(0));
    assert_eq!(list, (0, hex!("02 00 01 00 00 00 02 00 03 00 00 00 02 00").to_vec()));
}

#[test]
fn holding_registers_are_read_and_written() {
    let registers = Some(Registers::default());
    let mut device = Device::new(SimConfig { registers, ..SimConfig::default() });
    let read = hex!("4E 02 20 44 24 01 05 00 03 00");
    assert_eq!(ask(&mut device, &read, at(0)), (0, hex!("05 00 06 00 07 00").to_vec()));
    assert_eq!(ask(&mut device, &hex!("50 02 20 44 24 01 06 00 01 00 34 12"), at(0)), (0, vec![]));
    assert_eq!(ask(&mut device, &read, at(0)), (0, hex!("05 00 34 12 07 00").to_vec()));
    let rows: [(&str, &[u8], u8); 9] = [
        ("no quantity", &hex!("4E 02 20 44 24 01 05 00"), 0x13),
        ("more than that", &hex!("4E 02 20 44 24 01 05 00 01 00 00"), 0x15),
        ("none at all", &hex!("4E 02 20 44 24 01 05 00 00 00"), 0x20),
        ("too many", &hex!("4E 02 20 44 24 01 05 00 7C 00"), 0x20),
        ("over the end", &hex!("4E 02 20 44 24 01 E7 03 02 00"), 0x20),
        ("too few to write", &hex!("50 02 20 44 24 01 05 00 02 00 34 12"), 0x13),
        ("too many to write", &hex!("50 02 20 44 24 01 05 00 01 00 34 12 00"), 0x15),
        ("another service", &hex!("4D 02 20 44 24 01 05 00 01 00"), 0x08),
        ("an attribute", &hex!("0E 03 20 44 24 01 30 01"), 0x14),
    ];
    for (name, request, status) in rows {
        assert_eq!(ask(&mut device, request, at(0)).0, status, "{name}");
    }
    assert_eq!(ask(&mut device, &hex!("4E 02 20 44 24 01 00 00 7B 00"), at(0)).1.len(), 246);
    assert_eq!(ask(&mut Device::default(), &read, at(0)).0, 0x05, "a device without any");
}
