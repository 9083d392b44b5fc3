//! Connections as document 2080-RM001D p. 182 and 195 has them, row by row.

use cipdeck_shared::config::{BlockId, Profile};
use cipdeck_shared::engine::{CauseKind, Phase, TargetState};
use cipdeck_shared::wire::{Command, ConnectionId};

#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

use crate::owner::Owner;
use crate::target::FIRST_O_T;

const A: BlockId = BlockId(1);
const B: BlockId = BlockId(2);
const C: BlockId = BlockId(3);
const PATH: &str = "4,10.0.0.1";
const SECOND: u64 = 1_000_000;

/// One connected block that has run once, and what was written until then.
fn after_one_run(change: impl FnOnce(&mut cipdeck_shared::config::MsgCipGeneric)) -> Owner {
    let mut owner = Owner::new();
    owner.put_connected(A, PATH, change);
    owner.run(A).unwrap();
    let link = owner.register_and_open();
    owner.succeed(link, &[1]);
    owner
}

#[test]
fn a_missing_session_is_made_first_then_the_connection_then_the_message_is_sent() {
    let mut owner = Owner::new();
    owner.put_connected(A, PATH, |_| {});
    owner.run(A).unwrap();
    let link = owner.register();
    assert_eq!(owner.trace(), ["register", "open"]);
    assert_eq!((owner.view(A).phase, owner.view(A).status.status_bits.0), (Phase::Connecting, 3));
    assert!(owner.wants.is_empty(), "opening a connection is not sending the message");
    assert_eq!(owner.wants_to_open.len(), 1);
    owner.accept_open(link);
    assert_eq!(owner.trace(), ["register", "open", "connected"]);
    assert_eq!(owner.last(link).address, Some((ConnectionId(FIRST_O_T), 1)));
    owner.succeed(link, b"\x04CHP1");
    assert_eq!(owner.bits[&A], [1, 3, 5, 17, 16]);
    assert_eq!(owner.view(A).res_data, b"\x04CHP1");
}

#[test]
fn for_a_message_that_may_not_be_sent_no_connection_is_opened_and_nobody_is_asked() {
    for profile in [Profile::Auto, Profile::Generic] {
        let mut owner = Owner::new();
        owner.allowed = false;
        owner.put_connected(A, "4,10.0.0.1,1,0", |config| config.profile = profile);
        owner.run(A).unwrap();
        owner.register();
        assert_eq!(owner.trace(), ["register"], "{profile:?}");
        assert_eq!((owner.wants.len(), owner.wants_to_open.len()), (0, 1));
        let cause = owner.view(A).cause.unwrap();
        assert_eq!((owner.view(A).phase, cause.what), (Phase::Failed, CauseKind::NotPermitted));
    }
}

#[test]
fn an_open_connection_is_used_again_and_every_request_has_its_own_sequence_count() {
    let mut owner = after_one_run(|_| {});
    let link = owner.link();
    for sequence in 2..=5 {
        owner.run(A).unwrap();
        assert_eq!(owner.last(link).address, Some((ConnectionId(FIRST_O_T), sequence)));
        owner.succeed(link, &[1]);
    }
    assert_eq!(owner.trace_since(3), ["connected"; 4]);
    assert_eq!(owner.target().connections[0].requests, 5);
}

#[test]
fn the_sequence_count_skips_zero_after_its_end() {
    let mut owner = after_one_run(|_| {});
    let link = owner.link();
    let mut seen = Vec::new();
    for _ in 0..65_537 {
        owner.run(A).unwrap();
        seen.push(owner.last(link).address.unwrap().1);
        owner.succeed(link, &[1]);
        owner.written.drain(3..);
        owner.finished.clear();
    }
    assert_eq!((seen[65_533], seen[65_534], seen[65_535]), (65_535, 1, 2));
    assert!(!seen.contains(&0));
}

