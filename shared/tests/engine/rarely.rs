//! What happens rarely in a plant: odd moments, odd targets, changes while something runs.

use cipdeck_shared::config::{BlockId, Channel};
use cipdeck_shared::engine::{CauseKind, Event, Phase};
use cipdeck_shared::wire::{
    Command, EncapsulationStatus, Header, MessageRouterReply, SenderContext, ServiceCode, SessionHandle,
    UnconnectedMessage,
};

#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

use crate::owner::{Owner, encapsulation};

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
            owner.engine.permit(&wants, Ok(()), owner.now);
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

#[test]
fn a_target_that_closes_instead_of_registering_is_not_tried_again_at_once() {
    let mut owner = Owner::with_blocks(&[(A, "4,10.0.0.1"), (B, "4,10.0.0.1")]);
    owner.run(A).unwrap();
    owner.run(B).unwrap();
    let link = owner.link();
    owner.connected(link);
    owner.closed(link);
    for block in [A, B] {
        assert_eq!((owner.ids(block), owner.cause(block)), ((55, 113, 10), CauseKind::Closed));
    }
    assert_eq!(owner.open, []);
}

#[test]
fn a_message_during_the_farewell_takes_a_new_connection_and_drops_the_old_one() {
    let mut owner = Owner::with_blocks(&[(A, "4,10.0.0.1")]);
    owner.run(A).unwrap();
    let old = owner.register();
    owner.reply(old, &[1]);
    owner.engine.stop(owner.now);
    owner.pump();
    owner.run(A).unwrap();
    assert!(owner.dropped.contains(&old));
    let new = owner.register();
    owner.pass(SECOND);
    owner.reply(new, &[2]);
    assert_eq!(owner.view(A).res_data, [2]);
}

#[test]
fn back_off_begins_anew_after_a_session() {
    let mut owner = Owner::new();
    owner.put(A, "4,10.0.0.1", |config| config.ctrl_cfg.trigger_type = 100);
    owner.put(B, "4,10.0.0.1", |config| config.ctrl_cfg.trigger_type = 100);
    owner.set_in(A, true);
    for wait in [250, 500, 1_000, 2_000] {
        let link = owner.link();
        owner.connect_failed(link);
        owner.pass(wait * 1_000);
    }
    let link = owner.link();
    owner.connect_failed(link);
    owner.set_in(B, true);
    let link = owner.register();
    owner.reply(link, &[1]);
    owner.pass(100_000);
    assert!(owner.engine.is_busy(A) && owner.engine.is_busy(B), "the target is there: nobody is held back");
    owner.reply(link, &[1]);
    owner.reply(link, &[1]);
    owner.set_in(A, false);
    owner.closed(link);
    owner.pass(100_000);
    let link = owner.link();
    owner.connect_failed(link);
    owner.pass(250_000);
    assert_eq!(owner.view(B).phase, Phase::Connecting, "a quarter of a second, as the first time");
}

#[test]
fn the_session_that_is_given_up_is_the_one_unused_for_longest() {
    let mut owner = Owner::new();
    let mut links = Vec::new();
    for n in 1..=16 {
        owner.put(BlockId(n), &format!("4,10.0.0.{n}"), |_| {});
        owner.pass(1_000);
        owner.run(BlockId(n)).unwrap();
        links.push(owner.register());
        owner.reply(links[links.len() - 1], &[1]);
    }
    owner.pass(1_000);
    owner.run(BlockId(1)).unwrap();
    owner.reply(links[0], &[1]);
    owner.put(BlockId(17), "4,10.0.0.17", |_| {});
    owner.run(BlockId(17)).unwrap();
    owner.last_header(links[1], Command::UnRegisterSession);
    assert_eq!(owner.view(BlockId(17)).phase, Phase::Connecting);
}

