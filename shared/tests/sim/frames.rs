//! What a client writes, and what it makes of the answer.

use cipdeck_shared::engine::time::Instant;
use cipdeck_shared::sim::{Device, SimConnection};
use cipdeck_shared::wire::{
    Command, ConnectedMessage, ConnectionId, Encapsulation, EncapsulationStatus, Header, MessageRouterReply,
    RegisterSession, SendRrData, SenderContext, SessionHandle, UnconnectedMessage,
};
use hex_literal::hex;

pub(crate) const PRODUCT_NAME: [u8; 8] = hex!("0E 03 20 01 24 01 30 07");
pub(crate) const MOVING: [u8; 8] = hex!("0E 03 20 04 24 64 30 03");

pub(crate) fn at(millis: u64) -> Instant {
    Instant(millis * 1_000)
}

/// Status and data of the answer to a message router request.
pub(crate) fn ask(device: &mut Device, request: &[u8], now: Instant) -> (u8, Vec<u8>) {
    let bytes = device.answer(request, now);
    let reply = MessageRouterReply::decode(&bytes).unwrap();
    assert_eq!(reply.service.0, request.first().map_or(0, |service| service & 0x7F));
    (reply.status.0, reply.data.to_vec())
}

/// Everything a connection hands out by `now`.
pub(crate) fn sent(connection: &mut SimConnection, now: Instant) -> Vec<u8> {
    let mut out = Vec::new();
    connection.poll_transmit(&mut out, now);
    out
}

pub(crate) fn frame(command: Command, session: u32, context: u64, data: &[u8]) -> Vec<u8> {
    let header = Header::request(command, SessionHandle(session), SenderContext::from(context));
    let mut out = Vec::new();
    Encapsulation::new(header, data).unwrap().encode(&mut out);
    out
}

pub(crate) fn rr(session: u32, context: u64, request: &[u8]) -> Vec<u8> {
    let header = Header::request(Command::SendRRData, SessionHandle(session), SenderContext::from(context));
    let mut out = Vec::new();
    UnconnectedMessage::new(request).unwrap().encode(&header, 3, &mut out);
    out
}

pub(crate) fn status_of(bytes: &[u8]) -> (Command, EncapsulationStatus) {
    let header = Encapsulation::decode(bytes).unwrap().header;
    (header.command, header.status)
}

pub(crate) fn message_of(bytes: &[u8]) -> Vec<u8> {
    let frame = Encapsulation::decode(bytes).unwrap();
    SendRrData::decode(frame.data()).unwrap().unconnected().unwrap().data.to_vec()
}

/// A connection with a session; its handle.
pub(crate) fn registered(device: &mut Device) -> (SimConnection, u32) {
    let mut connection = SimConnection::new();
    let request = frame(Command::RegisterSession, 0, 0, &RegisterSession::CURRENT.bytes());
    connection.handle_input(device, &request, at(0));
    let reply = sent(&mut connection, at(0));
    assert_eq!(status_of(&reply), (Command::RegisterSession, EncapsulationStatus::Success));
    let session = Encapsulation::decode(&reply).unwrap().header.session;
    assert_ne!(session, SessionHandle(0));
    (connection, session.0)
}

/// Status, additional words and data of the answer to an unconnected request.
pub(crate) fn refusal(device: &mut Device, request: &[u8], now: Instant) -> (u8, Vec<u16>, Vec<u8>) {
    let bytes = device.answer(request, now);
    let reply = MessageRouterReply::decode(&bytes).unwrap();
    (reply.status.0, reply.additional.words().collect(), reply.data.to_vec())
}

/// A connected request.
pub(crate) fn ud(session: u32, id: u32, sequence: u16, request: &[u8]) -> Vec<u8> {
    let header = Header::request(Command::SendUnitData, SessionHandle(session), SenderContext::from(5));
    let mut out = Vec::new();
    ConnectedMessage::new(request).unwrap().encode(&header, ConnectionId(id), sequence, &mut out);
    out
}

/// Connection id, sequence count and message of a connected reply.
pub(crate) fn connected_of(bytes: &[u8]) -> (u32, u16, Vec<u8>) {
    let frame = Encapsulation::decode(bytes).unwrap();
    assert_eq!((frame.header.command, frame.header.status.0), (Command::SendUnitData, 0));
    let item = SendRrData::decode(frame.data()).unwrap().connected().unwrap();
    (item.id.0, item.sequence, item.message.to_vec())
}

/// What a request on a connection gives at once.
pub(crate) fn exchange(
    device: &mut Device,
    connection: &mut SimConnection,
    request: &[u8],
    now: Instant,
) -> Vec<u8> {
    connection.handle_input(device, request, now);
    sent(connection, now)
}
