//! Forward_Open, Large_Forward_Open, Forward_Close, and what the Connection Manager counts.

use cipdeck_shared::engine::time::Instant;
use cipdeck_shared::sim::{Counters, Device, SimConfig};
use cipdeck_shared::wire::{ForwardOpenReply, MessageRouterReply};
use hex_literal::hex;

use super::frames::{PRODUCT_NAME, ask, at};

#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

/// Connection 1 of an originator: T->O id 0x11223344, 504 bytes, 2 s x 32. Built from the layout of OpENer and pycomm3.
pub(crate) const OPEN: [u8; 46] = hex!(
    "54 02 20 06 24 01 0A 0E 00000000 44332211 0100 3713 EFBEADDE 03 000000 80841E00 F843 80841E00 F843 A3"
    "02 20 02 24 01"
);
pub(crate) const CLOSE: [u8; 22] = hex!("4E 02 20 06 24 01 0A 0E 0100 3713 EFBEADDE 02 00 20 02 24 01");

/// The same with 4000 bytes.
pub(crate) const LARGE_OPEN: [u8; 50] = hex!(
    "5B 02 20 06 24 01 0A 0E 00000000 44332211 0100 3713 EFBEADDE 03 000000 80841E00 A00F0042 80841E00 A00F0042 A3"
    "02 20 02 24 01"
);

/// A request with some bytes changed.
pub(crate) fn with(request: &[u8], changes: &[(usize, &[u8])]) -> Vec<u8> {
    let mut request = request.to_vec();
    for (at, bytes) in changes {
        request[*at..at + bytes.len()].copy_from_slice(bytes);
    }
    request
}

/// A request with another path.
pub(crate) fn along(request: &[u8], path: &[u8]) -> Vec<u8> {
    let pad = usize::from(request[0] == 0x4E);
    let mut request = request[..request.len() - 4].to_vec();
    let size = request.len() - 1 - pad;
    request[size] = u8::try_from(path.len() / 2).unwrap();
    request.extend_from_slice(path);
    request
}

/// Opens a connection; its O->T id.
pub(crate) fn opened(device: &mut Device, request: &[u8], now: Instant) -> u32 {
    let bytes = device.answer(request, now);
    let reply = MessageRouterReply::decode(&bytes).unwrap();
    assert_eq!(reply.status.0, 0, "{bytes:02X?}");
    ForwardOpenReply::decode(reply.data).unwrap().o_t_id.0
}

/// The triad of [`OPEN`], as a refusal repeats it.
const TRIAD: [u8; 8] = hex!("0100 3713 EFBEADDE");

/// Attributes 1 to 8 of the Connection Manager behind a route.
fn counts(device: &mut Device) -> Vec<u16> {
    let (status, all) = ask(device, &hex!("01 02 20 06 24 01"), at(0));
    assert_eq!((status, all.len()), (0, 16));
    all.chunks(2).map(|count| u16::from_le_bytes([count[0], count[1]])).collect()
}

#[test]
fn an_opened_connection_says_its_ids_and_intervals() {
    let mut device = Device::default();
    let reply = device.answer(&OPEN, at(0));
    assert_eq!(reply[..4], hex!("D4 00 00 00"));
    assert_ne!(reply[4..8], [0; 4], "the device picks an id");
    assert_eq!(reply[8..], hex!("44332211 0100 3713 EFBEADDE 80841E00 80841E00 00 00"));
    assert_eq!(device.answer(&CLOSE, at(0)), hex!("CE 00 00 00 0100 3713 EFBEADDE 00 00"));
    let reply = device.answer(&LARGE_OPEN, at(0));
    assert_eq!((&reply[..4], reply.len()), (&hex!("DB 00 00 00")[..], 30));
    assert_eq!(
        device.counters(),
        Counters { opened: 2, closed: 1, ..Counters::default() },
        "opening and closing are not counted as requests"
    );
}

#[test]
fn ids_differ_while_connections_are_open() {
    let mut device = Device::default();
    let mut ids: Vec<_> =
        (0..32).map(|serial| opened(&mut device, &with(&OPEN, &[(16, &[serial])]), at(0))).collect();
    ids.sort_unstable();
    ids.dedup();
    assert_eq!((ids.len(), ids.contains(&0)), (32, false));
}

