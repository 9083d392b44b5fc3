//! SEND_REQ and DATA_EXCH: the four words, from the start to the end of an exchange.

use cipdeck_shared::api::WordsStatus;
use cipdeck_shared::config::{BlockId, Profile, SendReq, SendReqForm};
use cipdeck_shared::engine::{CauseKind, Instant, Phase};
use cipdeck_shared::plan::MessagePlan;

#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

use crate::owner::Owner;

const A: BlockId = BlockId(1);
const HOUR: u64 = 3_600_000_000;

/// The product name, from a TSX ETC 100.
fn product_name() -> SendReq {
    let mut config = SendReq::new(SendReqForm::Etc100, "product name");
    config.address = "ADDR('0.2.0.10.0.0.1')".into();
    config.data_to_send = "0000 030E 0120 0124 0730".into();
    config.management_param = vec![0, 0, 30, 10];
    // The target is not asked who it is.
    config.profile = Profile::Generic;
    config
}

fn connected(config: SendReq) -> SendReq {
    SendReq { data_to_send: "0001 030E 0120 0124 0730".into(), ..config }
}

fn owner_of(config: &SendReq) -> Owner {
    let mut owner = Owner::new();
    put(&mut owner, config);
    owner
}

fn put(owner: &mut Owner, config: &SendReq) {
    let (plan, findings) = MessagePlan::of(&config.clone().into());
    owner.engine.put(A, owner.revision, plan.ok_or(findings), owner.now);
    owner.pump();
}

/// The four words, Received_Data and ENO.
fn words(owner: &Owner) -> ([u16; 4], String, bool) {
    let WordsStatus { management_param, received_data, eno } =
        WordsStatus::new(&product_name(), &owner.view(A));
    (management_param, received_data, eno)
}

fn nothing(words: [u16; 4], eno: bool) -> ([u16; 4], String, bool) {
    (words, String::new(), eno)
}

#[test]
fn an_exchange_shows_its_words_from_its_start_to_its_end() {
    let mut owner = owner_of(&product_name());
    assert_eq!(words(&owner), nothing([0, 0, 30, 10], false), "as the program has left them");
    owner.set_in(A, true);
    assert_eq!(words(&owner), nothing([0x0101, 0, 30, 10], true), "the activity bit rises at the start");
    let link = owner.register();
    assert_eq!(owner.view(A).phase, Phase::Sent);
    assert_eq!(words(&owner).0[0], 0x0101);
    owner.reply(link, b"\x04CHP1");
    let done = ([0x0100, 0, 30, 9], "008E 0000 4304 5048 0031".to_owned(), true);
    assert_eq!(words(&owner), done, "4 bytes of head, 5 of data");
    owner.set_in(A, false);
    assert_eq!(words(&owner), (done.0, done.1, false), "ENO follows EN");
    owner.run(A).unwrap();
    assert_eq!(words(&owner), nothing([0x0201, 0, 30, 10], true), "another number, and the length again");
    let (_, view, _) = &owner.finished[0];
    assert_eq!(view.words.as_ref().unwrap().exchange, 1);
}

#[test]
fn a_refusal_of_the_device_is_report_0_and_no_success() {
    let mut owner = owner_of(&product_name());
    owner.run(A).unwrap();
    let link = owner.register();
    owner.refuse(link, 5, &[0x1234], &[7]);
    let (_, view, _) = &owner.finished[0];
    assert!(!view.q && view.status.error && view.status.error_id == 224);
    assert_eq!(view.cause.as_ref().unwrap().what, CauseKind::RefusedByDevice);
    assert_eq!(words(&owner), ([0x0100, 0, 30, 7], "008E 0105 1234 0007".into(), false));
}

#[test]
fn without_a_timeout_it_waits_until_somebody_ends_it() {
    for class_3 in [false, true] {
        let config = SendReq { management_param: vec![0, 0, 0, 10], ..product_name() };
        let config = if class_3 { connected(config) } else { config };
        let mut owner = owner_of(&config);
        owner.run(A).unwrap();
        owner.pass(10 * HOUR);
        assert_eq!(owner.view(A).phase, Phase::Connecting);
        let link = owner.register();
        if class_3 {
            owner.accept_open(link);
        }
        owner.pass(1_000 * HOUR);
        assert_eq!((owner.view(A).phase, words(&owner).0), (Phase::Sent, [0x0101, 0, 0, 10]));
        assert_eq!(owner.engine.poll_timeout(), None, "nobody looks at a clock");
        assert!(owner.now < Instant::NEVER);
        owner.cancel(A);
        assert_eq!(words(&owner).0, [0x0100, 0x0002, 0, 0]);
        assert!(owner.view(A).cause.unwrap().may_have_acted);
    }
}

#[test]
fn a_broken_connection_ends_what_waits_for_ever() {
    let mut owner = owner_of(&SendReq { management_param: vec![0, 0, 0, 10], ..product_name() });
    owner.run(A).unwrap();
    let link = owner.register();
    owner.pass(HOUR);
    owner.closed(link);
    assert_eq!(words(&owner).0, [0x0100, 0x04FF, 0, 0]);
}

