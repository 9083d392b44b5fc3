//! Targets that do not echo what they should: what is taken from them, and what never is.

use cipdeck_shared::config::BlockId;
use cipdeck_shared::engine::{CauseKind, LinkId, Phase, TargetState};
use cipdeck_shared::wire::{
    ConnectedMessage, ConnectionId, Header, MessageRouterReply, RegisterSession, SenderContext, ServiceCode,
    SessionHandle,
};

#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

use crate::owner::{Owner, encapsulation};
use crate::target::FIRST_O_T;

const A: BlockId = BlockId(1);
const B: BlockId = BlockId(2);
const PATH: &str = "4,10.0.0.1";

/// Answers RegisterSession without a context.
fn register_without_context(owner: &mut Owner) -> LinkId {
    let link = owner.link();
    owner.connected(link);
    let header =
        Header { session: SessionHandle(7), context: SenderContext([0; 8]), ..owner.last(link).header };
    owner.input(link, &encapsulation(header, &RegisterSession::CURRENT.bytes()));
    link
}

fn without_context(frame: &[u8]) -> Vec<u8> {
    let mut frame = frame.to_vec();
    frame.iter_mut().skip(12).take(8).for_each(|byte| *byte = 0);
    frame
}

fn reply(owner: &Owner, link: LinkId, data: &[u8]) -> Vec<u8> {
    owner.answer_frame(link, &MessageRouterReply::success(ServiceCode::GetAttributeSingle, data))
}

/// A connected reply with any id and sequence count.
fn connected(owner: &Owner, link: LinkId, id: u32, sequence: u16, data: &[u8]) -> Vec<u8> {
    let mut message = Vec::new();
    MessageRouterReply::success(ServiceCode::GetAttributeSingle, data).encode(&mut message);
    let mut frame = Vec::new();
    let header = owner.last(link).header;
    ConnectedMessage::new(&message).unwrap().encode(&header, ConnectionId(id), sequence, &mut frame);
    frame
}

#[test]
fn a_context_of_zeros_is_accepted_from_register_session_on_and_shown() {
    let mut owner = Owner::with_blocks(&[(A, PATH)]);
    owner.run(A).unwrap();
    let link = register_without_context(&mut owner);
    assert!(owner.target().no_context);
    let frame = without_context(&reply(&owner, link, b"value"));
    owner.input(link, &frame);
    assert_eq!(owner.view(A).res_data, b"value");
}

#[test]
fn from_such_a_target_any_other_context_is_dropped_its_own_echo_as_well() {
    let mut owner = Owner::with_blocks(&[(A, PATH)]);
    owner.run(A).unwrap();
    let link = register_without_context(&mut owner);
    let echoed = reply(&owner, link, b"echo");
    let mut foreign = echoed.clone();
    foreign[12] ^= 0x55;
    owner.input(link, &echoed);
    owner.input(link, &foreign);
    assert_eq!((owner.view(A).phase, owner.target().dropped), (Phase::Sent, 2));
}

#[test]
fn a_target_that_echoes_is_held_to_it() {
    let mut owner = Owner::with_blocks(&[(A, PATH)]);
    owner.run(A).unwrap();
    let link = owner.register();
    let frame = without_context(&reply(&owner, link, b"zeros"));
    owner.input(link, &frame);
    assert_eq!((owner.view(A).phase, owner.target().no_context), (Phase::Sent, false));
    owner.succeed(link, b"mine");
    assert_eq!(owner.view(A).res_data, b"mine");
}

#[test]
fn only_the_first_frame_of_a_socket_may_be_without_context() {
    let mut owner = Owner::with_blocks(&[(A, PATH)]);
    owner.run(A).unwrap();
    let link = owner.link();
    owner.connected(link);
    let header = owner.last(link).header;
    let other = Header { session: SessionHandle(9), context: SenderContext([9; 8]), ..header };
    owner.input(link, &encapsulation(other, &RegisterSession::CURRENT.bytes()));
    let zeros = Header { session: SessionHandle(9), context: SenderContext([0; 8]), ..header };
    owner.input(link, &encapsulation(zeros, &RegisterSession::CURRENT.bytes()));
    assert_eq!(owner.view(A).phase, Phase::Connecting);
    owner.answer_register(link);
    assert_eq!((owner.view(A).phase, owner.target().no_context), (Phase::Sent, false));
}

#[test]
fn without_contexts_a_stray_frame_while_nothing_is_outstanding_replaces_the_socket() {
    let mut owner = Owner::with_blocks(&[(A, PATH), (B, PATH)]);
    owner.run(A).unwrap();
    let link = register_without_context(&mut owner);
    let frame = without_context(&reply(&owner, link, b"once"));
    owner.input(link, &frame);
    owner.input(link, &frame);
    assert_eq!((owner.dropped.clone(), owner.target().state), (vec![link], TargetState::Closed));
    owner.run(B).unwrap();
    let link = register_without_context(&mut owner);
    let frame = without_context(&reply(&owner, link, b"right"));
    owner.input(link, &frame);
    assert_eq!(owner.view(B).res_data, b"right");
}