#[test]
fn what_cannot_be_opened_is_refused_with_the_reason_and_the_name_of_the_connection() {
    let refused = |words: &[u8], remaining: u8| {
        let size = u8::try_from(words.len() / 2).unwrap();
        [&[0xD4, 0, 1, size], words, &TRIAD, &[remaining, 0]].concat()
    };
    let long = hex!("01 03 12 0C 31 39 32 2E 31 36 38 2E 31 2E 32 31 20 02 24 01"); // 1,3,2,192.168.1.21
    for (name, request, reply) in [
        ("class 1", with(&OPEN, &[(40, &[0xA1])]), refused(&hex!("03 01"), 0)),
        ("client", with(&OPEN, &[(40, &[0x23])]), refused(&hex!("03 01"), 0)),
        ("reserved trigger", with(&OPEN, &[(40, &[0xB3])]), refused(&hex!("03 01"), 0)),
        ("another object", along(&OPEN, &hex!("20 04 24 64")), refused(&hex!("17 01"), 2)),
        ("no object", along(&OPEN, &[]), refused(&hex!("17 01"), 0)),
        ("unknown segment", along(&OPEN, &hex!("E0 00")), refused(&hex!("15 03"), 1)),
        ("unknown segment after a hop", along(&OPEN, &hex!("01 01 E0 00 20 02")), refused(&hex!("15 03"), 2)),
        ("absent slot", along(&OPEN, &hex!("01 09 20 02 24 01")), refused(&hex!("12 03"), 3)),
        ("absent port", along(&OPEN, &hex!("05 00 20 02 24 01")), refused(&hex!("11 03"), 3)),
        ("nobody behind the bridge", along(&OPEN, &long), refused(&hex!("04 02"), 9)),
        ("null", with(&OPEN, &[(33, &[0x03]), (39, &[0x03])]), refused(&hex!("32 01"), 0)),
        ("O->T null", with(&OPEN, &[(33, &[0x03])]), refused(&hex!("23 01"), 0)),
        ("O->T multicast", with(&OPEN, &[(33, &[0x23])]), refused(&hex!("23 01"), 0)),
        ("T->O multicast", with(&OPEN, &[(39, &[0x23])]), refused(&hex!("24 01"), 0)),
        ("redundant owner", with(&OPEN, &[(33, &[0xC3])]), refused(&hex!("25 01"), 0)),
        ("multiplier 8", with(&OPEN, &[(24, &[8])]), refused(&hex!("33 01"), 0)),
        ("no interval", with(&OPEN, &[(28, &[0; 4])]), refused(&hex!("11 01"), 0)),
        ("no room for a reply", with(&OPEN, &[(38, &[5, 0x42])]), refused(&hex!("09 01 FF 01"), 0)),
        ("cut", OPEN[..45].to_vec(), hex!("D4 00 13 00").to_vec()),
        ("one word too many", [&OPEN[..], &[0, 0]].concat(), hex!("D4 00 15 00").to_vec()),
    ] {
        let mut device = Device::default();
        assert_eq!(device.answer(&request, at(0)), reply, "{name}");
        assert_eq!(device.counters().opened, 0, "{name}");
    }
    let any_rpi_and_trigger = with(&OPEN, &[(28, &[1, 0, 0, 0]), (40, &[0x83])]);
    assert_eq!(Device::default().answer(&any_rpi_and_trigger, at(0))[..4], hex!("D4 00 00 00"));
}

#[test]
fn a_connection_that_is_open_already_is_not_opened_again() {
    let mut device = Device::default();
    opened(&mut device, &OPEN, at(0));
    assert_eq!(device.answer(&OPEN, at(0)), hex!("D4 00 01 01 00 01 0100 3713 EFBEADDE 00 00"));
    opened(&mut device, &with(&OPEN, &[(16, &[2])]), at(0));
    device.answer(&CLOSE, at(0));
    opened(&mut device, &OPEN, at(0));
}