#[test]
fn the_time_runs_out_in_tenths_of_a_second() {
    for config in [product_name(), connected(product_name())] {
        let mut owner = owner_of(&SendReq { management_param: vec![0, 0, 2, 10], ..config });
        owner.run(A).unwrap();
        owner.pass(199_999);
        assert_eq!(words(&owner).0, [0x0101, 0, 2, 10]);
        owner.pass(1);
        assert_eq!(words(&owner).0, [0x0100, 0x0001, 2, 0]);
        assert_eq!(owner.cause(A), CauseKind::Timeout);
    }
}

#[test]
fn nobody_at_the_port_is_told_in_the_words_of_the_module() {
    for (form, address, data, length, report) in [
        (SendReqForm::Etc100, "0.2.0.10.0.0.1", "0000 030E 0120 0124 0730", 10, 0x03FF),
        (SendReqForm::Etc101, "0.2.0", "0000 0A00 0001 030E 0120 0124 0730", 14, 0x13FF),
        (SendReqForm::DataExch, "0.2.0{10.0.0.1}UNC.CIP", "030E 0120 0124 0730", 8, 0x13FF),
    ] {
        let mut config = SendReq::new(form, "nobody");
        (config.address, config.data_to_send) = (address.into(), data.into());
        config.management_param = vec![0, 0, 30, length];
        let mut owner = owner_of(&config);
        owner.run(A).unwrap();
        assert_eq!(owner.open[0].1.to_string(), "10.0.0.1:44818", "{form}");
        owner.connect_failed(owner.link());
        assert_eq!(words(&owner).0, [0x0100, report, 30, 0], "{form}");
    }
}

#[test]
fn a_reply_that_does_not_fit_is_report_9_and_the_device_has_acted() {
    let mut owner = owner_of(&SendReq { received_data_size: 4, ..product_name() });
    owner.run(A).unwrap();
    let link = owner.register();
    owner.reply(link, &[1, 2, 3, 4]);
    assert_eq!(words(&owner).0, [0x0100, 0, 30, 8], "four words are just enough");
    owner.run(A).unwrap();
    owner.reply(link, &[1, 2, 3, 4, 5]);
    assert_eq!(words(&owner), nothing([0x0200, 0x0009, 30, 0], false));
    assert!(owner.view(A).cause.unwrap().has_acted);
}

#[test]
fn a_refused_connection_is_no_answer_to_the_message() {
    let mut owner = owner_of(&connected(product_name()));
    owner.run(A).unwrap();
    let link = owner.register();
    owner.refuse(link, 1, &[0x0113], &[]);
    assert_eq!(words(&owner), nothing([0x0100, 0x12FF, 30, 0], false));
    let (_, _, exchange) = &owner.finished[0];
    assert!(exchange.response().is_some(), "what the Connection Manager has said is kept");
}

#[test]
fn a_start_that_is_refused_never_raises_the_activity_bit() {
    let mut owner = owner_of(&product_name());
    owner.run(A).unwrap();
    let link = owner.register();
    owner.reply(link, &[1]);
    for (config, report) in [
        (SendReq { address: "ADDR('0.2.0')".into(), ..product_name() }, 0x03),
        (SendReq { management_param: vec![0, 0, 30], ..product_name() }, 0x05),
        (SendReq { request_code: 0x50, ..product_name() }, 0x06),
        (SendReq { management_param: vec![0, 0, 30, 0], ..product_name() }, 0x0E),
    ] {
        put(&mut owner, &config);
        owner.set_in(A, true);
        assert_eq!(words(&owner), nothing([0x0100, report, 30, 10], false));
        assert_eq!(owner.cause(A), CauseKind::Invalid);
        owner.set_in(A, false);
    }
    // Nothing of it was written, and the next exchange has the next number.
    assert_eq!(owner.requests_written(), 1);
    put(&mut owner, &product_name());
    owner.run(A).unwrap();
    assert_eq!(words(&owner).0, [0x0201, 0, 30, 10]);
}

#[test]
fn what_is_wide_in_the_words_is_wide_on_the_wire() {
    for (kind, from) in [("0000", 40), ("0001", 46)] {
        let mut owner = owner_of(&SendReq {
            data_to_send: format!("{kind} 050E 0021 0001 0025 0001 0730"),
            management_param: vec![0, 0, 30, 14],
            ..product_name()
        });
        owner.run(A).unwrap();
        let link = owner.register();
        if kind == "0001" {
            owner.accept_open(link);
        }
        let (_, frame) = owner.written.last().unwrap();
        let sent = [0x0E, 5, 0x21, 0, 1, 0, 0x25, 0, 1, 0, 0x30, 7];
        assert_eq!(frame[from..], sent, "{kind}");
    }
}