#[test]
fn without_contexts_a_stray_frame_while_permission_is_asked_does_not_lose_the_message() {
    let mut owner = Owner::with_blocks(&[(A, PATH)]);
    owner.run(A).unwrap();
    let link = register_without_context(&mut owner);
    let frame = without_context(&reply(&owner, link, b"once"));
    owner.input(link, &frame);
    owner.answers = false;
    owner.run(A).unwrap();
    owner.input(link, &frame);
    owner.answers = true;
    let link = register_without_context(&mut owner);
    let frame = without_context(&reply(&owner, link, b"right"));
    owner.input(link, &frame);
    assert_eq!(owner.view(A).res_data, b"right");
}

#[test]
fn after_any_timeout_the_socket_is_replaced() {
    for connection in [false, true] {
        let mut owner = Owner::new();
        owner.put_connected(A, PATH, |config| config.target_cfg.cip_conn_mode = connection.into());
        owner.run(A).unwrap();
        let old = register_without_context(&mut owner);
        if connection {
            let open = owner.last(old).open();
            let mut data = Vec::new();
            let answer = cipdeck_shared::wire::ForwardOpenReply {
                o_t_id: ConnectionId(FIRST_O_T),
                t_o_id: open.t_o_id,
                triad: open.triad,
                o_t_api_us: 1,
                t_o_api_us: 1,
            };
            answer.encode(&mut data);
            let frame =
                owner.answer_frame(old, &MessageRouterReply::success(ServiceCode::ForwardOpen, &data));
            owner.input(old, &without_context(&frame));
        }
        let late = without_context(&reply(&owner, old, b"late"));
        owner.pass(10_000_000);
        assert_eq!((owner.ids(A).1, owner.dropped.clone()), (115, vec![old]), "{connection}");
        owner.run(A).unwrap();
        owner.input(old, &late);
        assert_eq!(owner.view(A).phase, Phase::Connecting, "{connection}");
    }
}

#[test]
fn the_id_of_the_first_connected_reply_is_insisted_on() {
    for own in [false, true] {
        let mut owner = Owner::new();
        owner.put_connected(A, PATH, |_| {});
        owner.run(A).unwrap();
        let link = owner.register_and_open();
        let t_o = owner.t_o_of(ConnectionId(FIRST_O_T)).0;
        let (learned, other) = if own { (FIRST_O_T, t_o) } else { (t_o, FIRST_O_T) };
        let frame = connected(&owner, link, learned, 1, &[1]);
        owner.input(link, &frame);
        assert_eq!((owner.view(A).res_data, owner.target().own_connection_id), (vec![1], own));

        owner.run(A).unwrap();
        for id in [other, 0, learned ^ 1] {
            let frame = connected(&owner, link, id, 2, b"no");
            owner.input(link, &frame);
        }
        assert_eq!((owner.view(A).phase, owner.target().dropped), (Phase::Sent, 3), "{own}");
        let frame = connected(&owner, link, learned, 2, &[2]);
        owner.input(link, &frame);
        assert_eq!(owner.view(A).res_data, [2]);
    }
}

#[test]
fn another_sequence_count_or_session_answers_nothing_and_the_timeout_says_how_many() {
    let mut owner = Owner::new();
    owner.put_connected(A, PATH, |config| config.target_cfg.conn_msg_timeout = 1_000);
    owner.run(A).unwrap();
    let link = owner.register_and_open();
    let t_o = owner.t_o_of(ConnectionId(FIRST_O_T)).0;
    for sequence in [0, 2, 0xFFFF] {
        let frame = connected(&owner, link, t_o, sequence, b"no");
        owner.input(link, &frame);
    }
    let mut foreign = connected(&owner, link, t_o, 1, b"no");
    foreign[4] ^= 1;
    owner.input(link, &foreign);
    let frame = connected(&owner, link, 0xDEAD, 1, b"no");
    owner.input(link, &frame);
    owner.pass(1_000_000);
    assert_eq!((owner.ids(A), owner.cause(A)), ((55, 115, 12), CauseKind::Timeout));
    let detail = owner.view(A).cause.unwrap().detail.unwrap();
    assert!(detail.starts_with("5 replies came"), "{detail}");
    assert_eq!(owner.dropped, [link]);
}

#[test]
fn a_status_counts_for_a_connected_message_only_with_its_context() {
    let mut owner = Owner::new();
    owner.put_connected(A, PATH, |_| {});
    owner.run(A).unwrap();
    let link = owner.register_and_open();
    let mut header = owner.last(link).header.reply(cipdeck_shared::wire::EncapsulationStatus(8));
    header.context = SenderContext([9; 8]);
    owner.input(link, &encapsulation(header, &[]));
    assert_eq!(owner.view(A).phase, Phase::Sent);
    owner.answer_status(link, 8);
    assert_eq!(owner.view(A).cause.unwrap().status, Some(8));
}
