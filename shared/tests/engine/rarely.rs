//! What happens rarely in a plant: odd moments, odd targets, changes while something runs.

use cipdeck_shared::config::{BlockId, Channel};
use cipdeck_shared::engine::{CauseKind, Event, Phase};
use cipdeck_shared::wire::{
    Command, Header, MessageRouterReply, SenderContext, ServiceCode, SessionHandle, UnconnectedMessage,
};

#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

use crate::owner::Owner;

const A: BlockId = BlockId(1);
const B: BlockId = BlockId(2);
const SECOND: u64 = 1_000_000;

#[test]
fn a_reply_that_comes_before_its_request_is_none() {
    let mut owner = Owner::with_blocks(&[(A, "4,10.0.0.1")]);
    owner.run(A).unwrap();
    let link = owner.register();
    owner.reply(link, &[1]);
    let used = owner.last_header(link, Command::SendRRData).context;
    let next = SenderContext::from(u64::from_le_bytes(used.0) + 1);
    let mut message = Vec::new();
    MessageRouterReply::success(ServiceCode::GetAttributeSingle, b"guess").encode(&mut message);
    let mut guess = Vec::new();
    let header = Header::request(Command::SendRRData, SessionHandle(7), next);
    UnconnectedMessage::new(&message).unwrap().encode(&header, 0, &mut guess);

    owner.engine.run(A, owner.now).unwrap();
    while let Some(event) = owner.engine.poll_event() {
        if let Event::Wants(wants) = event {
            owner.engine.permit(&wants, true, owner.now);
            owner.engine.handle_input(link, &guess, owner.now);
        }
    }
    let mut written = Vec::new();
    assert!(owner.engine.poll_transmit(link, &mut written, owner.now));
    owner.pump();
    owner.written.push((link, written));
    assert_eq!(owner.last_header(link, Command::SendRRData).context, next, "the guess was right");
    assert_eq!(owner.view(A).phase, Phase::Sent, "what was written counts as sent");
    owner.reply(link, b"true");
    assert_eq!(owner.view(A).res_data, b"true");
}

#[test]
fn a_message_behind_another_one_is_told_its_place() {
    let mut owner = Owner::with_blocks(&[(A, "4,10.0.0.1"), (B, "4,10.0.0.1")]);
    owner.run(A).unwrap();
    owner.register();
    owner.run(B).unwrap();
    assert_eq!((owner.told[&B].phase, owner.told[&B].position), (Phase::Buffered, 1));
    assert_eq!((owner.told[&A].phase, owner.told[&A].position), (Phase::Sent, 0));
}

#[test]
fn a_session_is_closed_when_the_last_message_to_a_former_target_ends() {
    let mut owner = Owner::with_blocks(&[(A, "4,10.0.0.1")]);
    owner.run(A).unwrap();
    let link = owner.register();
    owner.put(A, "4,10.0.0.2", |_| {});
    assert_eq!(owner.view(A).phase, Phase::Sent);
    owner.reply(link, &[1]);
    assert!(owner.view(A).q);
    owner.last_header(link, Command::UnRegisterSession);
}

#[test]
fn a_repaired_block_whose_in_is_true_begins_its_cycle() {
    let mut owner = Owner::new();
    owner.put(A, "6,1", |config| config.ctrl_cfg.trigger_type = 100);
    owner.set_in(A, true);
    assert_eq!(owner.cause(A), CauseKind::Invalid);
    owner.put(A, "4,10.0.0.1", |config| config.ctrl_cfg.trigger_type = 100);
    owner.pass(100_000);
    assert_eq!(owner.view(A).phase, Phase::Connecting);
}

#[test]
fn a_change_during_a_run_begins_no_cycle() {
    let mut owner = Owner::with_blocks(&[(A, "4,10.0.0.1")]);
    owner.run(A).unwrap();
    owner.put(A, "4,10.0.0.1", |config| config.ctrl_cfg.trigger_type = 100);
    let link = owner.register();
    owner.reply(link, &[1]);
    owner.pass(SECOND);
    assert_eq!((owner.view(A).runs, owner.view(A).phase), (1, Phase::Done));
}

#[test]
fn another_protocol_shows_in_its_first_two_bytes_and_the_bytes_are_kept() {
    let mut owner = Owner::with_blocks(&[(A, "4,10.0.0.1")]);
    owner.run(A).unwrap();
    let link = owner.register();
    owner.input(link, b"E");
    assert_eq!(owner.view(A).phase, Phase::Sent);
    owner.input(link, b"RR\n");
    assert_eq!((owner.ids(A), owner.cause(A)), ((69, 65, 12), CauseKind::Malformed));
    let (_, _, exchange) = owner.finished.last().unwrap();
    assert_eq!(exchange.response_frame.as_deref(), Some(&b"ERR\n"[..]));
}

#[test]
fn a_thousand_messages_without_a_session_fail_one_after_the_other() {
    let mut owner = Owner::new();
    let busy = |n: u32| format!("4,10.0.0.{n}");
    for n in 1..=16 {
        owner.put(BlockId(n), &busy(n), |_| {});
        owner.put(BlockId(n + 100), &busy(n), |config| config.channel = Channel::Monitor);
        owner.run(BlockId(n)).unwrap();
        let link = owner.register();
        owner.reply(link, &[1]);
        owner.run(BlockId(n + 100)).unwrap();
    }
    for n in 1..=4 {
        owner.run(BlockId(n)).unwrap();
    }
    let waiting = 1_000..2_000;
    for n in waiting.clone() {
        owner.put(BlockId(n), "4,10.0.1.1", |_| {});
        owner.run(BlockId(n)).unwrap();
        assert_eq!(owner.told[&BlockId(n)].position, n as usize - 999);
    }
    owner.cancel(BlockId(1));
    for n in waiting {
        assert_eq!((owner.ids(BlockId(n)), owner.cause(BlockId(n))), ((209, 0, 10), CauseKind::Limit));
    }
}