#[test]
fn messages_to_one_target_and_route_share_a_connection_and_other_routes_have_their_own() {
    let mut owner = Owner::new();
    for (block, path) in [(A, "4,10.0.0.1,1,0"), (B, "4,10.0.0.1,1,0"), (C, "4,10.0.0.1,1,2")] {
        owner.put_connected(block, path, |_| {});
        owner.run(block).unwrap();
    }
    let link = owner.register_and_open();
    owner.succeed(link, &[1]);
    owner.succeed(link, &[2]);
    owner.accept_open(link);
    owner.succeed(link, &[3]);
    assert_eq!(owner.trace(), ["register", "open", "connected", "connected", "open", "connected"]);
    let values: Vec<_> = owner.finished.iter().map(|(block, view, _)| (*block, view.res_data[0])).collect();
    assert_eq!(values, [(A, 1), (B, 2), (C, 3)]);
    assert_eq!(owner.target().connections.len(), 2);
}

#[test]
fn conn_close_with_one_user_closes_connection_and_session_and_says_so() {
    let mut owner = after_one_run(|config| config.target_cfg.conn_close = true);
    let link = owner.link();
    assert_eq!(owner.finished[0].1.status.status_bits.0, 17 + 32 + 64, "DN, CIPCONN, EIPSESS");
    assert_eq!(owner.trace_since(3), ["close"]);
    owner.succeed(link, &[]);
    assert_eq!(owner.trace_since(3), ["close", "unregister"]);
    owner.closed(link);
    owner.run(A).unwrap();
    assert_eq!(owner.view(A).status.status_bits.0, 3, "cleared by the next trigger");
}

#[test]
fn conn_close_with_several_users_closes_when_the_last_one_completes() {
    let mut owner = Owner::new();
    owner.put_connected(A, PATH, |config| config.target_cfg.conn_close = true);
    owner.put_connected(B, PATH, |_| {});
    owner.run(A).unwrap();
    owner.run(B).unwrap();
    let link = owner.register_and_open();
    owner.succeed(link, &[1]);
    assert_eq!(owner.finished[0].1.status.status_bits.0, 17, "another one still uses it");
    owner.succeed(link, &[2]);
    assert_eq!(owner.finished[1].1.status.status_bits.0, 17 + 32 + 64);
    owner.succeed(link, &[]);
    assert_eq!(owner.trace_since(2), ["connected", "connected", "close", "unregister"]);
}

#[test]
fn a_session_with_another_connection_outlives_the_first_one_closed() {
    let mut owner = Owner::new();
    for (block, path) in [(A, "4,10.0.0.1,1,0"), (B, "4,10.0.0.1,1,2")] {
        owner.put_connected(block, path, |config| config.target_cfg.conn_close = block == B);
        owner.run(block).unwrap();
    }
    let link = owner.register_and_open();
    owner.succeed(link, &[1]);
    owner.accept_open(link);
    owner.succeed(link, &[2]);
    assert_eq!(owner.finished[1].1.status.status_bits.0, 17 + 32, "CIPCONN without EIPSESS");
    owner.succeed(link, &[]);
    assert!(owner.target_is(TargetState::Open));
    owner.put_connected(A, "4,10.0.0.1,1,0", |config| config.target_cfg.conn_close = true);
    owner.run(A).unwrap();
    owner.succeed(link, &[3]);
    assert_eq!(owner.finished[2].1.status.status_bits.0, 17 + 32 + 64, "with the last one the session ends");
    owner.succeed(link, &[]);
    assert_eq!(owner.trace().last(), Some(&"unregister"));
}

#[test]
fn a_refused_message_closes_its_connection_as_well() {
    let mut owner = Owner::new();
    owner.put_connected(A, PATH, |config| config.target_cfg.conn_close = true);
    owner.run(A).unwrap();
    let link = owner.register_and_open();
    owner.refuse(link, 5, &[], &[]);
    assert_eq!(owner.finished[0].1.status.status_bits.0, 13 + 32 + 64);
    assert_eq!(owner.trace_since(3), ["close"]);
}