#[test]
fn sizes_and_the_number_of_connections_are_limited() {
    let config = SimConfig { max_connections: 2, max_size: 500, ..SimConfig::default() };
    let mut device = Device::new(config);
    assert_eq!(device.answer(&OPEN, at(0)), hex!("D4 00 01 02 09 01 F4 01 0100 3713 EFBEADDE 00 00"));
    assert_eq!(device.answer(&LARGE_OPEN, at(0)), hex!("DB 00 01 02 09 01 F4 01 0100 3713 EFBEADDE 00 00"));
    let open = with(&OPEN, &[(32, &hex!("F4 43")), (38, &hex!("F4 43"))]);
    for serial in 1..=2 {
        opened(&mut device, &with(&open, &[(16, &[serial])]), at(0));
    }
    let third = with(&open, &[(16, &[3])]);
    assert_eq!(device.answer(&third, at(0)), hex!("D4 00 01 01 13 01 0300 3713 EFBEADDE 00 00"));
    device.answer(&CLOSE, at(0));
    opened(&mut device, &third, at(0));
}

#[test]
fn a_device_without_large_forward_open_says_that_it_does_not_know_the_service() {
    let mut device = Device::new(SimConfig { large: false, ..SimConfig::default() });
    assert_eq!(device.answer(&LARGE_OPEN, at(0)), hex!("DB 00 08 00"));
    opened(&mut device, &OPEN, at(0));
}

#[test]
fn what_cannot_be_closed_is_refused() {
    let mut device = Device::default();
    assert_eq!(
        device.answer(&CLOSE, at(0)),
        hex!("CE 00 01 01 07 01 0100 3713 EFBEADDE 00 00"),
        "nothing is open"
    );
    opened(&mut device, &OPEN, at(0));
    let elsewhere = along(&CLOSE, &hex!("01 01 20 02 24 01"));
    assert_eq!(device.answer(&elsewhere, at(0)), hex!("CE 00 01 01 16 03 0100 3713 EFBEADDE 00 00"));
    let nowhere = along(&CLOSE, &hex!("01 09 20 02 24 01"));
    assert_eq!(device.answer(&nowhere, at(0)), hex!("CE 00 01 01 12 03 0100 3713 EFBEADDE 03 00"));
    assert_eq!(device.answer(&CLOSE[..21], at(0)), hex!("CE 00 13 00"));
    assert_eq!(device.answer(&[&CLOSE[..], &[0]].concat(), at(0)), hex!("CE 00 15 00"));
    assert_eq!(device.counters().closed, 0);
    device.answer(&CLOSE, at(0));
    assert_eq!(device.counters().closed, 1);
}

#[test]
fn the_connection_manager_counts_what_it_was_asked() {
    let mut device = Device::new(SimConfig { max_connections: 1, ..SimConfig::default() });
    opened(&mut device, &OPEN, at(0));
    device.answer(&OPEN[..40], at(0)); // format
    device.answer(&along(&OPEN, &hex!("01 09 20 02 24 01")), at(0)); // format: the path
    device.answer(&with(&OPEN, &[(16, &[2])]), at(0)); // resource
    device.answer(&OPEN, at(0)); // duplicate
    device.answer(&CLOSE[..20], at(0)); // format
    device.answer(&with(&CLOSE, &[(8, &[9])]), at(0)); // not found
    assert_eq!(counts(&mut device), [5, 2, 1, 1, 2, 1, 1, 0]);
    device.handle_timeout(at(64_000));
    assert_eq!(counts(&mut device), [5, 2, 1, 1, 2, 1, 1, 1]);
    assert_eq!(ask(&mut device, &hex!("0E 03 20 06 24 01 30 08"), at(0)), (0, vec![1, 0]));
    assert_eq!(ask(&mut device, &hex!("0E 03 20 06 24 01 30 09"), at(0)).0, 0x14);
    let list = ask(&mut device, &hex!("03 02 20 06 24 01 02 00 01 00 05 00"), at(0));
    assert_eq!(list, (0, hex!("02 00 01 00 00 00 05 00 05 00 00 00 02 00").to_vec()));
}

#[test]
fn a_connection_is_opened_directly_not_inside_of_a_routed_message() {
    let mut device = Device::default();
    let routed = [&hex!("52 02 20 06 24 01 00 FA 2E 00")[..], &OPEN, &hex!("01 00 01 01")].concat();
    assert_eq!(device.answer(&routed, at(0)), hex!("D4 00 08 00"));
    assert_eq!(device.answer(&PRODUCT_NAME, at(0))[..4], hex!("8E 00 00 00"));
}
