//! Forward_Open: with what it is tried again, when it is given up, and what the block says then.

use cipdeck_shared::config::{BlockId, Profile};
use cipdeck_shared::engine::{CauseKind, Phase, RefusedBy};
use cipdeck_shared::wire::{ConnectionId, ConnectionTriad, ForwardOpenReply, ServiceCode};

#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

use crate::owner::Owner;

const A: BlockId = BlockId(1);
const B: BlockId = BlockId(2);
const PATH: &str = "4,10.0.0.1";

fn opening(profile: Profile) -> (Owner, cipdeck_shared::engine::LinkId) {
    let mut owner = Owner::new();
    owner.put_connected(A, PATH, |config| config.profile = profile);
    owner.run(A).unwrap();
    let link = owner.register();
    (owner, link)
}

#[test]
fn every_profile_asks_for_its_size() {
    for (profile, size, service) in [
        (Profile::Generic, 504, ServiceCode::ForwardOpen),
        (Profile::Micro800, 504, ServiceCode::ForwardOpen),
        (Profile::Logix, 4_002, ServiceCode::LargeForwardOpen),
        (Profile::Omron, 1_994, ServiceCode::LargeForwardOpen),
    ] {
        let (owner, link) = opening(profile);
        let sent = owner.last(link);
        assert_eq!(sent.request.as_ref().unwrap().service(), service, "{profile:?}");
        let open = sent.open();
        assert_eq!((open.o_t.size, open.t_o.size), (size, size), "{profile:?}");
        assert_eq!((open.o_t.kind(), open.o_t_id, open.transport), (2, ConnectionId(0), 0xA3));
        assert_ne!(open.t_o_id, ConnectionId(0));
    }
}

#[test]
fn a_message_that_is_longer_than_usual_gets_a_connection_that_holds_it() {
    let mut owner = Owner::new();
    owner.put_connected(A, PATH, |config| {
        (config.app_cfg.service, config.req_data) = (16, "00".repeat(490));
        (config.app_cfg.class, config.app_cfg.instance, config.app_cfg.attribute) = (1000, 70_000, 1000);
    });
    owner.run(A).unwrap();
    let link = owner.register();
    let sent = owner.last(link);
    assert_eq!(sent.request.as_ref().unwrap().service(), ServiceCode::ForwardOpen);
    assert_eq!(sent.open().o_t.size, 2 + 2 + 14 + 490, "sequence count, service, path size, path, data");
    owner.accept_open(link);
    owner.succeed(link, &[]);
    assert_eq!(owner.target().connections[0].size, 508);
}

#[test]
fn a_connection_that_is_too_small_for_the_next_message_is_replaced() {
    let (mut owner, link) = opening(Profile::Generic);
    owner.refuse(link, 1, &[0x0109, 32], &[]);
    owner.accept_open(link);
    owner.succeed(link, &[1]);
    owner.put_connected(B, PATH, |config| {
        (config.app_cfg.service, config.req_data) = (16, "00".repeat(100));
    });
    let frames = owner.written.len();
    owner.run(B).unwrap();
    owner.succeed(link, &[]);
    owner.accept_open(link);
    assert_eq!(owner.trace_since(frames), ["close", "open", "connected"]);
    assert_eq!(owner.target().connections[0].size, 504);
}

#[test]
fn a_target_without_large_forward_open_gets_the_classic_one() {
    let (mut owner, link) = opening(Profile::Logix);
    let first = owner.last(link).open();
    owner.refuse(link, 8, &[], &[]);
    assert_eq!(owner.trace(), ["register", "large open", "open"]);
    let second = owner.last(link).open();
    assert_eq!((second.o_t.size, second.triad), (504, first.triad));
    owner.accept_open(link);
    owner.succeed(link, &[1]);
    assert!(owner.view(A).q);
}

#[test]
fn a_target_with_smaller_connections_gets_the_size_that_it_names() {
    for (size, words) in
        [(500, ["large open", "open"]), (1_000, ["large open", "large open"]), (16, ["large open", "open"])]
    {
        let (mut owner, link) = opening(Profile::Logix);
        owner.refuse(link, 1, &[0x0109, size], &[]);
        assert_eq!(owner.trace_since(1), words, "{size}");
        let open = owner.last(link).open();
        assert_eq!((open.o_t.size, open.t_o.size), (size, size));
        owner.accept_open(link);
        owner.succeed(link, &[1]);
        assert_eq!((owner.view(A).q, owner.target().connections[0].size), (true, size));
    }
}

