//! A bad tag does not harm the others.

use cipdeck_shared::engine::poll::{DeviceLimits, Failure, Group, Item, Poller, Quality, Reason};
use cipdeck_shared::engine::time::{Instant, Millis};
use cipdeck_shared::tag::Dialect;
use cipdeck_shared::wire::GeneralStatus;

use crate::device::Device;
use crate::owner::Owner;
#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

const FAMILIES: [Dialect; 3] = [Dialect::Logix, Dialect::Omron, Dialect::Micro800];

#[test]
fn one_bad_tag_among_fifty_is_asked_for_more_and_more_rarely() {
    for dialect in FAMILIES {
        let names: Vec<String> = (0..50).map(|number| format!("x{number}")).collect();
        let mut device = Device::new(dialect);
        for name in &names {
            device = device.with(name, "INT", "3");
        }
        device.tags.remove("x20");
        let mut owner = Owner::new(device);
        owner.group(1, 1_000, &names.iter().map(String::as_str).collect::<Vec<_>>());
        owner.run(500);
        for item in (10..60).filter(|item| *item != 30) {
            owner.all_good(&[(item, "3")]);
        }
        let words = Vec::new();
        let reason = Reason::Refused { status: GeneralStatus::PathDestinationUnknown, words };
        assert_eq!(owner.reading(30).reason, Some(reason));
        assert_eq!(owner.poller.load().bad_items, 1);
        owner.requests();
        owner.run(200_000);
        let alone: Vec<usize> = owner
            .requests()
            .iter()
            .enumerate()
            .filter(|(_, names)| **names == ["x20"])
            .map(|(at, _)| at)
            .collect();
        assert_eq!(alone.len(), 5, "6, 17, 38, 79, 140 s: {alone:?}");
        owner.device = Device { log: Vec::new(), ..owner.device.with("x20", "INT", "4") };
        owner.run(61_000);
        owner.all_good(&[(30, "4")]);
    }
}

#[test]
fn when_one_is_back_the_others_are_tried_again() {
    let names: Vec<String> = (0..30).map(|number| format!("x{number}")).collect();
    let mut owner = Owner::new(Device::new(Dialect::Logix));
    owner.group(1, 1_000, &names.iter().map(String::as_str).collect::<Vec<_>>());
    owner.run(300_000);
    assert_eq!(owner.poller.load().bad_items, 30);
    for name in &names {
        owner
            .device
            .tags
            .insert(name.clone(), ("DINT".parse().unwrap(), cipdeck_shared::tag::Value::Signed(1)));
    }
    owner.run(62_000);
    assert_eq!(owner.poller.load().bad_items, 0, "soon after the first");
}

#[test]
fn elements_beyond_the_end_do_not_spoil_their_neighbours() {
    for dialect in FAMILIES {
        let mut owner = Owner::new(Device::new(dialect).with("Arr", "INT[6]", "[0, 1, 2, 3, 4, 5]"));
        let names: Vec<String> = (0..9).map(|index| format!("Arr[{index}] : INT")).collect();
        owner.group(1, 100, &names.iter().map(String::as_str).collect::<Vec<_>>());
        owner.run(50);
        owner.all_good(&[(10, "0"), (13, "3"), (15, "5")]);
        for item in 16..19 {
            assert_eq!(owner.reading(item).quality, Quality::Bad);
        }
        owner.requests();
        owner.run(100);
        assert!(owner.requests().len() <= 3, "{dialect:?}");
    }
}

#[test]
fn members_are_read_by_themselves_while_their_structure_is_bad() {
    let kind = "STRUCT{x: INT; y: INT}";
    let mut owner = Owner::new(Device::new(Dialect::Omron).with("st", kind, "{x: 1, y: 2}"));
    owner.device.refuses.insert("st".into(), (0x1F, Some(0x8018)));
    owner.group(1, 100, &[&format!("st : {kind}"), "st.x", "st.y"]);
    owner.run(50);
    owner.all_good(&[(11, "1"), (12, "2")]);
    assert_eq!(owner.reading(10).quality, Quality::Bad);
    owner.device.refuses.clear();
    owner.run(6_000);
    owner.all_good(&[(10, "{x: 1, y: 2}"), (11, "1")]);
    owner.requests();
    owner.run(100);
    assert_eq!(owner.requests(), [["st"]], "the whole serves its members again");
}

#[test]
fn a_name_that_fits_into_no_request_is_never_sent() {
    let long = ["m"; 126].map(|part| part.repeat(2)).join(".");
    let mut owner = Owner::new(Device::new(Dialect::Logix).with("a", "INT", "1"));
    owner.group(1, 100, &["a", &long]);
    owner.run(50);
    owner.all_good(&[(10, "1")]);
    assert_eq!(owner.reading(11).reason, Some(Reason::NameTooLong));
}

#[test]
fn a_device_that_is_busy_is_asked_again_in_the_next_period() {
    let mut owner = Owner::new(Device::new(Dialect::Omron).with("a", "INT", "1").with("b", "INT", "2"));
    owner.device.refuses.insert("a".into(), (0x0C, Some(0x8010)));
    owner.group(1, 100, &["a", "b"]);
    owner.run(50);
    assert_eq!(owner.reading(10).quality, Quality::Bad);
    owner.device.refuses.clear();
    owner.run(100);
    owner.all_good(&[(10, "1"), (11, "2")]);
}

#[test]
fn a_message_that_the_device_does_not_take_is_about_its_tag_alone() {
    let limits = DeviceLimits { packs: false, ..DeviceLimits::of(Dialect::Logix, false) };
    let mut poller = Poller::new(limits);
    let item = |id, name: &str| Item { id, name: name.parse().unwrap(), kind: None };
    let items = vec![item(1, "missing"), item(2, "there")];
    poller.put_group(Group { id: 1, period: Millis(1_000), on: true, items }, Instant(0));
    assert!(poller.poll_request(Instant(0)).is_some());
    poller.handle_reply(Instant(1), Err(Failure::NotTaken { reason: "status 0x08".into() }));
    assert!(poller.poll_request(Instant(2)).is_some(), "the other one is read in the same cycle");
    poller.handle_reply(Instant(3), Ok(&[0xCC, 0, 0, 0, 0xC3, 0, 7, 0]));
    let missing = poller.reading(1).unwrap();
    assert_eq!(
        (missing.quality, missing.reason.as_ref().unwrap().text().as_str()),
        (Quality::Bad, "status 0x08")
    );
    let there = poller.reading(2).unwrap();
    assert_eq!((there.quality, there.value.as_ref().unwrap().to_string().as_str()), (Quality::Good, "7"));
}
