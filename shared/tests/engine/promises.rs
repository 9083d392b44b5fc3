//! The engine against a scripted target: virtual time, no sockets.

use cipdeck_shared::config::{BlockId, Channel};
use cipdeck_shared::engine::{CauseKind, CommandError, Phase};
use cipdeck_shared::wire::{
    Command, Encapsulation, EncapsulationStatus, Header, SenderContext, SessionHandle,
};

#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

use crate::owner::{Owner, encapsulation};

const A: BlockId = BlockId(1);
const B: BlockId = BlockId(2);
const SECOND: u64 = 1_000_000;

#[test]
fn a_run_registers_sends_and_ends_with_done() {
    let mut owner = Owner::with_blocks(&[(A, "4,10.0.0.1")]);
    owner.run(A).unwrap();
    let link = owner.register();
    assert_eq!(owner.view(A).phase, Phase::Sent);
    owner.pass(390);
    owner.reply(link, b"\x04CHP1");
    assert_eq!(owner.bits[&A], [1, 3, 5, 17, 16], "EN; EW; ST; DN; and EN falls with the run's IN");
    let (_, view, exchange) = &owner.finished[0];
    assert_eq!((view.q, view.input, view.status.status_bits.0, view.runs), (true, true, 17, 1));
    assert_eq!((&view.res_data[..], view.reply_us), (&b"\x04CHP1"[..], Some(390)));
    assert_eq!(exchange.request[..], [0x0E, 3, 0x20, 1, 0x24, 1, 0x30, 7]);
    assert_eq!(exchange.response(), Some(&b"\x8E\0\0\0\x04CHP1"[..]));
    assert!(exchange.request_frame.is_some() && exchange.response_frame.is_some());
    assert!(!owner.view(A).input && owner.view(A).q);
}

#[test]
fn the_second_run_uses_the_session_that_is_there() {
    let mut owner = Owner::with_blocks(&[(A, "4,10.0.0.1")]);
    owner.run(A).unwrap();
    let link = owner.register();
    owner.reply(link, &[1]);
    owner.run(A).unwrap();
    assert_eq!((owner.written.len(), owner.view(A).phase), (3, Phase::Sent), "register, request, request");
    owner.reply(link, &[2]);
    assert_eq!(owner.finished[1].1.res_data, [2]);
    let contexts: Vec<_> =
        owner.written.iter().map(|(_, f)| Encapsulation::decode(f).unwrap().header.context).collect();
    assert!(contexts[0] != contexts[1] && contexts[1] != contexts[2], "every request has its own context");
}

#[test]
fn nothing_is_written_without_permission() {
    let mut owner = Owner::with_blocks(&[(A, "4,10.0.0.1")]);
    owner.allowed = false;
    owner.run(A).unwrap();
    owner.register();
    assert_eq!((owner.wants.len(), owner.requests_written()), (1, 0));
    assert_eq!((owner.cause(A), owner.view(A).status.error_id), (CauseKind::NotPermitted, 217));
}

#[test]
fn permission_is_asked_again_for_every_shot_of_a_cycle() {
    let mut owner = Owner::new();
    owner.put(A, "4,10.0.0.1", |config| config.ctrl_cfg.trigger_type = 100);
    owner.set_in(A, true);
    let link = owner.register();
    for _ in 0..3 {
        owner.reply(link, &[1]);
        owner.pass(100_000);
    }
    assert_eq!((owner.wants.len(), owner.requests_written()), (4, 4));
    owner.allowed = false;
    owner.reply(link, &[1]);
    owner.pass(100_000);
    assert_eq!((owner.requests_written(), owner.cause(A)), (4, CauseKind::NotPermitted));
}

#[test]
fn a_reply_with_a_foreign_context_or_session_is_dropped_and_the_socket_replaced() {
    let mut owner = Owner::with_blocks(&[(A, "4,10.0.0.1")]);
    owner.run(A).unwrap();
    let link = owner.register();
    let right = owner.reply_frame(link, &[1]);
    let mut wrong_context = right.clone();
    wrong_context[12] ^= 0xFF;
    let mut wrong_session = right;
    wrong_session[4] ^= 0xFF;
    owner.input(link, &wrong_context);
    owner.input(link, &wrong_session);
    assert_eq!(owner.view(A).phase, Phase::Sent, "the request waits for its timeout");
    let target = owner.open[0].1.clone();
    assert_eq!(owner.engine.dropped_frames(&target), 2);
    owner.pass(3 * SECOND);
    assert_eq!((owner.ids(A), owner.cause(A)), ((55, 115, 12), CauseKind::Timeout));
    assert!(owner.view(A).cause.unwrap().may_have_acted);
    assert_eq!(owner.dropped, [link]);
}