#[test]
fn a_message_that_ends_with_an_encapsulation_status_closes_its_connection_as_well() {
    let mut owner = Owner::new();
    owner.put_connected(A, PATH, |config| config.target_cfg.conn_close = true);
    owner.run(A).unwrap();
    let link = owner.register_and_open();
    owner.answer_status(link, 8);
    assert_eq!((owner.ids(A), owner.cause(A)), ((69, 65, 12 + 32 + 64), CauseKind::EncapsulationStatus));
    assert_eq!(owner.trace_since(3), ["close"]);
}

#[test]
fn without_conn_close_nothing_is_closed_until_the_idle_time_is_over() {
    for (given, idle) in [(0, 10_000), (800, 800), (5_000, 5_000)] {
        let mut owner = after_one_run(|config| config.target_cfg.conn_msg_timeout = given);
        let link = owner.link();
        assert_eq!(owner.finished[0].1.status.status_bits.0, 17);
        owner.pass(idle * 1_000 - 1);
        assert_eq!(owner.trace_since(3), [""; 0], "{given}");
        owner.pass(1);
        assert_eq!(owner.trace_since(3), ["close"], "{given}");
        owner.succeed(link, &[]);
        assert_eq!(owner.trace_since(3), ["close", "unregister"], "with it the session");
        owner.closed(link);
        assert!(owner.engine.is_quiet());
    }
}

#[test]
fn a_use_starts_the_idle_time_anew() {
    let mut owner = after_one_run(|config| config.target_cfg.conn_msg_timeout = 1_000);
    let link = owner.link();
    for _ in 0..5 {
        owner.pass(999_999);
        owner.run(A).unwrap();
        owner.succeed(link, &[1]);
    }
    assert_eq!(owner.trace_since(3), ["connected"; 5]);
}

#[test]
fn of_two_connections_each_is_closed_after_its_own_time_and_the_session_after_the_last() {
    let mut owner = Owner::new();
    for (block, path, idle) in [(A, "4,10.0.0.1,1,0", 1_000), (B, "4,10.0.0.1,1,2", 5_000)] {
        owner.put_connected(block, path, |config| config.target_cfg.conn_msg_timeout = idle);
        owner.run(block).unwrap();
    }
    let link = owner.register_and_open();
    owner.succeed(link, &[1]);
    owner.accept_open(link);
    owner.succeed(link, &[2]);
    let frames = owner.written.len();
    owner.pass(SECOND);
    assert_eq!(owner.trace_since(frames), ["close"]);
    owner.succeed(link, &[]);
    owner.pass(4 * SECOND);
    assert_eq!(owner.trace_since(frames), ["close", "close"]);
    owner.succeed(link, &[]);
    assert_eq!(owner.trace_since(frames), ["close", "close", "unregister"]);
}

#[test]
fn a_session_that_is_used_without_connection_stays_when_a_connection_is_closed() {
    let mut owner = after_one_run(|config| config.target_cfg.conn_msg_timeout = 1_000);
    let link = owner.link();
    owner.put(B, PATH, |_| {});
    owner.pass(900_000);
    owner.run(B).unwrap();
    owner.succeed(link, &[2]);
    owner.pass(100_000);
    owner.succeed(link, &[]);
    assert_eq!(owner.trace_since(3), ["unconnected", "close"]);
    owner.pass(60 * SECOND);
    assert!(owner.target_is(TargetState::Open), "an unconnected session is kept");
}

