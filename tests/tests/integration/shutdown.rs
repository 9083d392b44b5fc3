//! A relay that is stopped leaves nothing behind.

use std::time::{Duration, Instant};

use cipdeck_tests::PATIENCE;
use cipdeck_tests::block;
use cipdeck_tests::fake_plc::{self, FakePlc};
use cipdeck_tests::frame::{REGISTER_SESSION, SEND_RR_DATA, UNREGISTER_SESSION};
use cipdeck_tests::relay::Relay;
use cipdeck_tests::wait::eventually;
use serde_json::json;

#[tokio::test]
async fn sessions_are_unregistered() {
    let relay = Relay::start().await;
    let plc = FakePlc::start(fake_plc::answering(&[1])).await;
    let id = relay.rest.create(&block::product_name(&plc.path())).await;
    assert_eq!(relay.rest.run(&id).await["Q"], true);
    relay.stop().await;
    let commands = eventually("UnRegisterSession arrives", PATIENCE, async || {
        let commands: Vec<_> = plc.requests().iter().map(|request| request.frame.command()).collect();
        (commands.len() == 3).then_some(commands)
    });
    assert_eq!(commands.await, [REGISTER_SESSION, SEND_RR_DATA, UNREGISTER_SESSION]);
}

#[tokio::test]
async fn a_message_in_flight_and_an_open_viewer_do_not_hold_it_up() {
    let relay = Relay::start().await;
    let plc = FakePlc::start(fake_plc::messages(|_| vec![])).await;
    let block = block::with(block::product_name(&plc.path()), "/TargetCfg/UcmmTimeout", 10_000);
    let id = relay.rest.create(&block).await;
    let mut viewer = relay.viewer().await;
    viewer.submit(json!({ "type": "run", "block": id })).await;
    viewer.status_where("the request is sent", PATIENCE, &id, |status| status["phase"] == "sent").await;
    let asked = Instant::now();
    relay.stop().await;
    let took = asked.elapsed();
    assert!(took < Duration::from_secs(5), "it does not wait for the timeout of the message: {took:?}");
    viewer.closed(PATIENCE).await;
}
