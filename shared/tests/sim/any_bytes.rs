//! Any bytes at all.

use cipdeck_shared::engine::time::{Instant, Millis};
use cipdeck_shared::sim::{Device, Fault, SimConfig, handle_datagram};
use cipdeck_shared::wire::{
    Command, Deframer, Encapsulation, EncapsulationStatus, GeneralStatus, MessageRouterReply,
};

use super::frames::{at, frame, registered, rr, ud};
use super::opening::{CLOSE, OPEN, along, with};

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
        Fault::WrongConnectionId,
        Fault::WrongSequence,
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
    let message = (0_u32..3, vec(any::<u8>(), 0..40)).prop_map(|(session, request)| rr(session, 0, &request));
    // Ids are 0x40000001 and on, as opened.
    let connected = (0_u32..3, 0x4000_0000_u32..0x4000_0003, 0_u16..3, vec(any::<u8>(), 0..40))
        .prop_map(|(session, id, sequence, request)| ud(session, id, sequence, &request));
    let one_change = (6_usize..40, any::<u8>());
    let open =
        (one_change, vec(any::<u8>(), 0..10), any::<bool>()).prop_map(|((place, byte), path, exact)| {
            let open = with(&OPEN, &[(place, &[byte])]);
            let path: Vec<u8> = path.into_iter().map(|byte| byte % 0x28).collect();
            let path = &path[..path.len() / 2 * 2];
            rr(1, 0, &if exact { open } else { along(&open, path) })
        });
    let send = (vec(any::<u8>(), 0..30), vec(0_u8..0x28, 0..12)).prop_map(|(message, route)| {
        let length = u8::try_from(message.len() / 2 * 2).unwrap();
        let words = u8::try_from(route.len() / 2).unwrap();
        let head = [0x52, 2, 0x20, 6, 0x24, 1, 0, 0, length, 0];
        let message = &message[..usize::from(length)];
        rr(1, 0, &[&head[..], message, &[words, 0], &route[..usize::from(words) * 2]].concat())
    });
    let close = any::<u8>().prop_map(|byte| rr(1, 0, &with(&CLOSE, &[(8, &[byte % 2])])));
    let any_frame = prop_oneof![one, message, connected, open, send, close, vec(any::<u8>(), 0..4)];
    vec(any_frame, 0..10).prop_map(|frames| frames.concat())
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
    fn whatever_is_asked_and_whenever_everything_due_is_said_and_every_connection_ends(
        parts in vec((frames(), 0_u64..20_000_000), 1..6), delay in 0_u64..50,
    ) {
        let config = SimConfig { delay: Millis(delay), max_connections: 2, ..SimConfig::default() };
        let mut device = Device::new(config);
        let (mut connection, _) = registered(&mut device);
        let (mut now, mut out) = (at(1), Vec::new());
        for (part, pause) in parts {
            connection.handle_input(&mut device, &part, now);
            now = Instant(now.0 + pause);
            connection.poll_transmit(&mut out, now);
            device.handle_timeout(now);
            prop_assert!(connection.poll_timeout().is_none_or(|due| due > now));
            prop_assert!(device.poll_timeout().is_none_or(|due| due > now));
        }
        while let Some(due) = connection.poll_timeout() {
            prop_assert!(connection.poll_transmit(&mut out, due), "something is due when it says so");
        }
        while let Some(due) = device.poll_timeout() {
            device.handle_timeout(due);
        }
        let done = device.counters();
        prop_assert_eq!(done.opened, done.closed + done.timed_out + done.unregistered);
        let mut deframer = Deframer::new();
        deframer.push(&out);
        while let Some(frame) = deframer.next_frame().unwrap() {
            prop_assert!(matches!(frame.header.status.0, 0 | 1 | 3 | 0x64 | 0x65 | 0x69), "{:?}", frame.header);
        }
    }

    #[test]
    fn any_datagram_gets_an_answer_or_none(datagram in frames()) {
        if let Some(reply) = handle_datagram(&Device::default(), &datagram) {
            prop_assert!(Encapsulation::decode(&reply).is_ok());
        }
    }
}

/// Requests to tags and to what describes them, with anything behind.
fn tag_request() -> impl Strategy<Value = Vec<u8>> {
    let service =
        prop::sample::select(vec![0x01_u8, 0x03, 0x0A, 0x0E, 0x4C, 0x4D, 0x4E, 0x52, 0x53, 0x55, 0x5F]);
    let segment = prop::sample::select(vec![
        &b"\x91\x07stMotor\x00"[..],
        b"\x91\x06arTemp",
        b"\x91\x06arBool",
        b"\x91\x05speed\x00",
        b"\x91\x08gsRecipe",
        b"\x91\x06Motor1",
        b"\x91\x03Run\x00",
        b"\x91\x05Flags\x00",
        b"\x91\x06Recipe",
        b"\x91\x0CProgram:Main",
        b"\x91\x01x\x00",
        b"\x28\x02",
        b"\x2A\x00\xFF\xFF\xFF\xFF",
        b"\x80\x03\x00\x00\x00\x00\x04\x00",
        b"\x80\x03\xFC\xFF\xFF\xFF\xFF\xFF",
        b"\x20\x6B",
        b"\x20\x6C",
        b"\x20\x6A",
        b"\x20\x02",
        b"\x24\x00",
        b"\x24\x01",
        b"\x25\x00\x01\x01",
        b"\x25\x00\xCE\x0F",
    ]);
    let data = prop_oneof![
        vec(any::<u8>(), 0..16),
        // A type, a count, and values.
        (
            prop::sample::select(vec![0xC1_u8, 0xC3, 0xC4, 0xCA, 0xD0, 0xD3, 0xDA]),
            0_u8..4,
            vec(any::<u8>(), 0..12)
        )
            .prop_map(|(kind, count, values)| [&[kind, 0, count, 0][..], &values].concat()),
        (0_u8..3, 0_u8..40).prop_map(|(count, offset)| vec![count, 0, offset, 0, 0, 0]),
    ];
    (service, vec(segment, 0..4), data).prop_map(|(service, path, data)| {
        let path = path.concat();
        let words = u8::try_from(path.len() / 2).unwrap();
        [&[service, words][..], &path, &data].concat()
    })
}

proptest! {
    #[test]
    fn controllers_answer_any_request_about_tags(
        requests in vec(prop_oneof![4 => tag_request(), 1 => vec(any::<u8>(), 0..40)], 1..8), now in any::<u64>(),
    ) {
        use cipdeck_shared::sim::SimProfile;
        use cipdeck_shared::wire::MultipleServicePacket;
        for profile in [SimProfile::Logix, SimProfile::Omron, SimProfile::Micro800] {
            let mut device = Device::new(profile.config());
            let parts: Vec<&[u8]> = requests.iter().map(Vec::as_slice).filter(|part| !part.is_empty()).collect();
            let packet = MultipleServicePacket::new(parts).map(|packet| packet.request().unwrap().bytes());
            for request in requests.iter().chain(&packet) {
                let answer = device.answer(request, Instant(now));
                let reply = MessageRouterReply::decode(&answer).unwrap();
                prop_assert_eq!(reply.service.0, request.first().map_or(0, |service| service & 0x7F));
                prop_assert!(answer.len() <= 504, "{:?}: {} bytes", profile, answer.len());
            }
        }
    }
}
