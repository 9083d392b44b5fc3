//! On a grid, and not more often than allowed.

use cipdeck_shared::engine::poll::{DeviceLimits, Group, Quality, Reason};
use cipdeck_shared::engine::time::{Instant, Millis};
use cipdeck_shared::tag::Dialect;

use crate::device::Device;
use crate::owner::{Owner, item};
#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

fn one() -> Owner {
    Owner::new(Device::new(Dialect::Logix).with("a", "DINT", "1"))
}

#[test]
fn periods_run_from_start_to_start() {
    let mut owner = one();
    owner.group(1, 100, &["a"]);
    owner.run(450);
    let sent: Vec<u64> = owner.sent.iter().map(|at| at.0 - 1_000_000).collect();
    assert_eq!(sent, [0, 100_000, 200_000, 300_000, 400_000]);
    assert_eq!(owner.poller.load().skipped_periods, 0);
}

#[test]
fn a_stall_is_followed_by_one_request_and_its_periods_are_counted() {
    let mut owner = one();
    owner.group(1, 100, &["a"]);
    owner.run(150);
    owner.now = owner.now + Millis(10_000);
    owner.sent.clear();
    owner.run(120);
    assert_eq!(owner.sent.len(), 2, "one at once, one on the grid");
    assert_eq!((owner.sent[1].0 - 1_000_000) % 100_000, 0);
    assert_eq!(owner.poller.load().skipped_periods, 99);
}

#[test]
fn a_device_that_is_slower_than_the_period_is_asked_again_only_when_it_has_answered() {
    let mut owner = one();
    owner.answer_us = 250_000;
    owner.group(1, 100, &["a"]);
    owner.run(2_000);
    let gaps: Vec<u64> = owner.sent.windows(2).map(|pair| pair[1].0 - pair[0].0).collect();
    assert!(gaps.iter().all(|gap| *gap >= 250_000), "{gaps:?}");
    assert!(owner.poller.load().skipped_periods > 5);
    assert_eq!(owner.reading(10).quality, Quality::Good, "as fresh as this device can be");
}

#[test]
fn requests_per_second_are_a_limit_without_savings() {
    let mut device = Device::new(Dialect::Micro800);
    let names: Vec<String> = (0..20).map(|number| format!("x{number}")).collect();
    for name in &names {
        device = device.with(name, "DINT", "1");
    }
    let limits = DeviceLimits { max_requests_per_s: 50, ..DeviceLimits::of(Dialect::Micro800, true) };
    let mut owner = Owner::with_limits(device, limits);
    owner.run(5_000);
    owner.group(1, 1_000, &names.iter().map(String::as_str).collect::<Vec<_>>());
    owner.run(3_000);
    let gaps: Vec<u64> = owner.sent.windows(2).map(|pair| pair[1].0 - pair[0].0).collect();
    assert!(gaps.iter().all(|gap| *gap >= 20_000), "{gaps:?}");
    let load = owner.poller.load();
    assert!(load.is_limited && load.last_second <= 50, "{load:?}");
}

#[test]
fn a_group_that_is_off_is_not_read_and_says_so() {
    let mut owner = one();
    owner.group(1, 100, &["a"]);
    owner.run(50);
    while owner.poller.poll_change().is_some() {}
    let off = Group { id: 1, period: Millis(100), on: false, items: vec![item(10, "a")] };
    owner.poller.put_group(off, owner.now);
    assert_eq!(owner.poller.poll_change(), Some((1, 10)));
    assert_eq!(owner.reading(10).reason, Some(Reason::Off));
    owner.sent.clear();
    owner.run(1_000);
    assert!(owner.sent.is_empty());
    assert_eq!(owner.shown(10), (Quality::Stale, "1".to_owned()));
}

#[test]
fn another_version_of_a_group_keeps_what_is_known_and_reads_what_is_new_at_once() {
    let mut owner = Owner::new(Device::new(Dialect::Logix).with("a", "DINT", "1").with("b", "DINT", "2"));
    owner.group(1, 60_000, &["a"]);
    owner.run(50);
    owner.group(1, 60_000, &["a", "b"]);
    assert_eq!(owner.shown(10), (Quality::Good, "1".to_owned()));
    owner.run(50);
    owner.all_good(&[(10, "1"), (11, "2")]);
    owner.poller.remove_group(1, owner.now);
    assert_eq!(owner.poller.reading(10), None);
    assert_eq!(owner.poller.poll_timeout(), None);
}

#[test]
fn what_arrives_for_a_group_that_is_gone_is_for_nobody() {
    let mut owner = one();
    owner.group(1, 100, &["a"]);
    let request = owner.poller.poll_request(owner.now).unwrap();
    owner.group(1, 100, &["b"]);
    let reply = owner.device.answer(&request.bytes);
    owner.poller.handle_reply(Instant(2_000_000), Ok(&reply));
    assert_eq!(owner.reading(10).quality, Quality::Waiting);
    owner.poller.handle_reply(Instant(2_000_001), Ok(&reply));
}
