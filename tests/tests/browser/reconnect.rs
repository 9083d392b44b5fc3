//! The relay dies and comes back while the page is open.

use cipdeck_tests::PATIENCE;
use cipdeck_tests::block;
use cipdeck_tests::browser::{Journey, field, part};
use cipdeck_tests::command::Service;
use cipdeck_tests::rest::Rest;
use serde_json::json;
use tempfile::TempDir;

#[tokio::test]
async fn the_page_says_so_and_goes_on_by_itself() {
    let folder = TempDir::new().expect("a temporary folder");
    let relay = Service::serve("127.0.0.1:0", folder.path()).await;
    let address = relay.address.clone();
    Rest::new(&address).create(&block::product_name("0,0")).await;
    let journey = Journey::start("reconnect").await;
    let mut user = journey.open("user", &format!("http://{address}/")).await;
    user.click("get-1-1-7").await;
    user.click("Run").await;
    user.see("cipdeck demo drive", PATIENCE).await;

    relay.process.kill();
    user.see("relay: reconnecting", PATIENCE).await;
    user.shot("reconnecting").await;
    drop(relay);
    let _relay = Service::serve(&address, folder.path()).await;
    user.see("relay: connected", PATIENCE).await;
    user.shot("connected").await;
    user.click("Run").await;
    user.see("cipdeck demo drive", PATIENCE).await;
    user.close_with_expected_errors().await;
}

#[tokio::test]
async fn words_that_are_typed_meanwhile_stay_and_run_when_the_relay_is_back() {
    let folder = TempDir::new().expect("a temporary folder");
    let relay = Service::serve("127.0.0.1:0", folder.path()).await;
    let address = relay.address.clone();
    let words = json!({
        "name": "words", "kind": "SEND_REQ", "Dialect": "ETC100", "Address": "ADDR('0.2.0.0.0.0.0')",
        "Data_to_Send": "0000 030E 0120 0124 0630", "Management_Param": [0, 0, 30, 10],
    });
    let id = Rest::new(&address).create(&words).await;
    let journey = Journey::start("reconnect_words").await;
    let mut user = journey.open("user", &format!("http://{address}/words/{id}")).await;
    user.click("Run").await;
    user.see("the device agreed", PATIENCE).await;

    relay.process.kill();
    user.see("relay: reconnecting", PATIENCE).await;
    user.find("that it is not live", &part("stale"), PATIENCE).await;
    let why = user.find("why it cannot run", &part("obstacle"), PATIENCE).await;
    assert!(why.contains("needs a relay") && !user.can_use("run").await, "{why}");
    user.fill("Attribute", "7").await;
    user.see("not saved", PATIENCE).await;
    assert!(!user.can_use("save").await);
    user.resize(1024, 820).await;
    let excess = "return document.scrollingElement.scrollWidth - window.innerWidth";
    assert!(user.script(excess).await.as_i64() <= Some(0));
    user.shot("reconnecting").await;
    drop(relay);
    let _relay = Service::serve(&address, folder.path()).await;
    user.see("relay: connected", PATIENCE).await;
    let typed = user.driver().find(thirtyfour::By::XPath(field("Attribute"))).await.expect("the field");
    assert_eq!(typed.prop("value").await.ok().flatten().as_deref(), Some("7"), "it is not overwritten");
    user.click("Run").await;
    user.see("cipdeck demo drive", PATIENCE).await;
    user.see("saved, revision 2", PATIENCE).await;
    user.shot("connected").await;
    user.close_with_expected_errors().await;
}

#[tokio::test]
async fn code_is_read_without_a_relay_and_saved_when_it_is_back() {
    let folder = TempDir::new().expect("a temporary folder");
    let relay = Service::serve("127.0.0.1:0", folder.path()).await;
    let address = relay.address.clone();
    let journey = Journey::start("reconnect_code").await;
    let mut user = journey.open("user", &format!("http://{address}/code")).await;
    user.see("What can be read", PATIENCE).await;

    relay.process.kill();
    user.fill_at(&part("code-text"), "the code", "0E 03 20 01 24 01 30 07").await;
    user.see("1 block", PATIENCE).await;
    user.click_part("save").await;
    user.see("It may be saved or not", PATIENCE).await;
    user.shot("no-answer").await;
    drop(relay);
    let _relay = Service::serve(&address, folder.path()).await;
    user.click_part("save").await;
    user.see("1 saved.", PATIENCE).await;
    user.shot("saved").await;
    let blocks = Rest::new(&address).get("blocks").await.body;
    assert_eq!(blocks.as_array().map(Vec::len), Some(1), "{blocks}");
    user.close_with_expected_errors().await;
}
