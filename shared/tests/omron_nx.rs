//! The frames of the document on Omron NX, made from a configuration: a path, names of tags, a value. The document mixes
//! four session handles; each frame is made with its own.
#![allow(clippy::unwrap_used, clippy::indexing_slicing, clippy::print_stdout, reason = "a test may fail")]

mod common;

use cipdeck_shared::config::Profile;
use cipdeck_shared::plan::{MessagePlan, TagWay};
use cipdeck_shared::tag::{Dialect, TagData, TagName, Type, Value, request};
use cipdeck_shared::wire::{
    Command, Encapsulation, Header, MessageRouterReply, MessageRouterRequest, MultipleServicePacket,
    MultipleServiceReply, RegisterSession, SenderContext, SessionHandle, UnconnectedMessage,
};

#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

/// Slot 0 behind the controller's Ethernet port; 4 min 6 s, as the document has it.
fn way() -> TagWay {
    let path = "4,192.168.250.1,1,0".parse().unwrap();
    TagWay { path, profile: Profile::Omron, connected: false, timeout_ms: 245_760 }
}

fn frame(request: MessageRouterRequest, session: u32) -> Vec<u8> {
    let plan = MessagePlan::tag(&way(), request).unwrap();
    let message = UnconnectedMessage::new(plan.routed(Profile::Omron).message()).unwrap();
    let header = Header::request(Command::SendRRData, SessionHandle(session), SenderContext::default());
    let mut out = Vec::new();
    message.encode(&header, 1, &mut out);
    out
}

fn read(name: &str) -> MessageRouterRequest {
    let name: TagName = name.parse().unwrap();
    request::read(name.path(), 1).unwrap()
}

/// The value in a reply, whose type the device says itself.
fn value(reply: &[u8]) -> Value {
    let reply = MessageRouterReply::decode(reply).unwrap();
    let data = TagData::decode(reply.data).unwrap();
    let kind = Type::of_data(Dialect::Omron, &data, 1).unwrap();
    kind.decode(Dialect::Omron, data.data).unwrap()
}

fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02X}")).collect::<Vec<_>>().join(" ")
}

#[test]
fn registering_and_unregistering_are_the_documents_bytes() {
    let header =
        |command, session| Header::request(command, SessionHandle(session), SenderContext::default());
    let mut out = Vec::new();
    let data = RegisterSession::CURRENT.bytes();
    Encapsulation::new(header(Command::RegisterSession, 0), &data).unwrap().encode(&mut out);
    assert_eq!(out, common::frame("omron_nx.register_session_request"));
    let reply = common::frame("omron_nx.register_session_reply");
    assert_eq!(Encapsulation::decode(&reply).unwrap().header.session, SessionHandle(0x000E_0171));
    out.clear();
    Encapsulation::empty(header(Command::UnRegisterSession, 0x0004_0171)).encode(&mut out);
    assert_eq!(out, common::frame("omron_nx.unregister_session_request"));
}

#[test]
fn reading_a_tag_is_the_documents_bytes() {
    assert_eq!(frame(read("TAG1"), 0x0027_0170), common::frame("omron_nx.read_tag_request"));
    assert_eq!(value(&common::message("omron_nx.read_tag_reply")), Value::Bool(false));
}

#[test]
fn writing_a_tag_is_the_documents_bytes() {
    let (name, kind): (TagName, Type) = ("TAG1".parse().unwrap(), "BOOL".parse().unwrap());
    let data = kind.encode(Dialect::Omron, &kind.parse_value("FALSE").unwrap()).unwrap();
    let write = request::write(name.path(), kind.head(Dialect::Omron).unwrap(), 1, &data).unwrap();
    assert_eq!(frame(write, 0x0014_0171), common::frame("omron_nx.write_tag_request"));
    let reply = common::message("omron_nx.write_tag_reply");
    assert!(MessageRouterReply::decode(&reply).unwrap().data.is_empty());
}

#[test]
fn two_tags_in_one_packet_are_the_documents_bytes() {
    let parts = [read("TAG1").bytes(), read("TAG2").bytes()];
    let packet = MultipleServicePacket::new(parts.iter().map(Vec::as_slice).collect()).unwrap();
    let ours = frame(packet.request().unwrap(), 0x0027_0170);
    let document = common::frame("omron_nx.read_two_tags_request");
    println!("TAG1 and TAG2 in one packet:\n  ours      {}\n  document  {}", hex(&ours), hex(&document));
    assert_eq!(ours, document);
    let reply = common::message("omron_nx.read_two_tags_reply");
    let reply = MessageRouterReply::decode(&reply).unwrap();
    let parts = MultipleServiceReply::decode(reply.data).unwrap();
    let values: Vec<_> = parts.parts().iter().map(|part| value(part)).collect();
    println!("  reply     TAG1 = {}, TAG2 = {}", values[0], values[1]);
    assert_eq!(values, [Value::Bool(true), Value::Bool(true)]);
}