#[test]
fn as_fast_as_possible_is_the_next_millisecond_after_the_end() {
    let mut owner = Owner::new();
    owner.put(A, "4,10.0.0.1", |config| config.ctrl_cfg.trigger_type = 1);
    owner.set_in(A, true);
    let link = owner.register();
    for runs in 1..=3 {
        owner.pass(700);
        owner.reply(link, &[1]);
        owner.pass(999);
        assert_eq!((owner.view(A).phase, owner.view(A).runs), (Phase::Done, runs));
        owner.pass(1);
        assert_eq!(owner.view(A).phase, Phase::Sent);
    }
    owner.set_in(A, false);
    owner.reply(link, &[1]);
    owner.pass(SECOND);
    assert_eq!(owner.view(A).runs, 4);
}

#[test]
fn an_in_that_is_set_during_a_run_stays_true() {
    let mut owner = Owner::with_blocks(&[(A, "4,10.0.0.1")]);
    owner.run(A).unwrap();
    let link = owner.register();
    owner.set_in(A, true);
    owner.reply(link, &[1]);
    assert_eq!((owner.view(A).input, owner.ids(A).2), (true, 17));
}

#[test]
fn setting_an_in_that_is_true_does_not_move_the_period() {
    let mut owner = Owner::new();
    owner.put(A, "4,10.0.0.1", |config| config.ctrl_cfg.trigger_type = 100);
    owner.set_in(A, true);
    let link = owner.register();
    owner.reply(link, &[1]);
    owner.pass(60_000);
    owner.set_in(A, true);
    owner.pass(40_000);
    assert_eq!(owner.view(A).phase, Phase::Sent);
}

#[test]
fn a_type_that_becomes_fast_while_in_is_true_starts_at_once() {
    let mut owner = Owner::with_blocks(&[(A, "4,10.0.0.1")]);
    owner.set_in(A, true);
    let link = owner.register();
    owner.reply(link, &[1]);
    owner.put(A, "4,10.0.0.1", |config| config.ctrl_cfg.trigger_type = 1);
    owner.pass(1_000);
    assert_eq!(owner.view(A).phase, Phase::Sent);
}

#[test]
fn who_waits_for_a_buffer_is_told_when_it_moves_up() {
    let mut owner = Owner::new();
    for n in 1..=6 {
        owner.put(BlockId(n), &format!("4,10.0.0.{n}"), |_| {});
        owner.run(BlockId(n)).unwrap();
    }
    assert_eq!((owner.told[&BlockId(5)].position, owner.told[&BlockId(6)].position), (1, 2));
    owner.cancel(A);
    assert_eq!((owner.told[&BlockId(5)].phase, owner.told[&BlockId(6)].position), (Phase::Connecting, 1));
}

#[test]
fn a_refusal_has_its_reply_time_counted_from_the_last_write() {
    let mut owner = Owner::with_blocks(&[(A, "4,10.0.0.1")]);
    owner.run(A).unwrap();
    let link = owner.register();
    owner.pass(5_000);
    let unknown =
        owner.last_header(link, Command::SendRRData).reply(EncapsulationStatus::InvalidSessionHandle);
    owner.input(link, &encapsulation(unknown, &[]));
    let link = owner.register();
    owner.pass(400);
    let mut frame = owner.reply_frame(link, &[]);
    frame[42] = 5;
    owner.input(link, &frame);
    assert_eq!((owner.view(A).status.sub_error_id, owner.view(A).reply_us), (5, Some(400)));
    assert_eq!(owner.view(A).elapsed_us, Some(5_400));
}

#[test]
fn a_view_has_the_edges_of_its_last_message_only() {
    let mut owner = Owner::with_blocks(&[(A, "4,10.0.0.1")]);
    owner.run(A).unwrap();
    let link = owner.register();
    owner.reply(link, &[1]);
    owner.pass(SECOND);
    owner.run(A).unwrap();
    owner.pass(7);
    owner.reply(link, &[2]);
    let edges: Vec<_> = owner.view(A).edges.iter().map(|(at, bits)| (*at, bits.0)).collect();
    assert_eq!(edges, [(0, 1), (0, 3), (0, 5), (7, 17), (7, 16)]);
}
