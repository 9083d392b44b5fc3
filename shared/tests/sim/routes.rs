//! Routes through the chassis, hop by hop.

use cipdeck_shared::engine::time::Millis;
use cipdeck_shared::sim::{Device, SimConfig};
use cipdeck_shared::wire::{Epath, MessageRouterReply, PortSegment, RequestTimeout, UnconnectedSend};
use hex_literal::hex;

use super::frames::{PRODUCT_NAME, ask, at, message_of, refusal, registered, rr, sent};

#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

/// `1,3` or `2,192.168.1.20`, with 250 ms for it.
fn routed(route: &[(u16, &str)], message: &[u8]) -> Vec<u8> {
    let route = route.iter().fold(Epath::default(), |path, (port, address)| {
        path.hop(match address.parse() {
            Ok(slot) => PortSegment::new(*port, slot).unwrap(),
            Err(_) => PortSegment::with_address(*port, address.as_bytes()).unwrap(),
        })
    });
    UnconnectedSend { timeout: RequestTimeout::at_least(250), message, route }.request().unwrap().bytes()
}

#[test]
fn every_module_answers_with_its_own_identity() {
    let mut device = Device::default();
    for (route, name) in [
        (&[(1, "0")][..], "cipdeck demo drive"),
        (&[(1, "1")], "cipdeck demo I/O"),
        (&[(1, "3")], "cipdeck demo bridge"),
        (&[(2, "192.168.1.10")], "cipdeck demo bridge"),
        (&[(2, "192.168.1.20")], "cipdeck demo remote"),
        (&[(1, "3"), (2, "192.168.1.20")], "cipdeck demo remote"),
        (&[(2, "192.168.1.10"), (1, "1")], "cipdeck demo I/O"),
        (&[(1, "0"), (1, "3"), (1, "1")], "cipdeck demo I/O"),
    ] {
        let bytes = device.answer(&routed(route, &PRODUCT_NAME), at(0));
        let reply = MessageRouterReply::decode(&bytes).unwrap();
        assert_eq!((bytes[0], reply.status.0), (0x8E, 0), "the inner service's own reply: {route:?}");
        assert_eq!(&reply.data[1..], name.as_bytes(), "{route:?}");
    }
}

#[test]
fn every_module_has_values_of_its_own() {
    let mut device = Device::default();
    let write = hex!("10 03 20 93 24 29 30 09 2A 00");
    let read = hex!("0E 03 20 93 24 29 30 09");
    assert_eq!(ask_routed(&mut device, &routed(&[(1, "1")], &write)), (0x90, 0, Vec::new()));
    assert_eq!(ask_routed(&mut device, &routed(&[(1, "1")], &read)), (0x8E, 0, hex!("2A 00").to_vec()));
    assert_eq!(ask(&mut device, &read, at(0)), (0, hex!("E8 03").to_vec()));
    let over_the_bridge = routed(&[(1, "3"), (2, "192.168.1.20")], &write);
    assert_eq!(ask_routed(&mut device, &over_the_bridge).1, 0);
    let directly = routed(&[(2, "192.168.1.20")], &read);
    assert_eq!(ask_routed(&mut device, &directly), (0x8E, 0, hex!("2A 00").to_vec()), "the same device");
    let tcp_ip = hex!("0E 03 20 F5 24 01 30 05");
    let (_, status, data) = ask_routed(&mut device, &routed(&[(2, "192.168.1.20")], &tcp_ip));
    assert_eq!((status, &data[..4]), (0, &hex!("14 01 A8 C0")[..]));
    assert_eq!(ask_routed(&mut device, &routed(&[(1, "1")], &tcp_ip)).1, 0x05, "no Ethernet port");
}

fn ask_routed(device: &mut Device, request: &[u8]) -> (u8, u8, Vec<u8>) {
    let bytes = device.answer(request, at(0));
    let reply = MessageRouterReply::decode(&bytes).unwrap();
    (bytes[0], reply.status.0, reply.data.to_vec())
}

#[test]
fn the_refusal_of_the_target_is_not_that_of_a_router() {
    let bytes = Device::default().answer(&routed(&[(1, "1")], &hex!("0E 03 20 EE 24 01 30 01")), at(0));
    assert_eq!(bytes, hex!("8E 00 05 00"));
}

#[test]
fn a_router_that_cannot_hand_on_says_why_and_how_much_of_the_route_was_left() {
    for (name, request, reply) in [
        ("absent slot", routed(&[(1, "9")], &PRODUCT_NAME), &hex!("D2 00 01 01 12 03 01 00")),
        ("absent port", routed(&[(7, "0")], &PRODUCT_NAME), &hex!("D2 00 01 01 11 03 01 00")),
        ("absent extended port", routed(&[(300, "0")], &PRODUCT_NAME), &hex!("D2 00 01 01 11 03 02 00")),
        (
            "no backplane there",
            routed(&[(2, "192.168.1.20"), (1, "0")], &PRODUCT_NAME),
            &hex!("D2 00 01 01 11 03 01 00"),
        ),
        (
            "no Ethernet there",
            routed(&[(1, "1"), (2, "192.168.1.20")], &PRODUCT_NAME),
            &hex!("D2 00 01 01 11 03 07 00"),
        ),
        (
            "slot behind the bridge",
            routed(&[(2, "192.168.1.10"), (1, "9")], &PRODUCT_NAME),
            &hex!("D2 00 01 01 12 03 01 00"),
        ),
        ("second hop left", routed(&[(1, "9"), (1, "0")], &PRODUCT_NAME), &hex!("D2 00 01 01 12 03 02 00")),
        (
            "a node number on the Ethernet",
            routed(&[(2, "5")], &PRODUCT_NAME),
            &hex!("D2 00 01 01 12 03 01 00"),
        ),
        ("no address", routed(&[(2, "no.such.name")], &PRODUCT_NAME), &hex!("D2 00 01 01 12 03 07 00")),
        ("a slot as text", routed(&[(1, "1.2.3.4")], &PRODUCT_NAME), &hex!("D2 00 01 01 12 03 05 00")),
        ("its own address", routed(&[(2, "127.0.0.1")], &PRODUCT_NAME), &hex!("D2 00 01 01 18 03 06 00")),
        ("no route", routed(&[], &PRODUCT_NAME), &hex!("D2 00 01 01 15 03 00 00")),
    ] {
        assert_eq!(Device::default().answer(&request, at(0)), reply, "{name}");
    }
}

