//! Between permission, write and answer: what comes too late, too early, twice, or from somebody else.

use cipdeck_shared::config::BlockId;
use cipdeck_shared::engine::{CauseKind, Phase};
use cipdeck_shared::wire::{
    Command, Encapsulation, Header, RegisterSession, SendRrData, SenderContext, SessionHandle,
};

#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

use crate::owner::{Owner, encapsulation};

const A: BlockId = BlockId(1);
const B: BlockId = BlockId(2);

#[test]
fn a_message_that_is_cancelled_between_permission_and_write_is_not_written() {
    let mut owner = Owner::with_blocks(&[(A, "4,10.0.0.1")]);
    owner.run(A).unwrap();
    let link = owner.register();
    owner.reply(link, &[1]);
    owner.writes = false;
    owner.run(A).unwrap();
    owner.cancel(A);
    assert_eq!((owner.ids(A), owner.cause(A)), ((217, 0, 10), CauseKind::Cancelled));
    assert!(!owner.view(A).cause.unwrap().may_have_acted);
    owner.write(link);
    assert_eq!(owner.requests_written(), 1);
    owner.writes = true;
    owner.run(A).unwrap();
    owner.reply(link, &[2]);
    assert_eq!(owner.view(A).res_data, [2], "the session is as good as before");
}

#[test]
fn who_is_cancelled_while_permission_is_asked_does_not_stop_the_next_one() {
    let mut owner = Owner::with_blocks(&[(A, "4,10.0.0.1"), (B, "4,10.0.0.1")]);
    owner.answers = false;
    owner.run(A).unwrap();
    owner.run(B).unwrap();
    owner.register();
    owner.cancel(A);
    assert_eq!(owner.wants.iter().map(|wants| wants.block).collect::<Vec<_>>(), [A, B]);
}

#[test]
fn a_permission_is_for_one_shot() {
    let mut owner = Owner::with_blocks(&[(A, "4,10.0.0.1")]);
    owner.run(A).unwrap();
    let link = owner.register();
    owner.reply(link, &[1]);
    owner.answers = false;
    owner.run(A).unwrap();
    owner.cancel(A);
    owner.run(A).unwrap();
    let (former, now) = (owner.wants[1], owner.wants[2]);
    owner.permit(&former);
    assert_eq!(owner.requests_written(), 1, "the message that was permitted has ended");
    owner.permit(&now);
    assert_eq!(owner.requests_written(), 2);
}

#[test]
fn permission_is_asked_for_the_revision_that_is_sent() {
    let mut owner = Owner::with_blocks(&[(A, "4,10.0.0.1")]);
    owner.revision = 2;
    owner.put(A, "4,10.0.0.1", |config| config.app_cfg.attribute = 1);
    owner.run(A).unwrap();
    owner.revision = 3;
    owner.put(A, "4,10.0.0.1", |config| config.app_cfg.attribute = 2);
    let link = owner.register();
    owner.reply(link, &[1]);
    owner.run(A).unwrap();
    assert_eq!(owner.wants.iter().map(|wants| wants.revision).collect::<Vec<_>>(), [2, 3]);
}

#[test]
fn a_message_that_was_permitted_but_not_written_survives_the_connection() {
    let mut owner = Owner::with_blocks(&[(A, "4,10.0.0.1")]);
    owner.run(A).unwrap();
    let link = owner.register();
    owner.reply(link, &[1]);
    owner.writes = false;
    owner.run(A).unwrap();
    owner.writes = true;
    owner.closed(link);
    let link = owner.register();
    assert_eq!(owner.wants.len(), 3, "it is asked for again");
    owner.reply(link, &[2]);
    assert_eq!((owner.view(A).res_data, owner.requests_written()), (vec![2], 2));
}

#[test]
fn a_reply_that_comes_twice_answers_once() {
    let mut owner = Owner::with_blocks(&[(A, "4,10.0.0.1"), (B, "4,10.0.0.1")]);
    owner.run(A).unwrap();
    let link = owner.register();
    let reply = owner.reply_frame(link, b"once");
    owner.input(link, &reply);
    owner.writes = false;
    owner.run(B).unwrap();
    owner.input(link, &reply);
    assert_eq!(owner.engine.dropped_frames(&owner.open[0].1), 1);
    owner.write(link);
    assert_eq!(owner.view(B).phase, Phase::Sent);
    owner.reply(link, b"mine");
    assert_eq!(owner.view(B).res_data, b"mine");
}

#[test]
fn only_the_reply_of_its_own_kind_answers() {
    let mut owner = Owner::with_blocks(&[(A, "4,10.0.0.1")]);
    owner.run(A).unwrap();
    let link = owner.register();
    let mut other = owner.reply_frame(link, b"no");
    other[0] = 0x70;
    owner.input(link, &other);
    assert_eq!(owner.view(A).phase, Phase::Sent);
    owner.reply(link, b"yes");
    assert_eq!(owner.view(A).res_data, b"yes");
}

#[test]
fn a_session_is_registered_by_the_answer_to_its_own_request_only() {
    let mut owner = Owner::with_blocks(&[(A, "4,10.0.0.1")]);
    owner.run(A).unwrap();
    let link = owner.link();
    owner.connected(link);
    let asked = owner.last_header(link, Command::RegisterSession);
    let foreign = Header { session: SessionHandle(9), context: SenderContext([9; 8]), ..asked };
    owner.input(link, &encapsulation(foreign, &RegisterSession::CURRENT.bytes()));
    assert_eq!((owner.view(A).phase, owner.wants.len()), (Phase::Connecting, 0));
    owner.answer_register(link);
    assert_eq!(owner.last_header(link, Command::SendRRData).session, SessionHandle(7));
}

#[test]
fn a_session_without_a_handle_is_none() {
    let mut owner = Owner::with_blocks(&[(A, "4,10.0.0.1")]);
    owner.run(A).unwrap();
    let link = owner.link();
    owner.connected(link);
    let header = owner.last_header(link, Command::RegisterSession);
    owner.input(link, &encapsulation(header, &RegisterSession::CURRENT.bytes()));
    assert_eq!((owner.ids(A), owner.cause(A)), ((69, 65, 10), CauseKind::Malformed));
    assert_eq!(owner.view(A).cause.unwrap().byte, Some(4));
}

#[test]
fn the_target_is_told_how_long_we_wait_and_never_zero() {
    for (timeout, seconds) in [(250, 1), (1_000, 1), (1_001, 2), (0, 3)] {
        let mut owner = Owner::new();
        owner.put(A, "4,10.0.0.1", |config| config.target_cfg.ucmm_timeout = timeout);
        owner.run(A).unwrap();
        owner.register();
        let frame = Encapsulation::decode(&owner.written.last().unwrap().1).unwrap();
        assert_eq!(SendRrData::decode(frame.data()).unwrap().timeout, seconds, "{timeout} ms");
    }
}
