//! The data of a block, field by field: nobody packs a REAL by hand.

use cipdeck_tests::PATIENCE;
use cipdeck_tests::block::{self, with};
use cipdeck_tests::browser::{Browser, Journey, part};
use cipdeck_tests::relay::Relay;
use serde_json::json;

#[tokio::test]
async fn a_blocks_data_is_entered_and_shown_as_numbers() {
    let relay = Relay::start().await;
    // The built-in device: parameter 43 is a REAL, the input assembly is 32 bytes.
    let write = relay.rest.create(&block::set("0,0", 147, 43, 9, "00000000")).await;
    let read = with(block::get("0,0", 147, 43, 9), "/ResLayout", json!("speed: REAL"));
    let read = relay.rest.create(&read).await;
    let journey = Journey::start("data").await;
    let mut user = journey.open("user", &relay.page()).await;
    user.click("set-147-43-9").await;
    user.click_part("data").await;
    user.see("Data, field by field", PATIENCE).await;
    fill(&user, "req-layout", "speed: REEL").await;
    user.see("at character 8", PATIENCE).await;
    user.shot("no-type").await;
    fill(&user, "req-layout", "speed: REAL").await;
    fill(&user, "field-0", "12,5").await;
    user.see("write a point, not a comma", PATIENCE).await;
    user.shot("no-number").await;
    fill(&user, "field-0", "12.5").await;
    let bytes = user.find("the bytes", &part("req-data"), PATIENCE).await;
    assert_eq!(bytes, "00 00 48 41");
    user.click_part("store").await;
    user.gone("what is not saved", &part("unsaved")).await;
    user.shot("stored").await;
    let stored = relay.rest.get(&format!("blocks/{write}")).await.body;
    assert_eq!((&stored["ReqData"], &stored["ReqLayout"]), (&json!("00004841"), &json!("speed: REAL")));

    let ran = relay.rest.run(&read).await;
    assert_eq!(ran["last"]["decoded"][0]["name"], "speed", "{ran}");
    user.go(&format!("{}office/data/{read}", relay.page())).await;
    let value = user.find("the value", &part("reply-value"), PATIENCE).await;
    assert_eq!(value, "30");
    user.shot("reply").await;
    user.close().await;
}

async fn fill(user: &Browser, id: &str, text: &str) {
    user.fill_at(&format!("//*[@id='{id}']"), id, text).await;
}
