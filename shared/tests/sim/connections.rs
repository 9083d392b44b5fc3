//! Requests over class 3 connections.

use cipdeck_shared::engine::time::Millis;
use cipdeck_shared::sim::{Counters, Device, Fault, Quirk, SimConfig, SimConnection};
use cipdeck_shared::wire::{Command, Encapsulation, EncapsulationStatus, SenderContext};
use hex_literal::hex;

use super::frames::{
    MOVING, PRODUCT_NAME, at, connected_of, exchange, frame, message_of, registered, rr, sent, status_of, ud,
};
use super::opening::{CLOSE, LARGE_OPEN, OPEN, along, with};

#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

/// Opens over a session; the O->T id.
fn open(device: &mut Device, connection: &mut SimConnection, session: u32, request: &[u8]) -> u32 {
    let reply = message_of(&exchange(device, connection, &rr(session, 1, request), at(0)));
    assert_eq!(reply[1..4], [0; 3], "{reply:02X?}");
    u32::from_le_bytes([reply[4], reply[5], reply[6], reply[7]])
}

/// A device with a session and a connection.
pub(crate) fn connected(config: SimConfig, request: &[u8]) -> (Device, SimConnection, u32, u32) {
    let mut device = Device::new(config);
    let (mut connection, session) = registered(&mut device);
    let id = open(&mut device, &mut connection, session, request);
    (device, connection, session, id)
}

#[test]
fn a_thousand_requests_over_one_connection_have_the_value_of_their_moment() {
    let (mut device, mut connection, session, id) = connected(SimConfig::default(), &OPEN);
    for round in 1..=1_000_u16 {
        let now = at(u64::from(round));
        let reply = exchange(&mut device, &mut connection, &ud(session, id, round, &MOVING), now);
        let (t_o_id, sequence, message) = connected_of(&reply);
        assert_eq!((t_o_id, sequence, &message[..4]), (0x1122_3344, round, &hex!("8E 00 00 00")[..]));
        assert_eq!(message[4..8], u32::from(round).to_le_bytes());
        assert_eq!(Encapsulation::decode(&reply).unwrap().header.context, SenderContext::from(5));
    }
    exchange(&mut device, &mut connection, &rr(session, 1, &CLOSE), at(1_001));
    let done = Counters { opened: 1, connected: 1_000, closed: 1, ..Counters::default() };
    assert_eq!(device.counters(), done);
    assert_eq!(
        done.to_string(),
        "unconnected 0, connections opened 1, connected requests 1000, closed 1, timed out 0, unregistered 0, \
         repeated 0, dropped 0"
    );
}

#[test]
fn the_same_sequence_count_gets_the_same_answer_and_nothing_is_carried_out_twice() {
    let (mut device, mut connection, session, id) = connected(SimConfig::default(), &OPEN);
    let first = exchange(&mut device, &mut connection, &ud(session, id, 7, &MOVING), at(10));
    assert_eq!(exchange(&mut device, &mut connection, &ud(session, id, 7, &MOVING), at(20)), first);
    let write = |value| [&hex!("10 03 20 93 24 29 30 09")[..], &[value, 0]].concat();
    for value in [1, 2] {
        let reply = exchange(&mut device, &mut connection, &ud(session, id, 8, &write(value)), at(30));
        assert_eq!(connected_of(&reply).2, hex!("90 00 00 00"));
    }
    let read =
        exchange(&mut device, &mut connection, &ud(session, id, 9, &hex!("0E 03 20 93 24 29 30 09")), at(40));
    assert_eq!(connected_of(&read).2[4..], [1, 0], "written once");
    let later = exchange(&mut device, &mut connection, &ud(session, id, 7, &MOVING), at(50));
    assert_ne!(later, first, "only the last one is remembered");
    assert_eq!((device.counters().connected, device.counters().repeated), (4, 2));
}

