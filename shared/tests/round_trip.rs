//! What is encoded decodes to the same.
#![cfg(not(target_arch = "wasm32"))]
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::indexing_slicing, reason = "a test may fail")]

use cipdeck_shared::wire::{
    AdditionalStatus, CipType, CipValue, Command, CommonPacketFormat, Deframer, Encapsulation,
    EncapsulationStatus, Epath, GeneralStatus, Header, ItemType, ListIdentityItem, ListServicesItem,
    LogicalKind, MessageRouterReply, MessageRouterRequest, MultipleServicePacket, PortSegment, Reader,
    RegisterSession, Segment, SendRrData, SenderContext, ServiceCode, SessionHandle, ShortString,
    SocketAddress, SymbolSegment, UnconnectedMessage,
};
use proptest::array::uniform;
use proptest::collection::vec;
use proptest::prelude::*;

fn bytes(most: usize) -> impl Strategy<Value = Vec<u8>> {
    vec(any::<u8>(), 0..=most)
}

fn header() -> impl Strategy<Value = Header> {
    (any::<u16>(), any::<u32>(), any::<u32>(), any::<[u8; 8]>(), any::<u32>()).prop_map(
        |(command, session, status, context, options)| Header {
            command: Command(command),
            session: SessionHandle(session),
            status: EncapsulationStatus(status),
            context: SenderContext(context),
            options,
        },
    )
}

/// Numbers near the borders of the three widths as often as any others.
fn number() -> impl Strategy<Value = u32> {
    prop_oneof![0..0x200_u32, 0xFFF0..0x1_0010_u32, any::<u32>()]
}

fn epath() -> impl Strategy<Value = Epath> {
    let kind = prop::sample::select(vec![
        LogicalKind::Class,
        LogicalKind::Instance,
        LogicalKind::Member,
        LogicalKind::ConnectionPoint,
        LogicalKind::Attribute,
    ]);
    let logical = (kind, number()).prop_map(|(kind, value)| (Some(kind), value, 1, Vec::new()));
    let port = (1..=u16::MAX, vec(any::<u8>(), 1..=40)).prop_map(|(port, link)| (None, 0, port, link));
    vec(prop_oneof![4 => logical, 1 => port], 0..8).prop_map(|segments| {
        segments.into_iter().fold(Epath::default(), |path, (kind, value, port, link)| match kind {
            Some(kind) => path.then(kind, value),
            None => path.hop(PortSegment::with_address(port, &link).unwrap()),
        })
    })
}

fn short_string() -> impl Strategy<Value = ShortString> {
    bytes(255).prop_map(|bytes| ShortString::new(&bytes).unwrap())
}

fn value() -> impl Strategy<Value = (CipType, CipValue)> {
    prop_oneof![
        any::<u8>().prop_map(|value| (CipType::Usint, CipValue::Usint(value))),
        any::<u16>().prop_map(|value| (CipType::Uint, CipValue::Uint(value))),
        any::<u32>().prop_map(|value| (CipType::Udint, CipValue::Udint(value))),
        any::<i16>().prop_map(|value| (CipType::Int, CipValue::Int(value))),
        any::<i32>().prop_map(|value| (CipType::Dint, CipValue::Dint(value))),
        any::<f32>().prop_map(|value| (CipType::Real, CipValue::Real(value))),
        any::<u16>().prop_map(|value| (CipType::Word, CipValue::Word(value))),
        any::<u32>().prop_map(|value| (CipType::Dword, CipValue::Dword(value))),
        short_string().prop_map(|value| (CipType::ShortString, CipValue::ShortString(value))),
    ]
}

