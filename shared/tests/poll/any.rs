//! Whatever a device refuses or cuts.

use std::collections::BTreeMap;

use cipdeck_shared::engine::poll::{DeviceLimits, Quality};
use cipdeck_shared::tag::Dialect;
use proptest::prelude::*;

use crate::device::Device;
use crate::owner::Owner;

/// Name, type, value.
const TAGS: [(&str, &str, &str); 9] = [
    ("a", "DINT", "-7"),
    ("b", "REAL", "0.5"),
    ("w", "WORD", "33"),
    ("t", "STRING[80]", "\"some text that takes a little room\""),
    ("arr", "INT[12]", "[0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11]"),
    ("big", "DINT[40]", BIG),
    ("st", "STRUCT{x: INT; y: DINT; z: REAL}", "{x: 1, y: 2, z: 3.5}"),
    ("flag", "BOOL", "TRUE"),
    ("long", "LINT", "-99"),
];

const BIG: &str = "[0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20, 21, 22, 23, 24, 25, 26, 27, 28, 29, 30, 31, 32, 33, 34, 35, 36, 37, 38, 39]";

/// What is asked for, and what has to be there.
const ITEMS: [(&str, &str, &str); 18] = [
    ("a", "DINT", "-7"),
    ("b", "REAL", "0.5"),
    ("w", "WORD", "33"),
    ("w.5", "BOOL", "TRUE"),
    ("w.4", "BOOL", "FALSE"),
    ("t", "STRING[80]", "\"some text that takes a little room\""),
    ("arr", "INT[12]", "[0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11]"),
    ("arr[3]", "INT", "3"),
    ("arr[4]", "INT", "4"),
    ("arr[11]", "INT", "11"),
    ("big", "DINT[40]", BIG),
    ("big[39]", "DINT", "39"),
    ("st", "STRUCT{x: INT; y: DINT; z: REAL}", "{x: 1, y: 2, z: 3.5}"),
    ("st.y", "DINT", "2"),
    ("st.z", "REAL", "3.5"),
    ("flag", "BOOL", "TRUE"),
    ("long", "LINT", "-99"),
    ("missing", "INT", ""),
];

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]
    #[test]
    fn every_item_ends_good_with_its_value_or_bad_with_the_devices_reason(
        family in 0..3_usize,
        chosen in prop::collection::vec((0..ITEMS.len(), any::<bool>()), 1..60),
        refused in prop::collection::btree_map(0..ITEMS.len(), prop_oneof![Just(0x04_u8), Just(0x05), Just(0x1F), Just(0x20), Just(0xFF)], 0..3),
        packs in any::<bool>(),
        cuts_parts in any::<bool>(),
        fragments in any::<bool>(),
        request_max in 60..504_usize,
        reply_max in 64..504_usize,
    ) {
        let dialect = Dialect::ALL[family];
        let mut device = Device { packs, fragments, request_max, reply_max, cuts_parts, ..Device::new(dialect) };
        for (name, kind, value) in TAGS {
            device = device.with(name, kind, value);
        }
        let refused: BTreeMap<&str, u8> =
            refused.into_iter().map(|(item, status)| (ITEMS[item].0, status)).filter(|(name, _)| !name.contains('.')).collect();
        for (name, status) in &refused {
            device.refuses.insert((*name).to_owned(), (*status, Some(0x2107)));
        }
        let names: Vec<String> = chosen.iter().map(|(item, typed)| {
            let (name, kind, _) = ITEMS[*item];
            // Nobody can tell an array or a structure from its bytes alone.
            let typed = *typed || kind.contains(['[', '{']);
            if typed { format!("{name} : {kind}") } else { name.to_owned() }
        }).collect();
        let mut owner = Owner::with_limits(device, DeviceLimits::of(dialect, false));
        owner.group(1, 1_000, &names.iter().map(String::as_str).collect::<Vec<_>>());
        owner.run(4_000);
        let mut most = 0;
        for _ in 0..3 {
            owner.requests();
            owner.run(1_000);
            most = most.max(owner.requests().len());
        }
        for (place, (item, _)) in chosen.iter().enumerate() {
            let id = 10 + u32::try_from(place).unwrap();
            let (name, _, value) = ITEMS[*item];
            let reading = owner.reading(id);
            let whole = name.split(['.', '[']).next().unwrap();
            // A member of something that is refused can be there: by itself, or in a whole that is read.
            let is_open = name != whole && (refused.contains_key(name) || refused.contains_key(whole));
            let is_bad = refused.contains_key(name) || name == "missing" || (name.contains('.') && refused.contains_key(whole) && name.starts_with('w'));
            let (quality, text) = owner.shown(id);
            if is_open {
                prop_assert!(quality == Quality::Bad || text == value, "{name}: {reading:?}");
            } else if is_bad {
                prop_assert_eq!(quality, Quality::Bad, "{}: {:?}", name, reading);
            } else {
                // There is no way to read what is long.
                let wayless = dialect == Dialect::Micro800 || (dialect == Dialect::Logix && !fragments);
                let unreadable = wayless && quality == Quality::Bad && value.len() > 20;
                prop_assert!(unreadable || (quality == Quality::Good && text == value), "{name}: {reading:?}");
            }
        }
        prop_assert!(most <= 4 * names.len() + 12, "{most} requests for {} items", names.len());
    }

    #[test]
    fn whatever_is_answered_nothing_breaks(
        replies in prop::collection::vec(prop::collection::vec(any::<u8>(), 0..40), 1..40),
        family in 0..3_usize,
    ) {
        let device = Device::new(Dialect::ALL[family]);
        let mut owner = Owner::new(device);
        owner.group(1, 10, &["a", "b : DINT[500]", "c[1] : INT", "c[2] : INT", "d : STRUCT{x: INT}", "d.x"]);
        for reply in replies {
            let Some(request) = owner.poller.poll_request(owner.now) else {
                owner.now = owner.poller.poll_timeout().unwrap().max(owner.now);
                continue;
            };
            // The right service, so that something is looked at.
            let mut reply = reply;
            if let Some(first) = reply.first_mut() {
                *first = request.bytes[0] | 0x80;
            }
            owner.now.0 += 100;
            owner.poller.handle_reply(owner.now, Ok(&reply));
        }
    }
}