#[test]
fn a_malformed_routed_request_is_refused_by_what_is_wrong_with_it() {
    let send = |data: &[u8]| [&hex!("52 02 20 06 24 01")[..], data].concat();
    for (name, data, reply) in [
        ("port 0", &hex!("00 FA 02 00 01 00 01 00 00 00")[..], &hex!("D2 00 01 01 15 03 01 00")[..]),
        ("a logical segment", &hex!("00 FA 02 00 01 00 02 00 01 01 20 01"), &hex!("D2 00 01 01 15 03 01 00")),
        ("an unknown segment", &hex!("00 FA 02 00 01 00 01 00 E0 00"), &hex!("D2 00 01 01 15 03 01 00")),
        ("an address that is cut", &hex!("00 FA 02 00 01 00 01 00 12 0C"), &hex!("D2 00 01 01 15 03 01 00")),
        (
            "absent slot before an unknown segment",
            &hex!("00 FA 02 00 01 00 02 00 01 09 E0 00"),
            &hex!("D2 00 01 01 12 03 02 00"),
        ),
        ("nothing", &[], &hex!("D2 00 13 00")),
        ("message cut", &hex!("00 FA 09 00 01 00 01 00 01 00"), &hex!("D2 00 13 00")),
        ("no pad after an odd message", &hex!("00 FA 03 00 01 00 00 01 00 01 00"), &hex!("D2 00 15 00")),
        ("route cut", &hex!("00 FA 02 00 01 00 02 00 01 00"), &hex!("D2 00 13 00")),
        ("more after the route", &hex!("00 FA 02 00 01 00 01 00 01 00 01 00"), &hex!("D2 00 15 00")),
        ("no message", &hex!("00 FA 00 00 01 00 01 00"), &hex!("D2 00 20 00")),
    ] {
        assert_eq!(Device::default().answer(&send(data), at(0)), reply, "{name}");
    }
}

#[test]
fn where_nobody_answers_the_router_says_so_after_its_time_and_holds_up_nobody() {
    let mut device = Device::new(SimConfig { delay: Millis(10), ..SimConfig::default() });
    let (mut connection, session) = registered(&mut device);
    let nobody = routed(&[(1, "3"), (2, "192.168.1.99")], &PRODUCT_NAME);
    let both = [rr(session, 1, &nobody), rr(session, 2, &PRODUCT_NAME)].concat();
    connection.handle_input(&mut device, &both, at(0));
    assert_eq!(connection.poll_timeout(), Some(at(20)));
    assert_eq!(message_of(&sent(&mut connection, at(20)))[..4], hex!("8E 00 00 00"), "overtakes");
    assert_eq!(connection.poll_timeout(), Some(at(260)));
    assert!(sent(&mut connection, at(259)).is_empty());
    assert_eq!(message_of(&sent(&mut connection, at(260))), hex!("D2 00 01 01 04 02 07 00"));
    assert_eq!(connection.poll_timeout(), None);
}

#[test]
fn what_a_router_still_waits_for_does_not_keep_a_closed_connection() {
    let mut device = Device::default();
    let (mut connection, session) = registered(&mut device);
    let nobody = routed(&[(2, "192.168.1.99")], &PRODUCT_NAME);
    connection.handle_input(&mut device, &rr(session, 1, &nobody), at(0));
    let mut unregister = hex!("66 00 00 00 01 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00");
    unregister[4..8].copy_from_slice(&session.to_le_bytes());
    connection.handle_input(&mut device, &unregister, at(1));
    assert!(connection.is_closed());
}

#[test]
fn a_routed_message_in_a_routed_message_is_handed_on_up_to_a_depth() {
    let mut device = Device::default();
    let wrap = |times: usize| (0..times).fold(PRODUCT_NAME.to_vec(), |inner, _| routed(&[(1, "0")], &inner));
    assert_eq!(device.answer(&wrap(8), at(0))[..4], hex!("8E 00 00 00"));
    for times in [9, 3_000] {
        assert_eq!(refusal(&mut device, &wrap(times), at(0)), (1, vec![0x0301], vec![0, 0]), "{times}");
    }
}

#[test]
fn a_route_of_255_hops_ends_where_it_leads() {
    let hops: Vec<_> = (0..255).map(|hop| (1, if hop % 2 == 0 { "3" } else { "1" })).collect();
    let bytes = Device::default().answer(&routed(&hops, &PRODUCT_NAME), at(0));
    assert!(bytes.ends_with(b"cipdeck demo bridge"), "{bytes:02X?}");
}
