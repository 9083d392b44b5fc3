//! Sessions and frames.

use cipdeck_shared::engine::time::Millis;
use cipdeck_shared::sim::{Device, SimConfig, SimConnection, handle_datagram};
use cipdeck_shared::wire::{
    Command, CommonPacketFormat, Deframer, Encapsulation, EncapsulationStatus, ItemType, ListIdentityItem,
    ListServicesItem, Reader, RegisterSession, SenderContext,
};
use hex_literal::hex;

use super::frames::{MOVING, PRODUCT_NAME, at, frame, message_of, registered, rr, sent, status_of};

#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

#[test]
fn the_session_is_checked_as_the_specification_says() {
    let version_2 = hex!("02 00 00 00");
    let with_options = hex!("01 00 01 00");
    let ok = RegisterSession::CURRENT.bytes();
    let mut device = Device::default();
    let (mut connection, session) = registered(&mut device);
    let mut cut = rr(session, 1, &PRODUCT_NAME);
    cut.truncate(cut.len() - 1);
    cut[2] -= 1;
    let mut foreign_interface = rr(session, 1, &PRODUCT_NAME);
    foreign_interface[24] = 1;
    let without_item = hex!("00 00 00 00 00 00 01 00 00 00 00 00");
    let rows = [
        (
            "second RegisterSession",
            frame(Command::RegisterSession, 0, 1, &ok),
            EncapsulationStatus::InvalidCommand,
        ),
        ("unknown command", frame(Command(0x99), session, 1, &[]), EncapsulationStatus::InvalidCommand),
        ("foreign session", rr(session + 1, 1, &PRODUCT_NAME), EncapsulationStatus::InvalidSessionHandle),
        ("no session", rr(0, 1, &PRODUCT_NAME), EncapsulationStatus::InvalidSessionHandle),
        (
            "connected data of a foreign session",
            frame(Command::SendUnitData, 0, 1, &[]),
            EncapsulationStatus::InvalidSessionHandle,
        ),
        ("item longer than the frame", cut, EncapsulationStatus::InvalidLength),
        ("an interface that is not CIP", foreign_interface, EncapsulationStatus::IncorrectData),
        (
            "no message",
            frame(Command::SendRRData, session, 1, &without_item),
            EncapsulationStatus::IncorrectData,
        ),
    ];
    for (name, request, status) in rows {
        connection.handle_input(&mut device, &request, at(0));
        assert_eq!(status_of(&sent(&mut connection, at(0))).1, status, "{name}");
        assert!(!connection.is_closed(), "{name}");
    }
    for (name, data, status) in [
        ("version 2", &version_2[..], EncapsulationStatus::UnsupportedProtocolVersion),
        ("options", &with_options, EncapsulationStatus::UnsupportedProtocolVersion),
        ("cut", &version_2[..3], EncapsulationStatus::InvalidLength),
    ] {
        let mut fresh = SimConnection::new();
        fresh.handle_input(&mut device, &frame(Command::RegisterSession, 0, 1, data), at(0));
        assert_eq!(status_of(&sent(&mut fresh, at(0))).1, status, "{name}");
        fresh.handle_input(&mut device, &rr(0, 1, &PRODUCT_NAME), at(0));
        assert_eq!(
            status_of(&sent(&mut fresh, at(0))).1,
            EncapsulationStatus::InvalidSessionHandle,
            "a refused session is none: {name}"
        );
    }
}

#[test]
fn every_connection_has_its_own_session() {
    let mut device = Device::default();
    let (mut first, one) = registered(&mut device);
    let (mut second, two) = registered(&mut device);
    assert_ne!(one, two);
    second.handle_input(&mut device, &rr(one, 1, &PRODUCT_NAME), at(0));
    assert_eq!(
        status_of(&sent(&mut second, at(0))).1,
        EncapsulationStatus::InvalidSessionHandle,
        "a session of another connection"
    );
    first.handle_input(&mut device, &rr(one, 1, &PRODUCT_NAME), at(0));
    assert_eq!(message_of(&sent(&mut first, at(0)))[..4], hex!("8E 00 00 00"));
}

#[test]
fn unregister_closes_without_a_reply_and_nop_is_silent() {
    let mut device = Device::default();
    let (mut connection, session) = registered(&mut device);
    connection.handle_input(&mut device, &frame(Command::Nop, 0, 0, b"anything"), at(0));
    connection.handle_input(&mut device, &frame(Command::UnRegisterSession, session + 1, 0, &[]), at(0));
    assert!(!connection.is_closed(), "a foreign session");
    connection.handle_input(&mut device, &frame(Command::UnRegisterSession, session, 0, &[]), at(0));
    assert!(sent(&mut connection, at(0)).is_empty());
    assert!(connection.is_closed());
    connection.handle_input(&mut device, &rr(session, 1, &PRODUCT_NAME), at(0));
    assert!(sent(&mut connection, at(0)).is_empty(), "closed is closed");
}