#[test]
fn a_size_that_does_not_hold_the_request_or_is_no_smaller_is_a_refusal() {
    for words in [&[0x0109, 9][..], &[0x0109, 504], &[0x0109, 0xFFFF], &[0x0109, 0], &[0x0109]] {
        let (mut owner, link) = opening(Profile::Generic);
        owner.refuse(link, 1, words, &[]);
        assert_eq!((owner.ids(A), owner.view(A).status.ext_error_id), ((224, 1, 10), 0x0109), "{words:?}");
        assert_eq!(owner.trace(), ["register", "open"], "{words:?}");
    }
}

#[test]
fn a_connection_that_is_known_already_gets_another_name() {
    let (mut owner, link) = opening(Profile::Generic);
    let first = owner.last(link).open();
    owner.refuse(link, 1, &[0x0100], &[]);
    let second = owner.last(link).open();
    assert_ne!((first.triad.serial, first.t_o_id), (second.triad.serial, second.t_o_id));
    assert_ne!(first.t_o_id, second.t_o_id);
    assert_eq!(first.triad.originator, second.triad.originator);
    owner.accept_open(link);
    owner.succeed(link, &[1]);
    assert!(owner.view(A).q);
}

#[test]
fn everything_at_once_is_tried_in_turn() {
    let (mut owner, link) = opening(Profile::Logix);
    owner.refuse(link, 8, &[], &[]);
    owner.refuse(link, 1, &[0x0109, 100], &[]);
    owner.refuse(link, 1, &[0x0100], &[]);
    assert_eq!(owner.last(link).open().o_t.size, 100);
    owner.accept_open(link);
    owner.succeed(link, &[1]);
    assert!(owner.view(A).q);
}

#[test]
fn it_is_not_tried_for_ever() {
    let (mut owner, link) = opening(Profile::Generic);
    let mut tries = 1;
    while owner.engine.is_busy(A) {
        assert!(tries < 10);
        owner.refuse(link, 1, &[0x0100], &[]);
        tries += 1;
    }
    assert_eq!(owner.trace_since(1), ["open"; 4]);
    assert_eq!((owner.ids(A), owner.view(A).status.ext_error_id), ((224, 1, 10), 0x0100));
}

#[test]
fn other_refusals_are_told_with_who_refused_and_how_far_it_came() {
    for (status, words, ext) in [
        (1, &[0x0113][..], 0x0113),
        (1, &[0x0315], 0x0315),
        (2, &[], 0),
        (8, &[], 0),
        (1, &[0x0312, 7], 0x0312),
    ] {
        let (mut owner, link) = opening(Profile::Generic);
        let mut data = Vec::new();
        owner.last(link).open().triad.encode(&mut data);
        data.extend_from_slice(&[3, 0]);
        owner.refuse(link, status, words, &data);
        assert_eq!(owner.ids(A), (224, status.into(), 10), "EN was held by the run only: EW and ER are left");
        assert_eq!(owner.finished[0].1.status.status_bits.0, 11, "EN, EW, ER");
        assert_eq!(owner.view(A).status.ext_error_id, ext);
        let cause = owner.view(A).cause.unwrap();
        assert_eq!((cause.what, cause.by), (CauseKind::RefusedByDevice, Some(RefusedBy::ForwardOpen)));
        assert_eq!((cause.remaining_path, cause.additional), (Some(3), words.to_vec()));
        assert!(!cause.may_have_acted);
        assert_eq!(owner.dropped, [], "the session is as good as before");
        owner.run(A).unwrap();
        owner.accept_open(link);
        owner.succeed(link, &[1]);
        assert!(owner.view(A).q, "the next run tries again");
    }
}

#[test]
fn a_refusal_ends_the_message_that_asked_and_the_next_one_tries_for_itself() {
    let (mut owner, link) = opening(Profile::Generic);
    owner.put_connected(B, PATH, |_| {});
    owner.run(B).unwrap();
    owner.refuse(link, 1, &[0x0113], &[]);
    assert_eq!((owner.ids(A).0, owner.view(B).phase), (224, Phase::Connecting));
    owner.accept_open(link);
    owner.succeed(link, &[2]);
    assert_eq!(owner.view(B).res_data, [2]);
}