#[test]
fn ucmm_timeout_covers_the_opening_and_conn_msg_timeout_the_reply() {
    let timeouts = |config: &mut cipdeck_shared::config::MsgCipGeneric| {
        (config.target_cfg.ucmm_timeout, config.target_cfg.conn_msg_timeout) = (1_000, 5_000);
    };
    let mut owner = Owner::new();
    owner.put_connected(A, PATH, timeouts);
    owner.run(A).unwrap();
    let link = owner.register();
    owner.pass(999_999);
    assert_eq!(owner.view(A).phase, Phase::Connecting);
    owner.pass(1);
    assert_eq!((owner.ids(A), owner.cause(A)), ((55, 113, 10), CauseKind::Timeout));
    assert_eq!(owner.dropped, [link], "its answer may still come");

    owner.run(A).unwrap();
    let link = owner.register();
    owner.refuse(link, 1, &[0x0107], &[]);
    owner.pass(900_000);
    owner.accept_open(link);
    owner.pass(4_999_999);
    assert_eq!(owner.view(A).phase, Phase::Sent, "UcmmTimeout is off while ConnMsgTimeout runs");
    owner.pass(1);
    assert_eq!((owner.ids(A), owner.cause(A)), ((55, 115, 12), CauseKind::Timeout));
    assert!(owner.view(A).cause.unwrap().may_have_acted);
    assert_eq!(owner.dropped.last(), Some(&link), "the connection is closed on expiry");
    assert_eq!(owner.target().connections, []);
}

#[test]
fn a_message_over_an_open_connection_has_ucmm_timeout_until_it_is_sent() {
    let mut owner = after_one_run(|config| config.target_cfg.ucmm_timeout = 1_000);
    owner.put(B, PATH, |config| config.target_cfg.ucmm_timeout = 10_000);
    owner.run(B).unwrap();
    owner.run(A).unwrap();
    owner.pass(SECOND);
    assert_eq!((owner.ids(A), owner.view(B).phase), ((55, 114, 10), Phase::Sent));
}

#[test]
fn a_device_that_closes_an_idle_connection_is_connected_again_unseen() {
    let mut owner = after_one_run(|_| {});
    let link = owner.link();
    owner.closed(link);
    assert_eq!((owner.target().connections.len(), owner.finished.len()), (0, 1));
    owner.run(A).unwrap();
    let link = owner.register_and_open();
    owner.succeed(link, &[2]);
    assert_eq!((owner.finished[1].1.q, &owner.finished[1].1.res_data[..]), (true, &[2][..]));
}

#[test]
fn a_permitted_message_that_was_not_written_yet_survives_the_connection() {
    let mut owner = after_one_run(|_| {});
    let link = owner.link();
    owner.writes = false;
    owner.run(A).unwrap();
    owner.writes = true;
    owner.closed(link);
    let link = owner.register_and_open();
    assert_eq!(owner.wants.len(), 3, "it is asked for again");
    owner.succeed(link, &[2]);
    assert_eq!(owner.view(A).res_data, [2]);
    assert_eq!(owner.trace().iter().filter(|word| **word == "connected").count(), 2);
}

#[test]
fn a_target_that_closes_on_a_written_request_ends_it_at_once_and_it_is_never_sent_again() {
    let mut owner = after_one_run(|_| {});
    let link = owner.link();
    owner.run(A).unwrap();
    owner.closed(link);
    assert_eq!((owner.ids(A), owner.cause(A)), ((55, 115, 12), CauseKind::Closed));
    assert!(owner.view(A).cause.unwrap().may_have_acted);
    owner.pass(60 * SECOND);
    assert_eq!((owner.trace_since(3), owner.open.len()), (vec!["connected"], 0));
}