#[test]
fn a_connection_along_a_route_belongs_to_the_device_at_its_end() {
    let (mut device, mut connection, session, id) =
        connected(SimConfig::default(), &along(&OPEN, &hex!("01 01 20 02 24 01")));
    let reply = exchange(&mut device, &mut connection, &ud(session, id, 1, &PRODUCT_NAME), at(0));
    assert_eq!(connected_of(&reply).2[5..], b"cipdeck demo I/O"[..]);
    let far = hex!("01 03 12 0C 31 39 32 2E 31 36 38 2E 31 2E 32 30 20 02 24 01"); // 1,3,2,192.168.1.20
    let far = along(&with(&OPEN, &[(16, &[2])]), &far);
    let id = open(&mut device, &mut connection, session, &far);
    let reply = exchange(&mut device, &mut connection, &ud(session, id, 1, &PRODUCT_NAME), at(0));
    assert_eq!(connected_of(&reply).2[5..], b"cipdeck demo remote"[..]);
    // Each Connection Manager counts the connections that begin or end at it.
    for (route, opens) in [(None, 2), (Some(1), 1), (Some(3), 0)] {
        let count = hex!("0E 03 20 06 24 01 30 01");
        let request = match route {
            None => count.to_vec(),
            Some(slot) => [&hex!("52 02 20 06 24 01 00 FA 08 00")[..], &count, &[1, 0, 1, slot]].concat(),
        };
        let reply = message_of(&exchange(&mut device, &mut connection, &rr(session, 1, &request), at(0)));
        assert_eq!(reply, [&hex!("8E 00 00 00")[..], &[opens, 0]].concat(), "{route:?}");
    }
    let close = along(&CLOSE, &hex!("01 01 20 02 24 01"));
    let reply = exchange(&mut device, &mut connection, &rr(session, 1, &close), at(0));
    assert_eq!(message_of(&reply)[..4], hex!("CE 00 00 00"));
}

#[test]
fn connected_messages_can_be_routed_further() {
    let (mut device, mut connection, session, id) =
        connected(SimConfig::default(), &along(&OPEN, &hex!("01 03 20 02 24 01")));
    let far = hex!("07 00 12 0C 31 39 32 2E 31 36 38 2E 31 2E 32 30"); // 2,192.168.1.20
    let request = [&hex!("52 02 20 06 24 01 00 FA 08 00")[..], &PRODUCT_NAME, &far].concat();
    let reply = exchange(&mut device, &mut connection, &ud(session, id, 1, &request), at(0));
    assert_eq!(connected_of(&reply).2[5..], b"cipdeck demo remote"[..]);
}

#[test]
fn messages_are_as_long_as_the_connection_allows() {
    let sizes = |o_t: u8, t_o: u8| with(&OPEN, &[(32, &[o_t, 0x42]), (38, &[t_o, 0x42])]);
    let write = [&hex!("10 03 20 04 24 96 30 03")[..], &[0; 32]].concat(); // 40, with the sequence count 42
    for (size, reply) in [(42, hex!("90 00 00 00")), (41, hex!("90 00 15 00"))] {
        let (mut device, mut connection, session, id) = connected(SimConfig::default(), &sizes(size, 100));
        let said = exchange(&mut device, &mut connection, &ud(session, id, 1, &write), at(0));
        assert_eq!(connected_of(&said).2, reply, "requests of {size} bytes");
    }
    for (size, status) in [(38, 0), (37, 0x11)] {
        let (mut device, mut connection, session, id) = connected(SimConfig::default(), &sizes(100, size));
        let said = exchange(&mut device, &mut connection, &ud(session, id, 1, &MOVING), at(0));
        assert_eq!(connected_of(&said).2[2], status, "replies of {size} bytes");
    }
}

#[test]
fn a_silent_connection_ends_and_a_busy_one_does_not() {
    // RPI 2 s x 32
    let (mut device, mut connection, session, id) = connected(SimConfig::default(), &OPEN);
    assert_eq!(device.poll_timeout(), Some(at(64_000)));
    let reply = exchange(&mut device, &mut connection, &ud(session, id, 1, &PRODUCT_NAME), at(63_999));
    assert_eq!(connected_of(&reply).1, 1);
    assert_eq!(device.poll_timeout(), Some(at(127_999)));
    device.handle_timeout(at(127_998));
    assert_eq!(device.counters().timed_out, 0);
    assert!(
        exchange(&mut device, &mut connection, &ud(session, id, 2, &PRODUCT_NAME), at(127_999)).is_empty()
    );
    let counters = device.counters();
    assert_eq!((counters.timed_out, counters.dropped, counters.connected), (1, 1, 1));
    assert_eq!(device.poll_timeout(), None);
    assert_eq!(device.answer(&OPEN, at(127_999))[..4], hex!("D4 00 00 00"), "its name is free again");
}