#[test]
fn a_reply_about_another_connection_is_nonsense() {
    let (mut owner, link) = opening(Profile::Generic);
    let open = owner.last(link).open();
    let triad = ConnectionTriad { serial: open.triad.serial ^ 1, ..open.triad };
    let reply = ForwardOpenReply {
        o_t_id: ConnectionId(5),
        t_o_id: open.t_o_id,
        triad,
        o_t_api_us: 1,
        t_o_api_us: 1,
    };
    let mut data = Vec::new();
    reply.encode(&mut data);
    owner.succeed(link, &data);
    assert_eq!((owner.ids(A), owner.cause(A)), ((69, 65, 10), CauseKind::Malformed));
    assert_eq!(owner.dropped, [link]);
    assert!(!owner.trace().contains(&"connected"));
}

#[test]
fn a_reply_that_is_cut_short_or_of_another_service_is_nonsense() {
    let (mut owner, link) = opening(Profile::Generic);
    owner.succeed(link, &[1, 2, 3]);
    assert_eq!((owner.cause(A), owner.dropped.clone()), (CauseKind::Malformed, vec![link]));
    let (mut owner, link) = opening(Profile::Generic);
    owner.refuse_as(link, ServiceCode::GetAttributeSingle, (1, &[0x0100]), &[]);
    assert_eq!((owner.cause(A), owner.dropped.clone()), (CauseKind::Malformed, vec![link]));
}

#[test]
fn an_encapsulation_status_is_named() {
    let (mut owner, link) = opening(Profile::Generic);
    owner.answer_status(link, 8);
    assert_eq!((owner.ids(A), owner.view(A).cause.unwrap().status), ((69, 65, 10), Some(8)));
    let (mut owner, link) = opening(Profile::Generic);
    owner.answer_status(link, 0x64);
    let link = {
        assert_eq!(owner.dropped, [link], "the session is not known: a new one");
        owner.register()
    };
    owner.answer_status(link, 0x64);
    assert_eq!((owner.ids(A), owner.view(A).cause.unwrap().status), ((69, 65, 10), Some(0x64)), "once");
}

#[test]
fn a_target_that_hangs_up_on_it_is_told_at_once() {
    let (mut owner, link) = opening(Profile::Generic);
    owner.closed(link);
    assert_eq!((owner.ids(A), owner.cause(A)), ((55, 113, 10), CauseKind::Closed));
    assert!(!owner.view(A).cause.unwrap().may_have_acted);
    assert_eq!(owner.open, []);
}

#[test]
fn a_late_answer_to_a_forward_open_that_was_given_up_opens_nothing() {
    let (mut owner, old) = opening(Profile::Generic);
    let open = owner.last(old).open();
    let reply = ForwardOpenReply {
        o_t_id: ConnectionId(5),
        t_o_id: open.t_o_id,
        triad: open.triad,
        o_t_api_us: 1,
        t_o_api_us: 1,
    };
    let mut data = Vec::new();
    reply.encode(&mut data);
    let reply = cipdeck_shared::wire::MessageRouterReply::success(ServiceCode::ForwardOpen, &data);
    let late = owner.answer_frame(old, &reply);
    owner.pass(3_000_000);
    owner.run(A).unwrap();
    let new = owner.register();
    owner.input(old, &late);
    owner.input(new, &late);
    assert_eq!((owner.target().connections.len(), owner.view(A).phase), (0, Phase::Connecting));
    owner.accept_open(new);
    assert_eq!(owner.target().connections.len(), 1);
}

#[test]
fn what_a_forward_open_without_answer_may_have_opened_is_closed_before_the_next_one() {
    type End = fn(&mut Owner, cipdeck_shared::engine::LinkId);
    let ends: [(&str, End); 4] = [
        ("timeout", |owner, _| owner.pass(3_000_000)),
        ("cancel", |owner, _| owner.cancel(A)),
        ("closed", |owner, link| owner.closed(link)),
        ("nonsense", |owner, link| owner.succeed(link, &[1, 2, 3])),
    ];
    for (name, end) in ends {
        let (mut owner, link) = opening(Profile::Generic);
        let open = owner.last(link).open();
        end(&mut owner, link);
        owner.run(A).unwrap();
        let link = owner.register();
        assert_eq!(owner.trace(), ["register", "open", "register", "close"], "{name}");
        let request = owner.last(link).request.unwrap();
        let close = cipdeck_shared::wire::ForwardClose::decode(request.data()).unwrap();
        assert_eq!((close.triad, close.path), (open.triad, open.path), "{name}");
        owner.accept_open(link);
        owner.succeed(link, &[1]);
        assert!(owner.view(A).q, "{name}");
    }
}

