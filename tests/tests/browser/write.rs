//! A write asks before it is sent.

use cipdeck_tests::PATIENCE;
use cipdeck_tests::block::{self, with};
use cipdeck_tests::browser::{Journey, part};
use cipdeck_tests::fake_plc::{self, FakePlc};
use cipdeck_tests::relay::Relay;
use cipdeck_tests::wait::eventually;
use serde_json::json;

#[tokio::test]
async fn a_write_shows_its_bytes_and_is_sent_after_the_answer_only() {
    let relay = Relay::start().await;
    let plc = FakePlc::start(fake_plc::answering(&[])).await;
    relay.rest.create(&block::set(&plc.path(), 4, 150, 3, "01020304")).await;
    let journey = Journey::start("write").await;
    let mut user = journey.open("user", &relay.page()).await;
    user.click("set-4-150-3").await;
    user.click("Write…").await;
    user.see("Open the write window?", PATIENCE).await;
    user.shot("no-window").await;
    assert_eq!(plc.messages().len(), 0, "nothing is asked of the device before somebody opens the window");
    user.click_part("window-open").await;
    let bytes = user.find("the bytes", &part("write-bytes"), PATIENCE).await;
    assert_eq!(bytes, "10 03 20 04 24 96 30 03 01 02 03 04");
    user.see("Confirm within", PATIENCE).await;
    user.shot("asked").await;
    user.click_part("write-cancel").await;
    user.gone("the question", &part("write-dialog")).await;
    user.shot("declined").await;
    assert_eq!(writes(&plc), [[0; 0]; 0], "nothing is written before the answer, nor after a no");

    user.click("Write…").await;
    user.click_part("write-confirm").await;
    user.see("Success, without data.", PATIENCE).await;
    user.shot("written").await;
    assert_eq!(writes(&plc), [[0x10, 3, 0x20, 4, 0x24, 150, 0x30, 3, 1, 2, 3, 4]], "sent once");

    user.see("Writing is possible.", PATIENCE).await;
    user.click_part("window-close").await;
    user.gone("the banner", &part("write-banner")).await;
    user.shot("closed").await;
    user.close().await;
}

/// What has been written; what is there is read before and after.
fn writes(plc: &FakePlc) -> Vec<Vec<u8>> {
    plc.messages().into_iter().filter(|message| message.first() != Some(&0x0E)).collect()
}

#[tokio::test]
async fn a_write_that_repeats_itself_asks_twice() {
    let relay = Relay::start().await;
    let plc = FakePlc::start(fake_plc::answering(&[])).await;
    let block = with(block::set(&plc.path(), 4, 150, 3, "01"), "/CtrlCfg", json!({ "TriggerType": 100 }));
    relay.rest.create(&block).await;
    let journey = Journey::start("write_cyclic").await;
    let mut user = journey.open("user", &relay.page()).await;
    user.click("set-4-150-3").await;
    user.click_part("in-switch").await;
    user.click_part("window-open").await;
    user.see("Confirm within", PATIENCE).await;
    user.shot("asked").await;
    user.click_part("write-confirm").await;
    user.see("every 100 ms", PATIENCE).await;
    user.shot("asked-again").await;
    assert_eq!(writes(&plc).len(), 0, "one yes is not enough");
    user.click_part("write-confirm").await;
    eventually("it writes", PATIENCE, async || (writes(&plc).len() >= 3).then_some(())).await;
    user.shot("writing").await;
    user.click_part("in-switch").await;
    user.find("IN is off", &format!("{}[@aria-checked='false']", part("in-switch")), PATIENCE).await;
    user.close().await;
}
