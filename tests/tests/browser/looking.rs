//! Somebody who may look only, in the documents of words and of code: everything is shown, nothing can be changed or sent,
//! and the reason stands there.

use cipdeck_shared::api::Role;
use cipdeck_tests::PATIENCE;
use cipdeck_tests::block;
use cipdeck_tests::browser::{Browser, Journey, control, field, part};
use cipdeck_tests::relay::Relay;
use serde_json::json;
use tempfile::TempDir;

#[tokio::test]
async fn a_viewer_sees_the_words_and_sends_nothing() {
    let (relay, words, _) = relay_for_viewers().await;
    let journey = Journey::start("looking_words").await;
    let mut user = journey.open("vera", &format!("{}words", relay.page())).await;
    user.see("look-at-me", PATIENCE).await;
    user.gone("a way to make blocks", &control("New block")).await;
    user.shot("list").await;
    user.click("look-at-me").await;
    user.see("Blocks are changed by engineers only.", PATIENCE).await;
    let why = user.find("why it cannot run", &part("obstacle"), PATIENCE).await;
    assert!(why.contains("You may look only"), "{why}");
    for button in ["run", "save", "duplicate", "delete"] {
        assert!(!user.can_use(button).await, "{button}");
    }
    for label in ["Address", "Data_to_Send", "Service", "Management_Param[2]"] {
        assert!(!can_type(&user, label).await, "{label}");
    }
    user.point_at("//*[@data-test='sent-words']//button[@data-byte='2']").await;
    user.see("Get_Attribute_Single", PATIENCE).await;
    user.shot("block").await;
    user.go(&format!("{}words/new", relay.page())).await;
    user.see("Blocks are changed by engineers only.", PATIENCE).await;
    user.shot("new").await;
    let before = relay.rest.get(&format!("blocks/{words}")).await.body;
    assert_eq!(before["revision"], 1);
    user.close().await;
}

#[tokio::test]
async fn a_viewer_reads_and_writes_code_and_saves_nothing() {
    let (relay, _, generic) = relay_for_viewers().await;
    let journey = Journey::start("looking_code").await;
    let mut user = journey.open("vera", &format!("{}code", relay.page())).await;
    user.fill_at(&part("code-text"), "the code", "0E 03 20 01 24 01 30 07").await;
    user.see("1 block", PATIENCE).await;
    user.see("Engineers save blocks", PATIENCE).await;
    assert!(!user.can_use("save").await);
    user.shot("in").await;
    user.go(&format!("{}code/{generic}?as=l5x", relay.page())).await;
    user.find("the code", &part("code"), PATIENCE).await;
    assert!(user.can_use("copy").await);
    user.click_at("//button[@data-kind='DATA_EXCH']", "DATA_EXCH").await;
    user.find("both beside each other", &part("pair"), PATIENCE).await;
    user.see("Engineers save blocks", PATIENCE).await;
    assert!(!user.can_use("save-another").await);
    user.shot("out").await;
    let blocks = relay.rest.get("blocks").await.body;
    assert_eq!(blocks.as_array().map(Vec::len), Some(2), "{blocks}");
    user.close().await;
}

/// A relay whose visitors may look only, with a block of words and one without.
async fn relay_for_viewers() -> (Relay, String, String) {
    let relay = Relay::start().await;
    let words = json!({
        "name": "look-at-me", "kind": "SEND_REQ", "Dialect": "ETC100", "Address": "ADDR('0.2.0.0.0.0.0')",
        "Data_to_Send": "0000 030E 0120 0124 0730", "Management_Param": [0, 0, 30, 10],
    });
    let words = relay.rest.create(&words).await;
    let generic = relay.rest.create(&block::product_name("4,192.168.1.100")).await;
    let folder: TempDir = relay.stop().await;
    (Relay::start_with(folder, |settings| settings.with_local(Role::Viewer)).await, words, generic)
}

async fn can_type(user: &Browser, label: &str) -> bool {
    user.until(&format!("the field {label}"), PATIENCE, async |driver| {
        let found = driver.find(thirtyfour::By::XPath(field(label))).await.ok()?;
        let is_read_only = found.prop("readOnly").await.ok()?.as_deref() == Some("true");
        Some(found.is_enabled().await.ok()? && !is_read_only)
    })
    .await
}
