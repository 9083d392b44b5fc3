//! What a device shows is used from then on.

use cipdeck_shared::engine::poll::DeviceLimits;
use cipdeck_shared::tag::Dialect;

use crate::device::Device;
use crate::owner::Owner;
#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

#[test]
fn a_device_without_packets_is_asked_one_by_one_from_then_on() {
    let device = Device::new(Dialect::Logix).with("a", "DINT", "1").with("b", "DINT", "2");
    let mut owner = Owner::new(Device { packs: false, ..device });
    owner.group(1, 100, &["a", "b"]);
    owner.run(50);
    owner.all_good(&[(10, "1"), (11, "2")]);
    assert_eq!(owner.requests().len(), 3, "one in vain");
    owner.run(100);
    assert_eq!(owner.requests().len(), 2);
}

#[test]
fn replies_that_are_longer_than_the_device_can_send_are_cut_and_remembered() {
    for cuts_parts in [false, true] {
        let text = "t".repeat(60);
        let names: Vec<String> = (0..40).map(|number| format!("x{number}")).collect();
        let mut device = Device { cuts_parts, ..Device::new(Dialect::Omron) };
        for name in &names {
            device = device.with(name, "STRING[80]", &format!("\"{text}\""));
        }
        let mut owner = Owner::new(device);
        owner.group(1, 100, &names.iter().map(String::as_str).collect::<Vec<_>>());
        owner.run(90);
        for item in 10..50 {
            owner.all_good(&[(item, &format!("\"{text}\""))]);
        }
        assert!(owner.requests().len() < 20);
        owner.run(100);
        // 70 bytes for each with its offset: 7 fit into 502
        assert_eq!(owner.requests().len(), 6);
    }
}

#[test]
fn a_device_that_takes_less_than_its_family_is_soon_asked_for_less() {
    let names: Vec<String> = (0..60).map(|number| format!("x{number}")).collect();
    for (request_max, reply_max) in [(504, 100), (100, 504), (90, 90)] {
        let mut device = Device { request_max, reply_max, cuts_parts: false, ..Device::new(Dialect::Logix) };
        for name in &names {
            device = device.with(name, "DINT", "9");
        }
        let mut owner = Owner::with_limits(device, DeviceLimits::of(Dialect::Logix, false));
        owner.group(1, 100, &names.iter().map(String::as_str).collect::<Vec<_>>());
        owner.run(2_000);
        for item in 10..70 {
            owner.all_good(&[(item, "9")]);
        }
        owner.requests();
        owner.run(100);
        let requests = owner.requests();
        let sum: usize = requests.iter().map(Vec::len).sum();
        assert_eq!(sum, 60, "nothing in vain: {requests:?}");
        assert!(requests.len() <= 20, "{request_max} {reply_max}: {}", requests.len());
    }
}
