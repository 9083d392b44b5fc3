//! The simulated device, seen from the wire.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::indexing_slicing, reason = "a test may fail")]

use cipdeck_shared::engine::time::{Instant, Millis};
use cipdeck_shared::sim::{Device, Fault, SimConfig, SimConnection, handle_datagram};
use cipdeck_shared::wire::{
    Command, CommonPacketFormat, Deframer, Encapsulation, EncapsulationStatus, GeneralStatus, Header,
    ItemType, ListIdentityItem, ListServicesItem, MessageRouterReply, Reader, RegisterSession, SendRrData,
    SenderContext, ServiceCode, SessionHandle, UnconnectedMessage,
};
use hex_literal::hex;

#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

const PRODUCT_NAME: [u8; 8] = hex!("0E 03 20 01 24 01 30 07");
const MOVING: [u8; 8] = hex!("0E 03 20 04 24 64 30 03");

fn at(millis: u64) -> Instant {
    Instant(millis * 1_000)
}

/// Status and data of the answer to a message router request.
fn ask(device: &mut Device, request: &[u8], now: Instant) -> (u8, Vec<u8>) {
    let bytes = device.answer(request, now);
    let reply = MessageRouterReply::decode(&bytes).unwrap();
    assert_eq!(reply.service.0, request.first().map_or(0, |service| service & 0x7F));
    (reply.status.0, reply.data.to_vec())
}

/// Everything a connection hands out by `now`.
fn sent(connection: &mut SimConnection, now: Instant) -> Vec<u8> {
    let mut out = Vec::new();
    connection.poll_transmit(&mut out, now);
    out
}

fn frame(command: Command, session: u32, context: u64, data: &[u8]) -> Vec<u8> {
    let header = Header::request(command, SessionHandle(session), SenderContext::from(context));
    let mut out = Vec::new();
    Encapsulation::new(header, data).unwrap().encode(&mut out);
    out
}

fn rr(session: u32, context: u64, request: &[u8]) -> Vec<u8> {
    let header = Header::request(Command::SendRRData, SessionHandle(session), SenderContext::from(context));
    let mut out = Vec::new();
    UnconnectedMessage::new(request).unwrap().encode(&header, 3, &mut out);
    out
}

fn status_of(bytes: &[u8]) -> (Command, EncapsulationStatus) {
    let header = Encapsulation::decode(bytes).unwrap().header;
    (header.command, header.status)
}

fn message_of(bytes: &[u8]) -> Vec<u8> {
    let frame = Encapsulation::decode(bytes).unwrap();
    SendRrData::decode(frame.data()).unwrap().unconnected().unwrap().data.to_vec()
}

/// A connection with a session; its handle.
fn registered(device: &mut Device) -> (SimConnection, u32) {
    let mut connection = SimConnection::new();
    let request = frame(Command::RegisterSession, 0, 0, &RegisterSession::CURRENT.bytes());
    connection.handle_input(device, &request, at(0));
    let reply = sent(&mut connection, at(0));
    assert_eq!(status_of(&reply), (Command::RegisterSession, EncapsulationStatus::Success));
    let session = Encapsulation::decode(&reply).unwrap().header.session;
    assert_ne!(session, SessionHandle(0));
    (connection, session.0)
}

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
fn each_fault_looks_as_its_name_says() {
    let reply_to = |fault: Fault| {
        let mut device = Device::new(SimConfig { faults: vec![fault], ..SimConfig::default() });
        let (mut connection, session) = registered(&mut device);
        connection.handle_input(&mut device, &rr(session, 7, &PRODUCT_NAME), at(0));
        (sent(&mut connection, at(0)), connection, session)
    };
    let (good, _, _) = reply_to(Fault::Ok);
    assert_eq!(message_of(&good)[..4], hex!("8E 00 00 00"));

    let (bytes, connection, _) = reply_to(Fault::Drop);
    assert!(bytes.is_empty() && !connection.is_closed());

    let (bytes, mut connection, session) = reply_to(Fault::HalfFrame);
    assert_eq!(bytes, good[..good.len() / 2]);
    let mut device = Device::default();
    connection.handle_input(&mut device, &rr(session, 8, &PRODUCT_NAME), at(0));
    assert!(sent(&mut connection, at(9)).is_empty(), "silence after half a frame");

    let header = |bytes: &[u8]| Encapsulation::decode(bytes).unwrap().header;
    assert_ne!(header(&reply_to(Fault::WrongContext).0).context, SenderContext::from(7));
    let (bytes, _, session) = reply_to(Fault::WrongSession);
    assert_ne!(header(&bytes).session, SessionHandle(session));

    let message = message_of(&reply_to(Fault::WrongService).0);
    assert_ne!(MessageRouterReply::decode(&message).unwrap().service, ServiceCode::GetAttributeSingle);
    assert!(Encapsulation::decode(&reply_to(Fault::Garbage).0).is_err());

    let status = EncapsulationStatus::InvalidLength;
    assert_eq!(status_of(&reply_to(Fault::EncapsulationStatus(status)).0).1, status);
    let (bytes, connection, _) = reply_to(Fault::Close);
    assert!(bytes.is_empty() && connection.is_closed());

    let message = message_of(&reply_to(Fault::ErrorStatus(GeneralStatus(0x10))).0);
    let refusal = MessageRouterReply::decode(&message).unwrap();
    assert_eq!((refusal.service, refusal.status.0), (ServiceCode::GetAttributeSingle, 0x10));
}

