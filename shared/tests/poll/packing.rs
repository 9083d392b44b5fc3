//! In few requests.

use cipdeck_shared::tag::Dialect;

use crate::device::Device;
use crate::owner::Owner;
#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

#[test]
fn two_tags_of_one_group_travel_together_as_in_the_document() {
    let device = Device::new(Dialect::Omron).with("TAG1", "BOOL", "TRUE").with("TAG2", "BOOL", "FALSE");
    let mut owner = Owner::new(device);
    owner.group(1, 100, &["TAG1", "TAG2"]);
    let request = owner.poller.poll_request(owner.now).unwrap();
    // the message router request of the document's multi read
    let golden = hex_literal::hex!(
        "0A 02 20 02 24 01 02 00 06 00 10 00 4C 03 91 04 54 41 47 31 01 00 4C 03 91 04 54 41 47 32 01 00"
    );
    assert_eq!(request.bytes, golden);
    let reply = owner.device.answer(&request.bytes);
    owner.poller.handle_reply(owner.now, Ok(&reply));
    owner.all_good(&[(10, "TRUE"), (11, "FALSE")]);
}

#[test]
fn what_lies_in_a_structure_that_is_read_is_taken_from_there() {
    let kind = "STRUCT{speed: REAL; run: BOOL; hist: INT[4]; word: WORD}";
    for dialect in [Dialect::Logix, Dialect::Omron, Dialect::Micro800] {
        let value = "{speed: 12.5, run: TRUE, hist: [1, 2, 3, 4], word: 16#0004}";
        let mut owner = Owner::new(Device::new(dialect).with("st", kind, value));
        let whole = format!("st : {kind}");
        owner.group(
            1,
            100,
            &[&whole, "st.speed", "st.run : BOOL", "st.hist", "st.hist[2]", "st.word.2", "st.word.3"],
        );
        owner.run(50);
        owner.all_good(&[
            (11, "12.5"),
            (12, "TRUE"),
            (13, "[1, 2, 3, 4]"),
            (14, "3"),
            (15, "TRUE"),
            (16, "FALSE"),
        ]);
        assert_eq!(owner.requests(), [["st"]], "{dialect:?}");
    }
}

#[test]
fn neighbouring_elements_are_one_question_as_soon_as_their_type_is_known() {
    let device = Device::new(Dialect::Micro800).with("Arr", "DINT[20]", &list(20)).with("x", "INT", "7");
    let mut owner = Owner::new(device);
    owner.group(1, 100, &["Arr[3]", "x", "Arr[5]", "Arr[4]", "Arr[8] : DINT", "Arr[9] : DINT"]);
    owner.run(50);
    assert_eq!(owner.requests().len(), 5, "8 and 9 together, the others by themselves");
    owner.run(100);
    owner.all_good(&[(10, "3"), (11, "7"), (12, "5"), (13, "4"), (14, "8"), (15, "9")]);
    let mut requests = owner.requests();
    requests.sort();
    assert_eq!(requests, [["Arr[3]"], ["Arr[8]"], ["x"]]);
}

#[test]
fn bits_of_one_word_are_one_question() {
    let mut owner = Owner::new(Device::new(Dialect::Micro800).with("Status", "WORD", "16#8001"));
    owner.group(1, 100, &["Status.0", "Status.1 : BOOL", "Status.15", "Status"]);
    owner.run(50);
    owner.all_good(&[(10, "TRUE"), (11, "FALSE"), (12, "TRUE"), (13, "32769")]);
    assert_eq!(owner.requests().len(), 1);
}

#[test]
fn bools_of_a_logix_array_come_in_dwords() {
    let mut owner = Owner::new(Device::new(Dialect::Logix).with("Flags", "BOOL[64]", &bools(64, 37)));
    owner.group(1, 100, &["Flags[37] : BOOL", "Flags[36] : BOOL", "Flags[5] : BOOL"]);
    owner.run(50);
    owner.all_good(&[(10, "TRUE"), (11, "FALSE"), (12, "FALSE")]);
    assert_eq!(owner.requests(), [["Flags[1]", "Flags[0]"]]);
}

#[test]
fn bools_without_a_type_are_found_in_their_dwords_and_plain_ones_where_they_are() {
    for plain_bools in [false, true] {
        let device = Device::new(Dialect::Logix).with("Flags", "BOOL[64]", &bools(64, 37));
        let mut owner = Owner::new(Device { plain_bools, ..device });
        owner.group(1, 100, &["Flags[1]", "Flags[37] : BOOL"]);
        owner.run(250);
        owner.all_good(&[(10, "FALSE"), (11, "TRUE")]);
    }
}

#[test]
fn groups_that_are_due_together_share_a_request() {
    let mut device = Device::new(Dialect::Logix);
    for name in ["a", "b", "c"] {
        device = device.with(name, "DINT", "1");
    }
    let mut owner = Owner::new(device);
    owner.group(1, 100, &["a"]);
    owner.group(2, 200, &["b"]);
    owner.run(30);
    owner.group(3, 100, &["c"]);
    owner.run(30);
    owner.requests();
    owner.run(200);
    assert_eq!(owner.requests(), [vec!["a", "c"], vec!["a", "b", "c"]]);
}

#[test]
fn a_thousand_numbers_of_a_logix_take_as_many_requests_as_their_bytes_need() {
    let mut device = Device { request_max: 4_000, reply_max: 4_000, ..Device::new(Dialect::Logix) };
    let names: Vec<String> = (0..1_000).map(|number| format!("D{number:04}")).collect();
    for name in &names {
        device = device.with(name, "DINT", "5");
    }
    let limits = cipdeck_shared::engine::poll::DeviceLimits::of(Dialect::Logix, true);
    let mut owner = Owner::with_limits(device, limits);
    owner.group(1, 100, &names.iter().map(String::as_str).collect::<Vec<_>>());
    owner.run(150);
    owner.requests();
    owner.run(100);
    // 14 bytes for each question with its offset: 285 fit into 4,000 bytes
    assert_eq!(owner.requests().len(), 4);
    assert_eq!(owner.poller.load().requests_per_cycle, 4);
}

fn list(count: usize) -> String {
    format!("[{}]", (0..count).map(|number| number.to_string()).collect::<Vec<_>>().join(", "))
}

fn bools(count: usize, on: usize) -> String {
    let bool = |place| if place == on { "TRUE" } else { "FALSE" };
    format!("[{}]", (0..count).map(bool).collect::<Vec<_>>().join(", "))
}