#[test]
fn cancel_ends_a_connected_message_in_every_phase() {
    let mut owner = Owner::new();
    owner.put_connected(A, PATH, |_| {});

    owner.run(A).unwrap();
    owner.cancel(A);
    assert_eq!((owner.ids(A), owner.dropped.len()), ((217, 0, 10), 1), "while TCP is made");

    owner.run(A).unwrap();
    let link = owner.register();
    owner.cancel(A);
    assert_eq!((owner.ids(A), owner.dropped.last()), ((217, 0, 10), Some(&link)), "Forward_Open is out");
    assert!(!owner.view(A).cause.unwrap().may_have_acted);

    owner.run(A).unwrap();
    owner.answers = false;
    let link = owner.register_and_open();
    owner.cancel(A);
    assert_eq!(owner.ids(A), (217, 0, 10), "permission is asked");
    assert_eq!(owner.trace().last(), Some(&"open"));
    owner.answers = true;

    owner.writes = false;
    owner.run(A).unwrap();
    owner.cancel(A);
    owner.write(link);
    owner.writes = true;
    assert_eq!((owner.ids(A).0, owner.trace().last()), (217, Some(&"open")), "permitted, not written");

    owner.run(A).unwrap();
    assert_eq!(owner.trace().last(), Some(&"connected"), "the connection is as good as before");
    owner.cancel(A);
    assert_eq!((owner.ids(A), owner.dropped.last()), ((217, 0, 12), Some(&link)), "written");
    assert!(owner.view(A).cause.unwrap().may_have_acted);
}

#[test]
fn stop_closes_connections_first_and_then_the_session() {
    let mut owner = Owner::new();
    for (block, path) in [(A, "4,10.0.0.1,1,0"), (B, "4,10.0.0.1,1,2")] {
        owner.put_connected(block, path, |_| {});
        owner.run(block).unwrap();
    }
    let link = owner.register_and_open();
    owner.succeed(link, &[1]);
    owner.accept_open(link);
    owner.succeed(link, &[2]);
    let frames = owner.written.len();
    owner.engine.stop(owner.now);
    owner.pump();
    owner.succeed(link, &[]);
    owner.succeed(link, &[]);
    assert_eq!(owner.trace_since(frames), ["close", "close", "unregister"]);
    owner.last_header(link, Command::UnRegisterSession);
    assert!(!owner.engine.is_quiet());
    owner.closed(link);
    assert!(owner.engine.is_quiet());
}

#[test]
fn stop_while_forward_open_is_out_drops_the_socket() {
    let mut owner = Owner::new();
    owner.put_connected(A, PATH, |_| {});
    owner.run(A).unwrap();
    let link = owner.register();
    owner.engine.stop(owner.now);
    owner.pump();
    assert_eq!((owner.ids(A), owner.dropped.clone()), ((217, 0, 10), vec![link]));
    assert!(owner.engine.is_quiet());
}

#[test]
fn stop_does_not_wait_for_a_target_that_does_not_answer_forward_close() {
    let mut owner = after_one_run(|_| {});
    owner.engine.stop(owner.now);
    owner.pump();
    owner.pass(SECOND);
    assert!(owner.engine.is_quiet());
}

#[test]
fn a_target_that_does_not_know_the_session_gets_a_new_one_and_a_new_connection() {
    let mut owner = after_one_run(|_| {});
    let link = owner.link();
    owner.run(A).unwrap();
    owner.answer_status(link, 0x64);
    let link = owner.register_and_open();
    owner.succeed(link, &[2]);
    assert_eq!(owner.view(A).res_data, [2]);
    assert_eq!(owner.trace_since(3), ["connected", "register", "close", "open", "connected"]);
}

/// A target gives up a connection that was silent for its watchdog time, whatever else goes over the session.
#[test]
fn a_connection_that_the_target_has_given_up_meanwhile_is_not_written_to() {
    let mut owner = after_one_run(|config| config.keep_alive = 60_000);
    let link = owner.link();
    owner.put(B, PATH, |config| config.keep_alive = 60_000);
    for _ in 0..20 {
        owner.pass(SECOND);
        if owner.trace().last() == Some(&"connected") {
            // A read that keeps alive, if there is one.
            owner.succeed(link, &[0, 0]);
        }
        owner.run(B).unwrap();
        owner.succeed(link, &[2]);
    }
    let kept = owner.trace_since(3).contains(&"connected");
    let frames = owner.written.len();
    owner.run(A).unwrap();
    let expected = if kept { "connected" } else { "close" };
    assert_eq!(owner.trace_since(frames), [expected], "16 s of silence are too long");
}