#[test]
fn a_fast_connection_has_ten_seconds_for_its_first_request() {
    // rseip: 16,960 us x 32 = 542.72 ms
    let request = with(&OPEN, &[(28, &hex!("40 42 00 00"))]);
    let (mut device, mut connection, session, id) = connected(SimConfig::default(), &request);
    assert_eq!(device.poll_timeout(), Some(at(10_000)));
    exchange(&mut device, &mut connection, &ud(session, id, 1, &PRODUCT_NAME), at(9_999));
    assert_eq!(device.poll_timeout().map(|time| time.0), Some(9_999_000 + 542_720));
}

#[test]
fn connections_outlive_the_tcp_connection_but_not_their_session() {
    let config = SimConfig { max_connections: 1, ..SimConfig::default() };
    let (mut device, lost, _, id) = connected(config, &OPEN);
    drop(lost);
    let (mut connection, session) = registered(&mut device);
    let reply = exchange(&mut device, &mut connection, &rr(session, 1, &with(&OPEN, &[(16, &[2])])), at(0));
    assert_eq!(message_of(&reply)[..6], hex!("D4 00 01 01 13 01"), "it still takes its place");
    assert!(
        exchange(&mut device, &mut connection, &ud(session, id, 1, &PRODUCT_NAME), at(0)).is_empty(),
        "it belongs to the session that opened it"
    );
    let reply = exchange(&mut device, &mut connection, &rr(session, 1, &CLOSE), at(0));
    assert_eq!(message_of(&reply)[..4], hex!("CE 00 00 00"), "whoever knows its name can close it");
    open(&mut device, &mut connection, session, &OPEN);
    exchange(&mut device, &mut connection, &frame(Command::UnRegisterSession, session, 0, &[]), at(0));
    assert_eq!((device.counters().unregistered, device.poll_timeout()), (1, None));
}

#[test]
fn a_message_to_no_connection_gets_no_answer() {
    let (mut device, mut connection, session, id) = connected(SimConfig::default(), &OPEN);
    for wrong in [0, id + 1, 0x1122_3344] {
        assert!(
            exchange(&mut device, &mut connection, &ud(session, wrong, 1, &PRODUCT_NAME), at(0)).is_empty()
        );
    }
    assert_eq!((device.counters().dropped, device.counters().connected), (3, 0));
    let foreign = exchange(&mut device, &mut connection, &ud(session + 1, id, 1, &PRODUCT_NAME), at(0));
    assert_eq!(status_of(&foreign), (Command::SendUnitData, EncapsulationStatus::InvalidSessionHandle));
    let unconnected = &rr(session, 1, &PRODUCT_NAME)[24..];
    let odd =
        exchange(&mut device, &mut connection, &frame(Command::SendUnitData, session, 1, unconnected), at(0));
    assert_eq!(status_of(&odd).1, EncapsulationStatus::IncorrectData);
    let empty = exchange(&mut device, &mut connection, &ud(session, id, 1, &[]), at(0));
    assert_eq!(connected_of(&empty).2, hex!("80 00 13 00"), "an empty message has an answer");
}

#[test]
fn connected_requests_wait_their_turn_and_a_router_its_time() {
    let config = SimConfig { delay: Millis(100), ..SimConfig::default() };
    let mut device = Device::new(config);
    let (mut connection, session) = registered(&mut device);
    connection.handle_input(&mut device, &rr(session, 1, &OPEN), at(0));
    let reply = message_of(&sent(&mut connection, at(100)));
    let id = u32::from_le_bytes([reply[4], reply[5], reply[6], reply[7]]);
    let nobody = hex!("07 00 12 0C 31 39 32 2E 31 36 38 2E 31 2E 39 39"); // 2,192.168.1.99
    let nobody = [&hex!("52 02 20 06 24 01 00 FA 08 00")[..], &PRODUCT_NAME, &nobody].concat();
    let both = [ud(session, id, 1, &nobody), ud(session, id, 2, &MOVING)].concat();
    connection.handle_input(&mut device, &both, at(200));
    assert_eq!(connection.poll_timeout(), Some(at(400)));
    assert_eq!(connected_of(&sent(&mut connection, at(400))).1, 2);
    assert_eq!(connection.poll_timeout(), Some(at(550)));
    let reply = connected_of(&sent(&mut connection, at(550)));
    assert_eq!((reply.1, reply.2), (1, hex!("D2 00 01 01 04 02 07 00").to_vec()));
}

