//! Good, stale, bad; and why.

use cipdeck_shared::engine::poll::{Quality, Reason};
use cipdeck_shared::engine::time::Millis;
use cipdeck_shared::tag::Dialect;

use crate::device::Device;
use crate::owner::Owner;
#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

fn two() -> Owner {
    let mut owner = Owner::new(Device::new(Dialect::Logix).with("a", "DINT", "1").with("b", "REAL", "2.5"));
    owner.group(1, 100, &["a", "b"]);
    owner
}

#[test]
fn a_pulled_cable_makes_values_stale_and_asks_once_per_period() {
    let mut owner = two();
    owner.run(150);
    owner.is_lost = true;
    owner.answer_us = 2_000;
    owner.sent.clear();
    owner.run(1_000);
    assert_eq!(owner.sent.len(), 10);
    let reading = owner.reading(10);
    assert_eq!(owner.shown(10), (Quality::Stale, "1".to_owned()));
    assert_eq!(reading.reason.as_ref().map(Reason::text).as_deref(), Some("no answer"));
    owner.is_lost = false;
    owner.run(100);
    owner.all_good(&[(10, "1"), (11, "2.5")]);
}

#[test]
fn without_an_answer_from_the_beginning_there_is_nothing_to_be_stale() {
    let mut owner = two();
    owner.is_lost = true;
    owner.run(50);
    assert_eq!(owner.shown(10), (Quality::Bad, String::new()));
}

#[test]
fn two_missed_periods_make_a_value_stale() {
    let mut owner = two();
    owner.run(50);
    let request = owner.poller.poll_request(owner.now + Millis(60)).unwrap();
    assert!(!request.bytes.is_empty());
    assert_eq!(owner.reading(10).quality, Quality::Good);
    let timeout = owner.poller.poll_timeout().unwrap();
    assert!(timeout <= owner.now + Millis(300), "{timeout:?}");
    owner.poller.poll_request(timeout);
    assert_eq!((owner.reading(10).quality, &owner.reading(10).reason), (Quality::Stale, &Some(Reason::Late)));
}

#[test]
fn a_change_is_told_once_and_says_whether_the_value_is_another_one() {
    let mut owner = two();
    owner.run(450);
    let mut told = vec![owner.poller.poll_change(), owner.poller.poll_change()];
    told.sort();
    assert_eq!(told, [Some((1, 10)), Some((1, 11))]);
    assert_eq!(owner.poller.poll_change(), None);
    let first = owner.reading(10).changed;
    assert!(owner.reading(10).at > first);
    owner.device.set("a", "5");
    owner.run(100);
    assert_eq!(owner.reading(10).changed, owner.reading(10).at);
}

#[test]
fn another_type_than_the_given_one_is_bad_and_says_which_it_is() {
    let mut owner =
        Owner::new(Device::new(Dialect::Logix).with("a", "DINT", "1").with("st", "STRUCT{x: INT}", "{x: 1}"));
    owner.group(1, 100, &["a : REAL", "a : DWORD", "st : DINT", "st : STRUCT{x: INT; y: DINT}"]);
    owner.run(50);
    owner.all_good(&[(11, "1")]);
    assert_eq!(owner.reading(10).reason, Some(Reason::OtherType("DINT".into())));
    assert_eq!(owner.reading(12).quality, Quality::Bad);
    assert!(matches!(owner.reading(13).reason, Some(Reason::Unreadable(_))), "{:?}", owner.reading(13));
}

#[test]
fn a_bool_is_not_taken_from_numbers() {
    let device = Device::new(Dialect::Logix).with("Arr", "DINT[4]", "[7, 7, 7, 7]");
    let mut owner = Owner::new(device);
    owner.group(1, 100, &["Arr[37] : BOOL", "Arr[2] : BOOL"]);
    owner.run(50);
    for item in [10, 11] {
        assert_eq!(owner.reading(item).reason, Some(Reason::OtherType("DINT".into())));
    }
}

#[test]
fn a_structure_that_nobody_knows_is_its_bytes() {
    let mut owner =
        Owner::new(Device::new(Dialect::Logix).with("st", "STRUCT{x: INT; y: INT}", "{x: 1, y: 2}"));
    owner.group(1, 100, &["st"]);
    owner.run(50);
    owner.all_good(&[(10, "01 00 02 00")]);
}