#[test]
fn the_device_is_found_over_tcp_and_udp() {
    let mut device = Device::default();
    for command in [Command::ListIdentity, Command::ListServices, Command::ListInterfaces] {
        let request = frame(command, 0, 0x0102_0304, &[]);
        let mut connection = SimConnection::new();
        connection.handle_input(&mut device, &request, at(0));
        let tcp = sent(&mut connection, at(0));
        assert_eq!(handle_datagram(&device, &request).as_ref(), Some(&tcp), "{command:?}");
        let reply = Encapsulation::decode(&tcp).unwrap();
        assert_eq!(reply.header.context, SenderContext::from(0x0102_0304));
        let packet = CommonPacketFormat::read(&mut Reader::new(reply.data())).unwrap();
        match command {
            Command::ListIdentity => {
                let item = packet.find(ItemType::ListIdentity).unwrap();
                let identity = ListIdentityItem::decode(item.data).unwrap();
                assert_eq!(
                    (identity.name.text().as_str(), identity.address.port),
                    ("cipdeck demo drive", 44_818)
                );
            }
            Command::ListServices => {
                let item = packet.find(ItemType::ListServices).unwrap();
                assert_eq!(ListServicesItem::decode(item.data), Ok(ListServicesItem::EXPLICIT));
            }
            _ => assert_eq!(packet.count(), 0),
        }
    }
    for request in [
        frame(Command::Nop, 0, 0, &[]),
        frame(Command::RegisterSession, 0, 0, &RegisterSession::CURRENT.bytes()),
        b"hello".to_vec(),
        Vec::new(),
    ] {
        assert_eq!(handle_datagram(&device, &request), None, "no answer without a session");
    }
}

#[test]
fn frames_with_options_are_discarded() {
    let mut device = Device::default();
    let (mut connection, session) = registered(&mut device);
    for mut request in [frame(Command::ListIdentity, 0, 0, &[]), rr(session, 1, &PRODUCT_NAME)] {
        request[20] = 1;
        connection.handle_input(&mut device, &request, at(0));
        assert!(sent(&mut connection, at(0)).is_empty());
        assert_eq!(handle_datagram(&device, &request), None);
    }
    assert!(!connection.is_closed());
}

#[test]
fn pipelined_requests_are_answered_in_order_however_they_are_cut() {
    let conversation = |size: usize| {
        let mut device = Device::default();
        let (mut connection, session) = registered(&mut device);
        let mut input = rr(session, 1, &PRODUCT_NAME);
        input.extend(rr(session, 2, &MOVING));
        input.extend(frame(Command::ListIdentity, 0, 3, &[]));
        input.extend(rr(session, 4, &hex!("0E 03 20 EE 24 01 30 01")));
        input.extend(frame(Command::UnRegisterSession, session, 0, &[]));
        let mut out = Vec::new();
        for part in input.chunks(size) {
            connection.handle_input(&mut device, part, at(40));
            connection.poll_transmit(&mut out, at(40));
        }
        assert!(connection.is_closed());
        out
    };
    let whole = conversation(4_096);
    let mut deframer = Deframer::new();
    deframer.push(&whole);
    for context in 1..=4 {
        let frame = deframer.next_frame().unwrap().unwrap();
        assert_eq!(frame.header.context, SenderContext::from(context));
    }
    assert!(deframer.next_frame().unwrap().is_none());
    for size in [1, 2, 3, 23, 24, 25, 40, 41, 100] {
        assert_eq!(conversation(size), whole, "segments of {size} bytes");
    }
}

#[test]
fn a_slow_device_works_on_one_request_after_the_other() {
    let mut device = Device::new(SimConfig { delay: Millis(100), ..SimConfig::default() });
    let (mut connection, session) = registered(&mut device);
    assert_eq!(connection.poll_timeout(), None);
    let both = [rr(session, 1, &PRODUCT_NAME), rr(session, 2, &PRODUCT_NAME)].concat();
    connection.handle_input(&mut device, &both, at(10));
    assert_eq!(connection.poll_timeout(), Some(at(110)));
    assert!(sent(&mut connection, at(109)).is_empty());
    let context = |bytes: &[u8]| Encapsulation::decode(bytes).unwrap().header.context;
    assert_eq!(context(&sent(&mut connection, at(110))), SenderContext::from(1));
    assert_eq!(connection.poll_timeout(), Some(at(210)));
    assert_eq!(context(&sent(&mut connection, at(210))), SenderContext::from(2));
}

#[test]
fn a_frame_that_cannot_be_closes_the_connection() {
    let mut device = Device::default();
    let mut connection = SimConnection::new();
    connection.handle_input(&mut device, &[0xFF; 4], at(0));
    assert!(connection.is_closed());
}

#[test]
fn replies_that_nobody_fetches_do_not_pile_up_for_ever() {
    let mut device = Device::default();
    let mut connection = SimConnection::new();
    let request = frame(Command::ListIdentity, 0, 0, &[]);
    for _ in 0..10_000 {
        connection.handle_input(&mut device, &request, at(0));
    }
    let out = sent(&mut connection, at(0));
    assert!((256 * 1024..257 * 1024).contains(&out.len()), "{} bytes", out.len());
    assert!(connection.is_closed());
}

#[test]
fn a_long_conversation_goes_on() {
    let mut device = Device::default();
    let (mut connection, session) = registered(&mut device);
    for round in 0..10_000 {
        connection.handle_input(&mut device, &rr(session, round, &PRODUCT_NAME), at(round));
        assert!(!sent(&mut connection, at(round)).is_empty(), "round {round}");
    }
    assert!(!connection.is_closed());
}