#[test]
fn faults_take_turns_even_over_a_new_connection() {
    let config = SimConfig { faults: vec![Fault::Close, Fault::Ok], ..SimConfig::default() };
    let mut device = Device::new(config);
    for round in 0..3 {
        let (mut connection, session) = registered(&mut device);
        connection.handle_input(&mut device, &rr(session, 1, &PRODUCT_NAME), at(0));
        assert!(connection.is_closed(), "round {round}");
        let (mut connection, session) = registered(&mut device);
        connection.handle_input(&mut device, &rr(session, 1, &PRODUCT_NAME), at(0));
        assert!(!sent(&mut connection, at(0)).is_empty(), "round {round}");
    }
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

#[cfg(not(target_arch = "wasm32"))]
mod any_bytes {
    use super::*;
    use proptest::collection::vec;
    use proptest::prelude::*;

    fn fault() -> impl Strategy<Value = Fault> {
        prop::sample::select(vec![
            Fault::Ok,
            Fault::Drop,
            Fault::HalfFrame,
            Fault::WrongContext,
            Fault::WrongSession,
            Fault::WrongService,
            Fault::Garbage,
            Fault::Close,
            Fault::EncapsulationStatus(EncapsulationStatus(0x64)),
            Fault::ErrorStatus(GeneralStatus(0x02)),
        ])
    }

    /// Frames with plausible headers and any data, so that more than the deframer is met.
    fn frames() -> impl Strategy<Value = Vec<u8>> {
        let command = prop::sample::select(vec![0_u16, 4, 0x63, 0x64, 0x65, 0x66, 0x6F, 0x70, 0x72, 0x99]);
        let one = (command, 0_u32..3, vec(any::<u8>(), 0..60))
            .prop_map(|(command, session, data)| frame(Command(command), session, 0, &data));
        let message =
            (0_u32..3, vec(any::<u8>(), 0..40)).prop_map(|(session, request)| rr(session, 0, &request));
        vec(prop_oneof![one, message, vec(any::<u8>(), 0..4)], 0..8).prop_map(|frames| frames.concat())
    }

    proptest! {
        #[test]
        fn the_device_answers_any_request(request in vec(any::<u8>(), 0..80), now in any::<u64>()) {
            let answer = Device::default().answer(&request, Instant(now));
            let reply = MessageRouterReply::decode(&answer).unwrap();
            prop_assert_eq!(reply.service.0, request.first().map_or(0, |service| service & 0x7F));
        }

        #[test]
        fn any_bytes_cut_in_any_way_get_the_same_answer(
            input in frames(), size in 1_usize..50, faults in vec(fault(), 0..4),
        ) {
            let answer = |size: usize| {
                let config = SimConfig { faults: faults.clone(), ..SimConfig::default() };
                let mut device = Device::new(config);
                let (mut connection, _) = registered(&mut device);
                let mut out = Vec::new();
                for part in input.chunks(size) {
                    connection.handle_input(&mut device, part, at(1));
                    connection.poll_transmit(&mut out, at(1));
                }
                (out, connection.is_closed())
            };
            prop_assert_eq!(answer(size), answer(usize::MAX));
        }

        #[test]
        fn any_datagram_gets_an_answer_or_none(datagram in frames()) {
            if let Some(reply) = handle_datagram(&Device::default(), &datagram) {
                prop_assert!(Encapsulation::decode(&reply).is_ok());
            }
        }
    }
}