proptest! {
    #[test]
    fn paths(path in epath()) {
        let encoded = path.bytes();
        prop_assert!(encoded.len().is_multiple_of(2), "a path is counted in words");
        prop_assert_eq!(Epath::decode(&encoded), Ok(path));
    }

    #[test]
    fn requests(service in 1..0x80_u8, path in epath(), data in bytes(500)) {
        let request = MessageRouterRequest::new(ServiceCode(service), path, data).unwrap();
        prop_assert_eq!(MessageRouterRequest::decode(&request.bytes()), Ok(request));
    }

    #[test]
    fn names(parts in vec(vec(any::<u8>(), 1..=255), 1..4)) {
        let segment = |name: &Vec<u8>| Segment::Symbol(SymbolSegment::new(name).unwrap());
        let path = parts.iter().map(segment).fold(Epath::default(), Epath::with);
        prop_assert_eq!(Epath::decode(&path.bytes()), Ok(path));
    }

    #[test]
    fn packets_of_requests(parts in vec(vec(any::<u8>(), 1..40), 1..12)) {
        let packet = MultipleServicePacket::new(parts.iter().map(Vec::as_slice).collect()).unwrap();
        let request = packet.request().unwrap();
        prop_assert_eq!(MultipleServicePacket::decode(request.data()), Ok(packet));
    }

    #[test]
    fn replies(service in 0..0x80_u8, status in any::<u8>(), words in vec(any::<u16>(), 0..=255), data in bytes(500)) {
        let words: Vec<u8> = words.into_iter().flat_map(u16::to_le_bytes).collect();
        let reply = MessageRouterReply {
            service: ServiceCode(service),
            status: GeneralStatus(status),
            additional: AdditionalStatus::new(&words).unwrap(),
            data: &data,
        };
        let mut out = Vec::new();
        reply.encode(&mut out);
        prop_assert_eq!(MessageRouterReply::decode(&out), Ok(reply));
    }

    #[test]
    fn frames(header in header(), data in bytes(2_000)) {
        let frame = Encapsulation::new(header, &data).unwrap();
        let mut out = Vec::new();
        frame.encode(&mut out);
        prop_assert_eq!(Encapsulation::decode(&out), Ok(frame));
    }

    #[test]
    fn frames_through_a_stream_that_is_cut_anywhere(
        frames in vec((header(), bytes(60)), 1..6), size in 1_usize..80,
    ) {
        let mut stream = Vec::new();
        for (header, data) in &frames {
            Encapsulation::new(*header, data).unwrap().encode(&mut stream);
        }
        let mut deframer = Deframer::new();
        let mut arrived = Vec::new();
        for part in stream.chunks(size) {
            deframer.push(part);
            while let Some(frame) = deframer.next_frame().unwrap() {
                arrived.push((frame.header, frame.data().to_vec()));
            }
        }
        prop_assert_eq!(arrived, frames);
        prop_assert_eq!(deframer.pending(), 0);
    }

    #[test]
    fn unconnected_messages(header in header(), timeout in any::<u16>(), message in bytes(600)) {
        let mut out = Vec::new();
        UnconnectedMessage::new(&message).unwrap().encode(&header, timeout, &mut out);
        let frame = Encapsulation::decode(&out).unwrap();
        let data = SendRrData::decode(frame.data()).unwrap();
        prop_assert_eq!((data.interface_handle, data.timeout, data.packet.count()), (0, timeout, 2));
        prop_assert_eq!(data.unconnected().unwrap().data, message);
        prop_assert_eq!(data.packet.items().next().unwrap().kind, ItemType::NullAddress);
    }

    #[test]
    fn sessions(version in any::<u16>(), options in any::<u16>()) {
        let register = RegisterSession { version, options };
        prop_assert_eq!(RegisterSession::decode(&register.bytes()), Ok(register));
    }

    #[test]
    fn identities(numbers in uniform::<_, 6>(any::<u16>()), serial in any::<u32>(), ip in any::<[u8; 4]>(),
        tail in any::<[u8; 3]>(), name in short_string(),
    ) {
        let [port, vendor, device_type, product_code, status, protocol_version] = numbers;
        let [major, minor, state] = tail;
        let item = ListIdentityItem {
            protocol_version, address: SocketAddress::v4(ip, port), vendor, device_type, product_code, major,
            minor, status, serial, name, state,
        };
        let mut out = Vec::new();
        item.encode_reply(&mut out);
        let packet = CommonPacketFormat::read(&mut Reader::new(&out)).unwrap();
        let data = packet.find(ItemType::ListIdentity).unwrap().data;
        prop_assert_eq!(ListIdentityItem::decode(data), Ok(item));
    }

    #[test]
    fn services(version in any::<u16>(), flags in any::<u16>(), name in any::<[u8; 16]>()) {
        let item = ListServicesItem { version, flags, name };
        let mut out = Vec::new();
        item.encode_reply(&mut out);
        let packet = CommonPacketFormat::read(&mut Reader::new(&out)).unwrap();
        let data = packet.find(ItemType::ListServices).unwrap().data;
        prop_assert_eq!(ListServicesItem::decode(data), Ok(item));
    }

    #[test]
    fn values((kind, value) in value()) {
        let mut out = Vec::new();
        value.encode(&mut out);
        let mut reader = Reader::new(&out);
        prop_assert_eq!(kind.read(&mut reader), Ok(value));
        prop_assert!(reader.is_empty());
    }
}
