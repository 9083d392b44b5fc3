//! Keep-alive: an idle session is read over, and a target that does not answer is down.

use cipdeck_shared::config::BlockId;
use cipdeck_shared::engine::{CauseKind, LinkId, TargetState};

#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

use crate::owner::Owner;
use crate::target::FIRST_O_T;

const A: BlockId = BlockId(1);
const PATH: &str = "4,10.0.0.1";
const SECOND: u64 = 1_000_000;
/// Get_Attribute_Single, Identity, status.
const READ: [u8; 8] = [0x0E, 3, 0x20, 1, 0x24, 1, 0x30, 5];

fn kept_alive(connected: bool, period: i64) -> (Owner, LinkId) {
    let mut owner = Owner::new();
    owner.put_connected(A, PATH, |config| {
        (config.keep_alive, config.target_cfg.cip_conn_mode) = (period, connected.into());
    });
    owner.run(A).unwrap();
    let link = owner.register();
    if connected {
        owner.accept_open(link);
    }
    owner.succeed(link, &[1]);
    (owner, link)
}

#[test]
fn an_idle_session_is_read_over_at_its_period() {
    let (mut owner, link) = kept_alive(false, 5_000);
    let frames = owner.written.len();
    for n in 1..=3 {
        owner.pass(5 * SECOND - 1);
        assert_eq!(owner.trace_since(frames).len(), n - 1);
        owner.pass(1);
        assert_eq!(owner.last(link).request.unwrap().bytes(), READ);
        owner.succeed(link, &[0, 0]);
    }
    assert_eq!(owner.trace_since(frames), ["unconnected"; 3]);
    assert_eq!((owner.finished.len(), owner.wants.len()), (1, 1), "no block has anything to do with it");
}

#[test]
fn a_connection_is_read_over_often_enough_for_the_target_to_keep_it() {
    for (period, every) in [(1_000, 1), (5_000, 5), (60_000, 8)] {
        let (mut owner, link) = kept_alive(true, period);
        let frames = owner.written.len();
        for n in 1..=5 {
            owner.pass(every * SECOND);
            assert_eq!(owner.trace_since(frames).len(), n, "{period}");
            assert_eq!(owner.last(link).request.unwrap().bytes(), READ);
            owner.succeed(link, &[0, 0]);
        }
        assert_eq!(owner.trace_since(frames), ["connected"; 5]);
        assert!(owner.target_is(TargetState::Open));
    }
}

#[test]
fn every_connection_of_a_session_is_kept_alive() {
    let (mut owner, link) = kept_alive(true, 60_000);
    owner.put_connected(BlockId(2), "4,10.0.0.1,1,2", |config| config.keep_alive = 60_000);
    owner.run(BlockId(2)).unwrap();
    owner.accept_open(link);
    owner.succeed(link, &[1]);
    let frames = owner.written.len();
    let mut reads = Vec::new();
    while reads.len() < 10 {
        while owner.written.len() == frames + reads.len() {
            owner.pass(1_000);
        }
        reads.push((owner.now.0 / SECOND, owner.last(link).address.unwrap().0.0 - FIRST_O_T));
        owner.succeed(link, &[0, 0]);
    }
    let times = reads.iter().map(|(at, _)| *at).collect::<Vec<_>>();
    assert_eq!(times, [8, 8, 16, 16, 24, 24, 32, 32, 40, 40]);
    let of_second = reads.iter().filter(|(_, connection)| *connection == 1).count();
    assert_eq!(of_second, 5, "each of the two every 8 s");
}

#[test]
fn a_message_puts_the_next_read_off() {
    let (mut owner, link) = kept_alive(true, 5_000);
    let frames = owner.written.len();
    for _ in 0..10 {
        owner.pass(4 * SECOND);
        owner.run(A).unwrap();
        owner.succeed(link, &[1]);
    }
    assert_eq!(owner.finished.len(), 11);
    assert_eq!(owner.trace_since(frames), ["connected"; 10]);
}

#[test]
fn no_answer_replaces_the_socket_and_shows_that_the_target_is_down() {
    for connected in [false, true] {
        let (mut owner, link) = kept_alive(connected, 5_000);
        owner.pass(5 * SECOND);
        assert!(owner.target_is(TargetState::Open));
        owner.pass(3 * SECOND);
        assert_eq!((owner.dropped.clone(), owner.target().state), (vec![link], TargetState::Down));
        assert_eq!(owner.target().error.unwrap().what, CauseKind::Timeout);
        assert_eq!(owner.finished.len(), 1, "no block has failed");
        owner.run(A).unwrap();
        let link = owner.register();
        if connected {
            owner.accept_open(link);
        }
        owner.succeed(link, &[2]);
        assert_eq!((owner.view(A).q, owner.target().error), (true, None));
    }
}

#[test]
fn a_message_waits_for_the_read_that_is_out_and_is_sent_then() {
    let (mut owner, link) = kept_alive(false, 5_000);
    owner.pass(5 * SECOND);
    let frames = owner.written.len();
    owner.run(A).unwrap();
    assert_eq!(owner.trace_since(frames), [""; 0]);
    owner.succeed(link, &[0, 0]);
    assert_eq!(owner.trace_since(frames), ["unconnected"]);
    owner.succeed(link, &[2]);
    assert_eq!(owner.view(A).res_data, [2]);
}

#[test]
fn a_refused_read_is_an_answer() {
    let (mut owner, link) = kept_alive(true, 5_000);
    owner.pass(5 * SECOND);
    owner.refuse(link, 5, &[], &[]);
    assert!(owner.target_is(TargetState::Open));
    owner.pass(5 * SECOND);
    owner.answer_status(link, 8);
    let frames = owner.written.len();
    assert!(owner.target_is(TargetState::Open));
    owner.pass(4 * SECOND);
    assert_eq!(owner.trace_since(frames), [""; 0], "and no reason to hurry");
}

#[test]
fn a_target_that_closes_meanwhile_is_left_alone_until_the_next_message() {
    let (mut owner, link) = kept_alive(true, 5_000);
    owner.pass(5 * SECOND);
    owner.closed(link);
    owner.pass(60 * SECOND);
    assert_eq!((owner.open.len(), owner.target().state), (0, TargetState::Closed));
    owner.run(A).unwrap();
    let link = owner.register_and_open();
    owner.succeed(link, &[2]);
    assert!(owner.view(A).q);
}

#[test]
fn stop_ends_the_reading() {
    let (mut owner, link) = kept_alive(true, 5_000);
    owner.pass(5 * SECOND);
    owner.engine.stop(owner.now);
    owner.pump();
    owner.succeed(link, &[0, 0]);
    owner.succeed(link, &[]);
    assert_eq!(owner.trace().split_off(4), ["close", "unregister"]);
    owner.closed(link);
    owner.pass(60 * SECOND);
    assert!(owner.engine.is_quiet());
}
