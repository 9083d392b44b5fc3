//! Targets that are not there, or answer badly: ER with the manual's numbers and a cause, within the timeout; the
//! relay stays up, and the next run works.

use std::net::SocketAddr;
use std::time::{Duration, Instant};

use cipdeck_tests::block::{self, with};
use cipdeck_tests::fake_plc::{self, Act, FakePlc, Request};
use cipdeck_tests::frame::{REGISTER_SESSION, SEND_RR_DATA, encapsulate};
use cipdeck_tests::relay::Relay;
use serde_json::{Value, json};
use tokio::net::TcpListener;

/// What a target does with its first request.
type Misbehaviour = fn(&Request) -> Vec<Act>;

/// The smallest that the manual allows.
const TIMEOUT: Duration = Duration::from_millis(250);
/// What a busy machine may add to it.
const GRACE: Duration = Duration::from_millis(750);

#[tokio::test]
async fn a_target_that_answers_badly_gives_a_cause_and_the_next_run_works() {
    let rows: [(&str, Misbehaviour, u64, u64, &str); 12] = [
        ("silent", |_| vec![], 55, 115, "timeout"),
        ("half a reply, then silent", |request| vec![Act::Send(half(request))], 55, 115, "timeout"),
        (
            "half a reply, then closed",
            |request| vec![Act::Send(half(request)), Act::Close],
            55,
            115,
            "closed",
        ),
        ("closed without a reply", |_| vec![Act::Close], 55, 115, "closed"),
        ("wrong session", |request| vec![Act::Send(of_another_session(request))], 55, 115, "timeout"),
        (
            "wrong sender context",
            |request| vec![Act::Send(with_another_context(request))],
            55,
            115,
            "timeout",
        ),
        ("garbage", |_| vec![Act::Send(vec![0xFF; 64])], 69, 65, "malformed"),
        (
            "another protocol",
            |_| vec![Act::Send(b"HTTP/1.1 400 Bad Request\r\n\r\n".into())],
            69,
            65,
            "malformed",
        ),
        ("a frame without items", |request| vec![Act::Send(empty(request, 0))], 69, 65, "malformed"),
        (
            "the reply of another service",
            |request| vec![Act::Send(of_another_service(request))],
            69,
            65,
            "malformed",
        ),
        (
            "an encapsulation status",
            |request| vec![Act::Send(empty(request, 8))],
            69,
            65,
            "encapsulation_status",
        ),
        ("a refusal", |request| vec![Act::Send(request.reply(&REFUSAL))], 224, 5, "refused_by_device"),
    ];
    let relay = Relay::start().await;
    for (name, misbehaviour, error_id, sub_error_id, cause) in rows {
        let plc = FakePlc::start(fake_plc::messages(move |request| match request.number {
            1 => misbehaviour(request),
            _ => vec![Act::Send(request.success(&[0x2A, 0]))],
        }))
        .await;
        let id = relay.rest.create(&impatient(&plc.path())).await;
        let status = failure_within_the_timeout(&relay, &id, name).await;
        assert_eq!(ids(&status), (error_id, sub_error_id), "{name}: {status}");
        assert_eq!(status["cause"]["what"], cause, "{name}: {status}");

        let status = relay.rest.run(&id).await;
        assert_eq!(
            (&status["Q"], &status["ResData"]),
            (&json!(true), &json!("2a00")),
            "after {name}: {status}"
        );
    }
}

#[tokio::test]
async fn a_target_that_gives_no_session_gives_a_cause_and_the_next_run_works() {
    let rows: [(&str, Misbehaviour, &str); 4] = [
        ("silent", |_| vec![], "timeout"),
        ("closed", |_| vec![Act::Close], "closed"),
        ("refused", |request| vec![Act::Send(refused_session(request))], "session_refused"),
        ("garbage", |_| vec![Act::Send(vec![0xFF; 64])], "malformed"),
    ];
    let relay = Relay::start().await;
    for (name, misbehaviour, cause) in rows {
        let plc = FakePlc::start(move |request: &Request| match (request.frame.command(), request.number) {
            (REGISTER_SESSION, 1) => misbehaviour(request),
            (REGISTER_SESSION, _) => vec![Act::Send(request.registered())],
            (SEND_RR_DATA, _) => vec![Act::Send(request.success(&[0x2A, 0]))],
            _ => vec![Act::Close],
        })
        .await;
        let id = relay.rest.create(&impatient(&plc.path())).await;
        let status = failure_within_the_timeout(&relay, &id, name).await;
        assert_eq!(status["cause"]["what"], cause, "{name}: {status}");
        assert_eq!(plc.messages().len(), 0, "{name}: nothing is sent without a session");
        if cause != "malformed" {
            assert_eq!(ids(&status), (55, 113), "{name}: {status}");
        }

        let status = relay.rest.run(&id).await;
        assert_eq!(status["Q"], true, "after {name}: {status}");
    }
}

#[tokio::test]
async fn nobody_at_the_address_is_refused_at_once() {
    let relay = Relay::start().await;
    let address = nobody().await;
    let id = relay.rest.create(&impatient(&fake_plc::path(address))).await;
    let status = failure_within_the_timeout(&relay, &id, "refused").await;
    assert_eq!(ids(&status), (210, 0), "{status}");
    assert_eq!(status["cause"]["what"], "refused", "{status}");

    let plc = FakePlc::start(fake_plc::answering(&[1])).await;
    let id = relay.rest.create(&impatient(&plc.path())).await;
    assert_eq!(relay.rest.run(&id).await["Q"], true, "other targets are not affected");
}