#[test]
fn the_controller_has_sixteen_connections_and_gives_up_an_idle_one_for_the_next() {
    let mut owner = Owner::new();
    let mut links = Vec::new();
    for n in 1..=18 {
        owner.put_connected(BlockId(n), &format!("4,10.0.0.{n}"), |_| {});
        owner.pass(1_000);
        owner.run(BlockId(n)).unwrap();
        let link = owner.register_and_open();
        links.push(link);
        owner.succeed(link, &[1]);
    }
    assert!(owner.finished.iter().all(|(_, view, _)| view.q));
    for link in &links[..2] {
        assert_eq!(owner.last(*link).request.unwrap().service(), ServiceCode::ForwardClose);
    }
    assert_ne!(owner.last(links[2]).request.unwrap().service(), ServiceCode::ForwardClose);
}

#[test]
fn one_connection_that_is_closing_makes_room_for_one_only() {
    let mut owner = Owner::new();
    let mut links = Vec::new();
    for n in 1..=16 {
        owner.put_connected(BlockId(n), &format!("4,10.0.0.{n}"), |_| {});
        owner.pass(1_000);
        owner.run(BlockId(n)).unwrap();
        links.push(owner.register_and_open());
        owner.succeed(links[links.len() - 1], &[1]);
    }
    for n in 17..=18 {
        owner.put_connected(BlockId(n), &format!("4,10.0.0.{n}"), |_| {});
        owner.run(BlockId(n)).unwrap();
    }
    let closing = |link: &&cipdeck_shared::engine::LinkId| {
        owner.last(**link).request.unwrap().service() == ServiceCode::ForwardClose
    };
    assert_eq!(links.iter().filter(closing).count(), 2);
}

#[test]
fn many_routes_of_one_target_share_the_sixteen() {
    let mut owner = Owner::new();
    owner.put_connected(A, "4,10.0.0.1,1,1", |_| {});
    owner.run(A).unwrap();
    let link = owner.register_and_open();
    owner.succeed(link, &[1]);
    for slot in 2..=16 {
        owner.put_connected(BlockId(slot), &format!("4,10.0.0.1,1,{slot}"), |_| {});
        owner.pass(1_000);
        owner.run(BlockId(slot)).unwrap();
        owner.accept_open(link);
        owner.succeed(link, &[1]);
    }
    owner.put_connected(BlockId(17), "4,10.0.0.1,1,17", |_| {});
    let frames = owner.written.len();
    owner.run(BlockId(17)).unwrap();
    owner.succeed(link, &[]);
    owner.accept_open(link);
    owner.succeed(link, &[17]);
    assert_eq!(owner.trace_since(frames), ["close", "open", "connected"]);
    assert_eq!((owner.view(BlockId(17)).res_data, owner.target().connections.len()), (vec![17], 16));
}

#[test]
fn without_an_idle_connection_the_seventeenth_fails_with_209() {
    use cipdeck_shared::config::Channel;
    let mut owner = Owner::new();
    for n in 1..=16 {
        let path = format!("4,10.0.0.{n}");
        owner.put_connected(BlockId(n), &path, |_| {});
        owner.put_connected(BlockId(n + 100), &path, |config| config.channel = Channel::Monitor);
        owner.run(BlockId(n)).unwrap();
        let link = owner.register_and_open();
        owner.succeed(link, &[1]);
        owner.run(BlockId(n + 100)).unwrap();
    }
    owner.put_connected(BlockId(17), "4,10.0.0.17", |_| {});
    owner.run(BlockId(17)).unwrap();
    assert_eq!((owner.ids(BlockId(17)), owner.cause(BlockId(17))), ((209, 0, 10), CauseKind::Limit));
    owner.put_connected(BlockId(18), "4,10.0.0.17", |config| config.channel = Channel::Monitor);
    owner.run(BlockId(18)).unwrap();
    assert_eq!(owner.view(BlockId(18)).phase, Phase::Connecting, "the monitor has no limit");
}
