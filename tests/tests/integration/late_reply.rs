//! A late reply can never answer the next request.

use std::sync::{Arc, Mutex};

use cipdeck_tests::block::{self, with};
use cipdeck_tests::command::Service;
use cipdeck_tests::fake_plc::{self, Act, FakePlc, Request};
use cipdeck_tests::gateway::Gateway;
use cipdeck_tests::relay::Relay;
use cipdeck_tests::{PATIENCE, frame};
use serde_json::{Value, json};

const FIRST: [u8; 2] = [0x11, 0x11];
const SECOND: [u8; 2] = [0x22, 0x22];

#[tokio::test]
async fn the_reply_of_a_request_that_timed_out_does_not_answer_the_next() {
    let relay = Relay::start().await;
    let plc = FakePlc::start(answers_the_first_request_with_the_second()).await;
    let id = relay.rest.create(&impatient(&plc.path())).await;
    let status = relay.rest.run(&id).await;
    assert_eq!(status["cause"]["what"], "timeout", "{status}");
    let status = relay.rest.run(&id).await;
    assert_eq!((&status["Q"], &status["ResData"]), (&json!(true), &json!("2222")), "{status}");
}

#[tokio::test]
async fn the_reply_of_a_cancelled_request_does_not_answer_the_next() {
    let relay = Relay::start().await;
    let plc = FakePlc::start(answers_the_first_request_with_the_second()).await;
    let id = relay.rest.create(&block::product_name(&plc.path())).await;
    let mut viewer = relay.viewer().await;
    let run = viewer.submit(json!({ "type": "run", "block": id })).await;
    viewer.status_where("the request is sent", PATIENCE, &id, |status| status["phase"] == "sent").await;
    viewer.cancel(&id).await;
    let answer = viewer.answer(&run).await;
    assert_eq!(answer["status"]["Status"]["ErrorID"], 217, "{answer}");
    assert_eq!(answer["status"]["cause"]["may_have_acted"], true, "{answer}");
    let status = viewer.run(&id).await;
    assert_eq!((&status["Q"], &status["ResData"]), (&json!(true), &json!("2222")), "{status}");
}

#[tokio::test]
async fn after_a_timeout_the_socket_is_replaced() {
    let relay = Relay::start().await;
    // The late reply arrives at the old socket while nobody waits there any more.
    let plc = FakePlc::start(fake_plc::messages(|request| match request.number {
        1 => vec![Act::Hold, Act::Send(request.success(&FIRST))],
        _ => vec![Act::Send(request.success(&SECOND))],
    }))
    .await;
    let id = relay.rest.create(&impatient(&plc.path())).await;
    assert_eq!(relay.rest.run(&id).await["cause"]["what"], "timeout");
    plc.release();
    let status = relay.rest.run(&id).await;
    assert_eq!(status["ResData"], "2222", "{status}");
    let connections: Vec<_> = plc
        .requests()
        .iter()
        .filter(|request| request.frame.command() == frame::SEND_RR_DATA)
        .map(|request| request.connection)
        .collect();
    assert_eq!(connections, [1, 2]);
}

#[tokio::test]
async fn a_reply_with_a_foreign_context_is_dropped_and_the_right_one_is_taken() {
    let relay = Relay::start().await;
    let plc = FakePlc::start(fake_plc::messages(|request| {
        let foreign = request.frame.context().map(|byte| byte.wrapping_add(1));
        let wrong = request.reply_as(request.frame.session(), foreign, &fake_plc::success(14, &FIRST));
        vec![Act::Send(wrong), Act::Send(request.success(&SECOND))]
    }))
    .await;
    let id = relay.rest.create(&block::product_name(&plc.path())).await;
    assert_eq!(relay.rest.run(&id).await["ResData"], "2222");
}

#[tokio::test]
async fn every_request_has_a_context_of_its_own() {
    let relay = Relay::start().await;
    let plc = FakePlc::start(fake_plc::answering(&SECOND)).await;
    let id = relay.rest.create(&block::product_name(&plc.path())).await;
    for _ in 0..5 {
        assert_eq!(relay.rest.run(&id).await["Q"], true);
    }
    let mut contexts: Vec<_> = plc.requests().iter().map(|request| request.frame.context()).collect();
    let all = contexts.len();
    contexts.sort_unstable();
    contexts.dedup();
    assert_eq!(contexts.len(), all, "{contexts:?}");
}

#[tokio::test]
async fn a_reply_that_a_gateway_holds_back_answers_none_of_the_next_hundred_requests() {
    after_a_held_reply(|block| block).await;
}

#[tokio::test]
async fn a_connected_reply_that_a_gateway_holds_back_answers_none_of_the_next_hundred_requests() {
    after_a_held_reply(block::connected).await;
}

/// The first reply comes before each of the next hundred, and so does the one before; all requests differ.
async fn after_a_held_reply(way: impl Fn(Value) -> Value) {
    let device = Service::simulate("127.0.0.1:0", &[]).await;
    let gateway = Gateway::start(&device.address, 1).await;
    let relay = Relay::start().await;
    let mut viewer = relay.viewer().await;
    let mut wrong = Vec::new();
    for number in 0..=100 {
        let mut block = way(block::numbered(&gateway.path(), number));
        if number == 0 {
            block = with(with(block, "/TargetCfg/UcmmTimeout", 300), "/TargetCfg/ConnMsgTimeout", 800);
        }
        let id = relay.rest.create(&block).await;
        let status = viewer.run(&id).await;
        let ids = (&status["Status"]["ErrorID"], &status["Status"]["SubErrorID"]);
        if number == 0 {
            assert_eq!(ids, (&json!(55), &json!(115)), "{status}");
        } else {
            assert_eq!(ids, (&json!(0), &json!(0)), "{status}");
            wrong.extend(Some(status).filter(|status| block::number_of(&status["ResData"]) != Some(number)));
        }
    }
    assert!(wrong.is_empty(), "{} wrong values: {wrong:?}", wrong.len());
    let dropped = relay.rest.get("targets").await.body[0]["dropped"].as_u64();
    assert_eq!(dropped, Some(199), "100 times the late one, 99 times the former one");
}

/// Silent at first; the second request is answered with the reply of the first, with its session and context, and
/// then properly.
fn answers_the_first_request_with_the_second() -> impl FnMut(&Request) -> Vec<Act> + Send + 'static {
    let late: Arc<Mutex<Option<Vec<u8>>>> = Arc::default();
    fake_plc::messages(move |request| {
        let mut late = late.lock().expect("no panic while held");
        match late.take() {
            None => {
                *late = Some(request.success(&FIRST));
                vec![]
            }
            Some(reply) => vec![Act::Send(reply), Act::Send(request.success(&SECOND))],
        }
    })
}

fn impatient(path: &str) -> Value {
    with(block::product_name(path), "/TargetCfg/UcmmTimeout", 250)
}
