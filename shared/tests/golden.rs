//! Frames that others have sent: decoded, compared, and encoded again byte for byte.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::indexing_slicing, reason = "a test may fail")]

mod common;

use cipdeck_shared::engine::time::Instant;
use cipdeck_shared::sim::{Device, SimConnection};
use cipdeck_shared::wire::{
    Command, CommonPacketFormat, Encapsulation, EncapsulationStatus, Epath, GeneralStatus, Header, ItemType,
    ListIdentityItem, ListServicesItem, LogicalKind, MessageRouterReply, MessageRouterRequest, Reader,
    RegisterSession, SendRrData, SenderContext, ServiceCode, SessionHandle, UnconnectedMessage,
};

#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

#[test]
fn every_frame_encodes_again_byte_for_byte() {
    let frames = common::frames();
    assert!(frames.len() > 40);
    for (name, bytes) in frames {
        let mut out = Vec::new();
        Encapsulation::decode(&bytes).unwrap().encode(&mut out);
        assert_eq!(out, bytes, "{name}");
    }
}

#[test]
fn every_unconnected_message_encodes_again_byte_for_byte() {
    let mut messages = 0;
    for (name, bytes) in common::frames() {
        let frame = Encapsulation::decode(&bytes).unwrap();
        if frame.header.command != Command::SendRRData {
            continue;
        }
        let data = SendRrData::decode(frame.data()).unwrap();
        let message = data.unconnected().unwrap();
        let mut out = Vec::new();
        UnconnectedMessage::new(message.data).unwrap().encode(&frame.header, data.timeout, &mut out);
        assert_eq!(out, bytes, "{name}");
        if name.ends_with("_reply") {
            let mut out = Vec::new();
            MessageRouterReply::decode(message.data).unwrap().encode(&mut out);
            assert_eq!(out, message.data, "{name}");
        }
        messages += 1;
    }
    assert!(messages > 20, "{messages}");
}

#[test]
fn the_articles_session_frames_are_what_we_send() {
    let header =
        |command, session| Header::request(command, SessionHandle(session), SenderContext::default());
    let version = RegisterSession::CURRENT.bytes();
    let rows = [
        (
            "register_session_request",
            Encapsulation::new(header(Command::RegisterSession, 0), &version).unwrap(),
        ),
        (
            "register_session_reply",
            Encapsulation::new(header(Command::RegisterSession, 0x000E_0171), &version).unwrap(),
        ),
        ("unregister_session_request", Encapsulation::empty(header(Command::UnRegisterSession, 0x0004_0171))),
    ];
    for (name, frame) in rows {
        let mut out = Vec::new();
        frame.encode(&mut out);
        assert_eq!(out, common::frame(&format!("omron_nx.{name}")), "{name}");
    }
}

#[test]
fn requests_to_attributes_are_built_as_others_build_them() {
    let get = ServiceCode::GetAttributeSingle;
    let attribute = |class, number| Epath::object(class, 1).then(LogicalKind::Attribute, number);
    let set = Epath::object(4, 150).then(LogicalKind::Attribute, 3);
    let rows = [
        ("opener.product_name_request", get, attribute(1, 7), Vec::new()),
        ("opener.identity_all_request", ServiceCode::GetAttributesAll, Epath::object(1, 1), Vec::new()),
        ("opener.tcp_ip_configuration_request", get, attribute(245, 5), Vec::new()),
        ("opener.assembly_write_request", ServiceCode::SetAttributeSingle, set, (0..32).collect()),
        ("ciplink.product_name_request", get, attribute(1, 7), Vec::new()),
    ];
    for (name, service, path, data) in rows {
        let request = MessageRouterRequest::new(service, path, data).unwrap();
        assert_eq!(request.bytes(), common::message(name), "{name}");
    }
    let wide = MessageRouterRequest::decode(&common::message("opener.sixteen_bit_path_request")).unwrap();
    assert_eq!(*wide.path(), attribute(1, 1), "wider segments than necessary mean the same");
}

#[test]
fn devices_that_introduce_themselves_are_understood() {
    for (name, product, port) in [("opener", "OpENer PC", 44_820), ("ciplink", "ciplink adapter", 44_826)] {
        let bytes = common::frame(&format!("{name}.list_identity_reply"));
        let frame = Encapsulation::decode(&bytes).unwrap();
        let packet = CommonPacketFormat::read(&mut Reader::new(frame.data())).unwrap();
        let identity = ListIdentityItem::decode(packet.find(ItemType::ListIdentity).unwrap().data).unwrap();
        assert_eq!((identity.name.text().as_str(), identity.address.port), (product, port));
        let mut out = Vec::new();
        identity.encode_reply(&mut out);
        assert_eq!(out, frame.data(), "{name}");
        let item = packet.find(ItemType::ListIdentity).unwrap().data;
        let without_state = ListIdentityItem::decode(&item[..item.len() - 1]).unwrap();
        assert_eq!(without_state.state, 255, "{name}: some devices leave the state out");
    }
    let bytes = common::frame("opener.list_services_reply");
    let frame = Encapsulation::decode(&bytes).unwrap();
    let packet = CommonPacketFormat::read(&mut Reader::new(frame.data())).unwrap();
    let services = ListServicesItem::decode(packet.find(ItemType::ListServices).unwrap().data).unwrap();
    assert_eq!(services.flags, ListServicesItem::TCP | ListServicesItem::UDP_IO);
}

#[test]
fn refusals_carry_their_status_and_their_words() {
    let status = |name: &str| {
        let message = common::message(name);
        let reply = MessageRouterReply::decode(&message).unwrap();
        (reply.status, reply.additional.words().collect::<Vec<_>>())
    };
    assert_eq!(status("opener.unknown_class_reply"), (GeneralStatus::PathDestinationUnknown, vec![]));
    assert_eq!(status("opener.unknown_attribute_reply"), (GeneralStatus::AttributeNotSupported, vec![]));
    assert_eq!(status("opener.forward_open_refused_reply"), (GeneralStatus::ConnectionFailure, vec![0x0315]));
    let unknown = common::frame("opener.unknown_command_reply");
    let header = Encapsulation::decode(&unknown).unwrap().header;
    assert_eq!((header.command, header.status), (Command(0xFF), EncapsulationStatus::InvalidCommand));
}

#[test]
fn the_simulated_device_accepts_and_refuses_what_opener_does() {
    let mut device = Device::default();
    for name in [
        "product_name",
        "identity_all",
        "unknown_class",
        "tcp_ip_configuration",
        "mac_address",
        "assembly_write",
    ] {
        let answer = device.answer(&common::message(&format!("opener.{name}_request")), Instant::ZERO);
        let ours = MessageRouterReply::decode(&answer).unwrap();
        let theirs = common::message(&format!("opener.{name}_reply"));
        let theirs = MessageRouterReply::decode(&theirs).unwrap();
        assert_eq!((ours.service, ours.status), (theirs.service, theirs.status), "{name}");
    }
    let mut connection = SimConnection::new();
    let mut out = Vec::new();
    connection.handle_input(&mut device, &common::frame("opener.register_session_request"), Instant::ZERO);
    connection.handle_input(&mut device, &common::frame("opener.nop"), Instant::ZERO);
    connection.poll_transmit(&mut out, Instant::ZERO);
    assert_eq!(out, common::frame("opener.register_session_reply"));
}