#[test]
fn a_late_reply_can_never_answer_the_next_request() {
    let mut owner = Owner::with_blocks(&[(A, "4,10.0.0.1"), (B, "4,10.0.0.1")]);
    owner.run(A).unwrap();
    let old = owner.register();
    let late = owner.reply_frame(old, b"late");
    owner.pass(3 * SECOND);
    owner.run(B).unwrap();
    let new = owner.register();
    assert_ne!(old, new);
    owner.input(old, &late);
    owner.input(new, &late);
    assert_eq!(owner.view(B).phase, Phase::Sent);
    owner.reply(new, b"right");
    assert_eq!(owner.finished.last().unwrap().1.res_data, b"right");
}

#[test]
fn a_request_is_written_once_whatever_happens_after() {
    let mut owner = Owner::with_blocks(&[(A, "4,10.0.0.1")]);
    owner.run(A).unwrap();
    let link = owner.register();
    owner.closed(link);
    assert_eq!((owner.ids(A), owner.cause(A)), ((55, 115, 12), CauseKind::Closed));
    owner.pass(20 * SECOND);
    assert_eq!((owner.requests_written(), owner.open.len()), (1, 0));
}

#[test]
fn an_unknown_session_is_registered_again_and_the_request_sent_once_more() {
    let mut owner = Owner::with_blocks(&[(A, "4,10.0.0.1")]);
    owner.run(A).unwrap();
    for attempt in 1..=2 {
        let link = owner.register();
        assert_eq!((owner.requests_written(), owner.wants.len()), (attempt, attempt));
        let header =
            owner.last_header(link, Command::SendRRData).reply(EncapsulationStatus::InvalidSessionHandle);
        owner.input(link, &encapsulation(header, &[]));
    }
    assert_eq!((owner.ids(A), owner.view(A).cause.unwrap().status), ((69, 65, 12), Some(0x64)));
    assert_eq!(owner.requests_written(), 2);
}

#[test]
fn an_encapsulation_status_is_named_and_the_session_stays() {
    let mut owner = Owner::with_blocks(&[(A, "4,10.0.0.1")]);
    owner.run(A).unwrap();
    let link = owner.register();
    let header = owner.last_header(link, Command::SendRRData).reply(EncapsulationStatus(8));
    owner.input(link, &encapsulation(header, &[]));
    assert_eq!((owner.ids(A), owner.view(A).cause.unwrap().status), ((69, 65, 12), Some(8)));
    assert_eq!(owner.dropped, []);
}

#[test]
fn garbage_is_malformed_at_once_at_its_byte() {
    type Spoil = fn(&mut Vec<u8>);
    let rows: [(&str, Spoil, usize); 4] = [
        ("another protocol", |f| *f = b"HTTP/1.1 400 Bad Request\r\n\r\n".to_vec(), 0),
        ("an impossible length", |f| f[2..4].copy_from_slice(&[0xFF, 0xFF]), 2),
        ("a reply of another service", |f| f[40] = 0x90, 40),
        ("an item over the end", |f| f[38] = 0xFF, 45),
    ];
    for (name, spoil, byte) in rows {
        let mut owner = Owner::with_blocks(&[(A, "4,10.0.0.1")]);
        owner.run(A).unwrap();
        let link = owner.register();
        let mut frame = owner.reply_frame(link, &[1]);
        spoil(&mut frame);
        owner.input(link, &frame);
        assert_eq!((owner.ids(A), owner.cause(A)), ((69, 65, 12), CauseKind::Malformed), "{name}");
        assert_eq!(owner.view(A).cause.unwrap().byte, Some(byte), "{name}");
        assert_eq!(owner.dropped, [link], "{name}: the socket is not used again");
    }
}