#[tokio::test]
async fn an_unknown_host_is_unresolved() {
    let relay = Relay::start().await;
    // Reserved so that nobody ever has it: RFC 6761.
    let block = with(impatient("4,no-such-drive.invalid"), "/TargetCfg/UcmmTimeout", 3000);
    let id = relay.rest.create(&block).await;
    let status = relay.rest.run(&id).await;
    assert_eq!(ids(&status), (210, 0), "{status}");
    assert_eq!(status["cause"]["what"], "unresolved", "{status}");
}

#[tokio::test]
async fn a_refusal_keeps_all_words_of_the_additional_status() {
    let relay = Relay::start().await;
    let plc = FakePlc::start(fake_plc::messages(|request| {
        vec![Act::Send(request.reply(&[0x8E, 0, 0x01, 2, 0x15, 0x03, 0x34, 0x12]))]
    }))
    .await;
    let id = relay.rest.create(&impatient(&plc.path())).await;
    let status = relay.rest.run(&id).await;
    assert_eq!(ids(&status), (224, 1), "{status}");
    assert_eq!(status["Status"]["ExtErrorID"], 0x0315, "{status}");
    assert_eq!(status["Status"]["StatusBits"], 13, "EN, ST and ER stay: {status}");
    assert_eq!(status["cause"]["additional"], json!([0x0315, 0x1234]), "{status}");
}

#[tokio::test]
async fn a_reply_that_does_not_fit_says_that_the_device_has_acted() {
    let relay = Relay::start().await;
    let plc = FakePlc::start(fake_plc::answering(&[7; 20])).await;
    let id = relay.rest.create(&with(impatient(&plc.path()), "/ResDataSize", 19)).await;
    let status = relay.rest.run(&id).await;
    assert_eq!(ids(&status), (33, 48), "{status}");
    assert_eq!(status["cause"]["what"], "too_small", "{status}");
    assert_eq!(status["cause"]["has_acted"], true, "{status}");
    let exchanges = relay.rest.get(&format!("blocks/{id}/exchange")).await.body;
    let response = format!("8e000000{}", "07".repeat(20));
    assert_eq!(
        exchanges.as_array().and_then(|all| all.last()).expect("one")["response"],
        response,
        "{exchanges}"
    );
}

#[tokio::test]
async fn an_encapsulation_status_is_named() {
    let relay = Relay::start().await;
    let plc = FakePlc::start(fake_plc::messages(|request| vec![Act::Send(empty(request, 8))])).await;
    let id = relay.rest.create(&impatient(&plc.path())).await;
    let status = relay.rest.run(&id).await;
    assert_eq!(status["cause"]["status"], 8, "{status}");
}

#[tokio::test]
async fn one_byte_at_a_time_is_still_an_answer() {
    let relay = Relay::start().await;
    let plc = FakePlc::start(fake_plc::messages(|request| {
        request.success(&[0x2A, 0]).into_iter().map(|byte| Act::Send(vec![byte])).collect()
    }))
    .await;
    let id = relay.rest.create(&impatient(&plc.path())).await;
    assert_eq!(relay.rest.run(&id).await["ResData"], "2a00");
}

/// Path unknown.
const REFUSAL: [u8; 4] = [0x8E, 0, 0x05, 0];

fn impatient(path: &str) -> Value {
    let timeout = u64::try_from(TIMEOUT.as_millis()).expect("a short timeout");
    with(block::product_name(path), "/TargetCfg/UcmmTimeout", timeout)
}

async fn failure_within_the_timeout(relay: &Relay, id: &str, name: &str) -> Value {
    let started = Instant::now();
    let status = relay.rest.run(id).await;
    let elapsed = started.elapsed();
    assert!(elapsed < TIMEOUT + GRACE, "{name}: {elapsed:?} until {status}");
    assert_eq!((&status["Q"], &status["phase"]), (&json!(false), &json!("failed")), "{name}: {status}");
    assert_eq!(status["Status"]["Error"], true, "{name}: {status}");
    status
}

fn ids(status: &Value) -> (u64, u64) {
    let number =
        |member: &str| status["Status"][member].as_u64().unwrap_or_else(|| panic!("{member}: {status}"));
    (number("ErrorID"), number("SubErrorID"))
}

fn half(request: &Request) -> Vec<u8> {
    let mut reply = request.success(&[1, 0]);
    reply.truncate(reply.len() / 2);
    reply
}

fn of_another_session(request: &Request) -> Vec<u8> {
    let session = request.frame.session() ^ 1;
    request.reply_as(session, request.frame.context(), &fake_plc::success(14, &[1, 0]))
}

fn with_another_context(request: &Request) -> Vec<u8> {
    let context = request.frame.context().map(|byte| byte ^ 0x55);
    request.reply_as(request.frame.session(), context, &fake_plc::success(14, &[1, 0]))
}

fn of_another_service(request: &Request) -> Vec<u8> {
    request.reply(&fake_plc::success(16, &[]))
}

fn empty(request: &Request, status: u32) -> Vec<u8> {
    encapsulate(SEND_RR_DATA, request.frame.session(), status, request.frame.context(), &[])
}

fn refused_session(request: &Request) -> Vec<u8> {
    encapsulate(REGISTER_SESSION, 0, 0x02, request.frame.context(), &[1, 0, 0, 0])
}

/// An address at which somebody has just stopped listening.
async fn nobody() -> SocketAddr {
    let listener = TcpListener::bind(("127.0.0.1", 0)).await.expect("a free port");
    listener.local_addr().expect("the port that is bound")
}