#[test]
fn faults_befall_connected_replies() {
    let reply_to = |fault: Fault| {
        let config = SimConfig { faults: vec![Fault::Ok, fault], ..SimConfig::default() };
        let (mut device, mut connection, session, id) = connected(config, &OPEN);
        let reply = exchange(&mut device, &mut connection, &ud(session, id, 9, &PRODUCT_NAME), at(0));
        (reply, device, connection)
    };
    let good = reply_to(Fault::Ok).0;
    let (id, sequence, message) = connected_of(&reply_to(Fault::WrongConnectionId).0);
    assert!(id != 0x1122_3344 && sequence == 9 && message == connected_of(&good).2);
    let (id, sequence, message) = connected_of(&reply_to(Fault::WrongSequence).0);
    assert!(id == 0x1122_3344 && sequence != 9 && message == connected_of(&good).2);
    assert!(reply_to(Fault::Drop).0.is_empty());
    assert!(reply_to(Fault::Close).2.is_closed());
    assert_eq!(reply_to(Fault::HalfFrame).0, good[..good.len() / 2]);
    let (bytes, device, _) = reply_to(Fault::EncapsulationStatus(EncapsulationStatus(0x65)));
    assert_eq!((status_of(&bytes).1, device.counters().connected), (EncapsulationStatus(0x65), 0));
    let (bytes, ..) = reply_to(Fault::ErrorStatus(0x10.into()));
    assert_eq!(connected_of(&bytes).2, hex!("8E 00 10 00"));
    for fault in [Fault::WrongConnectionId, Fault::WrongSequence] {
        let mut device = Device::new(SimConfig { faults: vec![fault], ..SimConfig::default() });
        let (mut connection, session) = registered(&mut device);
        let reply = exchange(&mut device, &mut connection, &rr(session, 1, &PRODUCT_NAME), at(0));
        assert_eq!(message_of(&reply)[..4], hex!("8E 00 00 00"), "nothing to get wrong: {fault}");
    }
}

#[test]
fn a_reply_that_was_lost_can_be_asked_for_again() {
    let config = SimConfig { faults: vec![Fault::Ok, Fault::Drop, Fault::Ok], ..SimConfig::default() };
    let (mut device, mut connection, session, id) = connected(config, &OPEN);
    assert!(exchange(&mut device, &mut connection, &ud(session, id, 1, &MOVING), at(100)).is_empty());
    let reply = exchange(&mut device, &mut connection, &ud(session, id, 1, &MOVING), at(900));
    assert_eq!(connected_of(&reply).2[4..8], 100_u32.to_le_bytes(), "the answer of the first time");
}

#[test]
fn quirks_are_there_in_every_reply() {
    let config = SimConfig { quirks: vec![Quirk::NoContext, Quirk::OwnConnectionId], ..SimConfig::default() };
    let mut device = Device::new(config);
    let mut connection = SimConnection::new();
    let context = |bytes: &[u8]| Encapsulation::decode(bytes).unwrap().header.context;
    let register = frame(Command::RegisterSession, 0, 77, &hex!("01 00 00 00"));
    let reply = exchange(&mut device, &mut connection, &register, at(0));
    let session = Encapsulation::decode(&reply).unwrap().header.session.0;
    assert_eq!(context(&reply), SenderContext::default());
    let opened = exchange(&mut device, &mut connection, &rr(session, 78, &OPEN), at(0));
    let id = open(&mut device, &mut connection, session, &with(&OPEN, &[(16, &[2])]));
    let reply = exchange(&mut device, &mut connection, &ud(session, id, 1, &PRODUCT_NAME), at(0));
    let refused = exchange(&mut device, &mut connection, &rr(session + 1, 79, &PRODUCT_NAME), at(0));
    let found = exchange(&mut device, &mut connection, &frame(Command::ListIdentity, 0, 80, &[]), at(0));
    for bytes in [opened, reply.clone(), refused, found] {
        assert_eq!(context(&bytes), SenderContext::default());
    }
    assert_eq!(connected_of(&reply).0, id);
    for quirk in [Quirk::NoContext, Quirk::OwnConnectionId] {
        assert_eq!(quirk.to_string().parse(), Ok(quirk));
    }
    assert!("context".parse::<Quirk>().unwrap_err().to_string().contains("own-connection-id"));
}

#[test]
fn open_connections_take_bounded_memory() {
    let (mut device, mut connection, session, _) = connected(SimConfig::default(), &LARGE_OPEN);
    let mut open = 1;
    for serial in 2..=500_u16 {
        let request = with(&LARGE_OPEN, &[(16, &serial.to_le_bytes())]);
        let reply = message_of(&exchange(&mut device, &mut connection, &rr(session, 1, &request), at(0)));
        open += u64::from(reply[2] == 0);
    }
    assert_eq!((open, device.counters().opened), (32, 32));
}