#[test]
fn a_refused_session_says_so_with_its_status() {
    let mut owner = Owner::with_blocks(&[(A, "4,10.0.0.1")]);
    owner.run(A).unwrap();
    let link = owner.link();
    owner.connected(link);
    let header =
        owner.last_header(link, Command::RegisterSession).reply(EncapsulationStatus::InsufficientMemory);
    owner.input(link, &encapsulation(header, &[]));
    assert_eq!((owner.ids(A), owner.cause(A)), ((55, 113, 10), CauseKind::SessionRefused));
    assert_eq!(owner.view(A).cause.unwrap().status, Some(2));
}

#[test]
fn time_runs_out_in_every_phase() {
    let mut owner = Owner::with_blocks(&[(A, "4,10.0.0.1")]);
    owner.put(B, "4,10.0.0.1", |config| config.target_cfg.ucmm_timeout = 1000);
    owner.run(A).unwrap();
    let link = owner.link();
    owner.pass(3 * SECOND);
    assert_eq!((owner.ids(A), owner.dropped.clone()), ((55, 113, 10), vec![link]), "the attempt is given up");
    owner.run(A).unwrap();
    owner.register();
    owner.run(B).unwrap();
    owner.pass(3 * SECOND);
    assert_eq!((owner.ids(A), owner.ids(B)), ((55, 115, 12), (55, 114, 10)));
    assert_eq!(owner.requests_written(), 1);
}

#[test]
fn one_message_at_a_time_per_target() {
    let mut owner = Owner::with_blocks(&[(A, "4,10.0.0.1"), (B, "4,10.0.0.1")]);
    owner.run(A).unwrap();
    owner.run(B).unwrap();
    let link = owner.register();
    assert_eq!(
        (owner.requests_written(), owner.view(B).phase, owner.view(B).position),
        (1, Phase::Buffered, 1)
    );
    owner.reply(link, &[1]);
    assert_eq!((owner.requests_written(), owner.view(B).phase), (2, Phase::Sent));
}

#[test]
fn four_dead_targets_stall_the_controller_but_not_the_monitor() {
    let mut owner = Owner::new();
    for n in 1..=4 {
        owner.put(BlockId(n), &format!("4,10.0.0.{n}"), |_| {});
    }
    owner.put(BlockId(5), "4,10.0.0.5", |_| {});
    owner.put(BlockId(6), "4,10.0.0.6", |config| config.channel = Channel::Monitor);
    for n in 1..=6 {
        owner.run(BlockId(n)).unwrap();
    }
    let stalled = owner.view(BlockId(5));
    assert_eq!((stalled.phase, stalled.position, stalled.status.status_bits.0), (Phase::Waiting, 1, 1));
    assert_eq!(owner.view(BlockId(6)).phase, Phase::Connecting);
    owner.put(BlockId(7), "4,10.0.0.7", |config| {
        config.channel = "controller2".to_owned().try_into().unwrap();
    });
    owner.run(BlockId(7)).unwrap();
    assert_eq!(owner.view(BlockId(7)).phase, Phase::Connecting, "a channel has buffers of its own");
    let first = owner.open[0].0;
    owner.connect_failed(first);
    assert_eq!(owner.view(BlockId(5)).phase, Phase::Connecting, "the freed buffer goes to who waits");
    for n in 1..=4 {
        owner.run(BlockId(n)).ok();
    }
    owner.pass(3 * SECOND);
    assert_eq!(owner.ids(BlockId(1)), (55, 112, 8), "waited for a buffer until its time ran out");
}

#[test]
fn a_connect_failure_is_told_to_everybody_who_waits_for_that_target() {
    let mut owner = Owner::with_blocks(&[(A, "4,10.0.0.1"), (B, "4,10.0.0.1")]);
    owner.run(A).unwrap();
    owner.run(B).unwrap();
    let link = owner.link();
    owner.connect_failed(link);
    for block in [A, B] {
        assert_eq!((owner.ids(block), owner.cause(block)), ((210, 0, 10), CauseKind::Refused));
    }
    assert_eq!(owner.view(A).cause.unwrap().detail.as_deref(), Some("connection refused"));
}

#[test]
fn cyclic_messages_back_off_up_to_five_seconds_and_a_run_always_tries() {
    let mut owner = Owner::new();
    owner.put(A, "4,10.0.0.1", |config| config.ctrl_cfg.trigger_type = 100);
    owner.put(B, "4,10.0.0.1", |_| {});
    owner.set_in(A, true);
    let mut times = Vec::new();
    while times.len() < 9 {
        if let Some((link, _)) = owner.open.first().cloned() {
            times.push(owner.now.0 / 1000);
            owner.connect_failed(link);
        }
        owner.pass(1_000);
    }
    let gaps: Vec<_> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
    assert_eq!(gaps, [250, 500, 1000, 2000, 4000, 5000, 5000, 5000]);
    owner.run(B).unwrap();
    assert_eq!(owner.open.len(), 1, "a run does not wait");
    owner.register();
    assert_eq!(owner.view(B).phase, Phase::Sent);
}

#[test]
fn a_cyclic_block_recovers_by_itself_when_the_target_is_back() {
    let mut owner = Owner::new();
    owner.put(A, "4,10.0.0.1", |config| config.ctrl_cfg.trigger_type = 100);
    owner.set_in(A, true);
    let link = owner.register();
    owner.reply(link, &[1]);
    owner.pass(100_000);
    owner.closed(link);
    assert_eq!(owner.view(A).phase, Phase::Failed, "red at once");
    owner.pass(100_000);
    let link = owner.link();
    owner.connect_failed(link);
    owner.pass(300_000);
    let link = owner.register();
    owner.reply(link, &[2]);
    assert_eq!((owner.view(A).phase, owner.view(A).runs), (Phase::Done, 4));
}

#[test]
fn a_session_that_was_closed_while_idle_is_made_again_unseen() {
    let mut owner = Owner::with_blocks(&[(A, "4,10.0.0.1")]);
    owner.run(A).unwrap();
    let link = owner.register();
    owner.reply(link, &[1]);
    owner.closed(link);
    owner.run(A).unwrap();
    let link = owner.register();
    owner.reply(link, &[2]);
    assert_eq!((owner.finished.len(), owner.view(A).q), (2, true));
}

#[test]
fn cancel_works_in_every_phase_and_says_what_may_have_happened() {
    let mut owner = Owner::with_blocks(&[(A, "4,10.0.0.1")]);
    owner.cancel(A);
    assert_eq!(owner.view(A).phase, Phase::Idle);
    owner.run(A).unwrap();
    owner.cancel(A);
    assert_eq!((owner.ids(A), owner.dropped.len()), ((217, 0, 10), 1));
    assert!(!owner.view(A).cause.unwrap().may_have_acted);
    owner.run(A).unwrap();
    let link = owner.register();
    owner.cancel(A);
    assert_eq!((owner.ids(A), owner.dropped.contains(&link)), ((217, 0, 12), true));
    assert!(owner.view(A).cause.unwrap().may_have_acted);
}

#[test]
fn a_run_is_refused_while_busy_or_while_in_is_true() {
    let mut owner = Owner::with_blocks(&[(A, "4,10.0.0.1")]);
    owner.run(A).unwrap();
    assert_eq!(owner.run(A), Err(CommandError::Busy));
    let link = owner.register();
    owner.reply(link, &[1]);
    owner.set_in(A, true);
    owner.reply(link, &[1]);
    assert_eq!((owner.run(A), owner.ids(A)), (Err(CommandError::Busy), (0, 0, 17)));
    assert_eq!(owner.run(B), Err(CommandError::UnknownBlock));
}

#[test]
fn in_that_falls_early_lets_the_message_end() {
    let mut owner = Owner::with_blocks(&[(A, "4,10.0.0.1")]);
    owner.set_in(A, true);
    let link = owner.register();
    owner.set_in(A, false);
    owner.reply(link, &[1]);
    assert_eq!(owner.bits[&A], [1, 3, 5, 16]);
}

#[test]
fn a_change_acts_at_the_next_trigger() {
    let mut owner = Owner::with_blocks(&[(A, "4,10.0.0.1")]);
    owner.run(A).unwrap();
    owner.put(A, "4,10.0.0.1", |config| config.app_cfg.attribute = 1);
    let link = owner.register();
    assert_eq!(owner.last_request(link).bytes().last(), Some(&7));
    owner.reply(link, &[1]);
    owner.run(A).unwrap();
    assert_eq!(owner.last_request(link).bytes().last(), Some(&1));
}

#[test]
fn removing_a_busy_block_cancels_it_and_closes_the_session_nobody_needs() {
    let mut owner = Owner::with_blocks(&[(A, "4,10.0.0.1"), (B, "4,10.0.0.2")]);
    owner.run(A).unwrap();
    let link = owner.register();
    owner.reply(link, &[1]);
    owner.engine.remove(A, owner.now);
    owner.pump();
    owner.last_header(link, Command::UnRegisterSession);
    owner.run(B).unwrap();
    owner.engine.remove(B, owner.now);
    owner.pump();
    assert_eq!(owner.finished.last().unwrap().1.status.error_id, 217);
    assert!(owner.engine.view(B).is_none());
}

#[test]
fn an_invalid_stored_block_fails_with_the_sub_code_of_its_finding() {
    let mut owner = Owner::new();
    owner.put(A, "6,1", |_| {});
    owner.run(A).unwrap();
    assert_eq!((owner.ids(A), owner.cause(A)), ((33, 32, 8), CauseKind::Invalid));
    assert_eq!(owner.open, []);
}

#[test]
fn stop_says_goodbye_to_every_session() {
    let mut owner = Owner::with_blocks(&[(A, "4,10.0.0.1"), (B, "4,10.0.0.2")]);
    owner.run(A).unwrap();
    let link = owner.register();
    owner.reply(link, &[1]);
    owner.run(B).unwrap();
    owner.engine.stop(owner.now);
    owner.pump();
    owner.last_header(link, Command::UnRegisterSession);
    assert_eq!(owner.ids(B).0, 217);
    owner.closed(link);
    assert!(owner.engine.is_quiet());
}

#[test]
fn a_target_that_does_not_close_after_goodbye_is_dropped() {
    let mut owner = Owner::with_blocks(&[(A, "4,10.0.0.1")]);
    owner.run(A).unwrap();
    let link = owner.register();
    owner.reply(link, &[1]);
    owner.engine.stop(owner.now);
    owner.pump();
    assert!(!owner.engine.is_quiet());
    owner.pass(SECOND);
    assert!(owner.engine.is_quiet() && owner.dropped.contains(&link));
}

#[test]
fn the_seventeenth_session_of_the_controller_takes_the_place_of_the_oldest_idle_one() {
    let mut owner = Owner::new();
    let mut links = Vec::new();
    for n in 1..=17 {
        owner.put(BlockId(n), &format!("4,10.0.0.{n}"), |_| {});
        owner.pass(1_000);
        owner.run(BlockId(n)).unwrap();
        let link = owner.register();
        links.push(link);
        owner.reply(link, &[1]);
    }
    assert_eq!(owner.finished.len(), 17);
    owner.last_header(links[0], Command::UnRegisterSession);
    assert_eq!(owner.view(BlockId(17)).phase, Phase::Done);
}

#[test]
fn bytes_one_by_one_are_the_same_reply() {
    let mut owner = Owner::with_blocks(&[(A, "4,10.0.0.1")]);
    owner.run(A).unwrap();
    let link = owner.register();
    for byte in owner.reply_frame(link, b"slow") {
        owner.input(link, &[byte]);
    }
    assert_eq!(owner.finished[0].1.res_data, b"slow");
}

#[test]
fn a_frame_that_nobody_asked_for_changes_nothing() {
    let mut owner = Owner::with_blocks(&[(A, "4,10.0.0.1")]);
    owner.run(A).unwrap();
    let link = owner.register();
    let nop = Header::request(Command::Nop, SessionHandle(7), SenderContext::default());
    owner.input(link, &encapsulation(nop, &[1, 2, 3]));
    owner.reply(link, &[1]);
    assert!(owner.view(A).q);
}

#[test]
fn a_value_names_the_request_that_it_answers_although_the_block_was_changed_meanwhile() {
    let mut owner = Owner::with_blocks(&[(A, "4,10.0.0.1")]);
    owner.run(A).unwrap();
    let link = owner.register();
    owner.put(A, "4,10.0.0.1", |config| config.app_cfg.attribute = 1);
    owner.reply(link, b"\x04CHP1");
    assert_eq!(owner.finished[0].1.request.last(), Some(&7));
    assert_eq!(owner.view(A).request.last(), Some(&7), "the name, not the vendor id");
    owner.run(A).unwrap();
    assert_eq!(owner.view(A).request.last(), Some(&1));
}
