//! The list of blocks, and two people at one block.

use cipdeck_tests::PATIENCE;
use cipdeck_tests::block;
use cipdeck_tests::browser::{Browser, Journey, part};
use cipdeck_tests::relay::Relay;
use cipdeck_tests::wait::eventually;
use serde_json::Value;

#[tokio::test]
async fn blocks_are_duplicated_renamed_copied_pasted_and_deleted() {
    let relay = Relay::start().await;
    relay.rest.create(&block::product_name("0,0")).await;
    let journey = Journey::start("deck").await;
    let mut user = journey.open("user", &relay.page()).await;
    user.click("get-1-1-7").await;
    user.click("Duplicate").await;
    user.find("two entries", &format!("({})[2]", part("entry")), PATIENCE).await;

    user.click("Rename").await;
    user.fill("New name", "the copy").await;
    user.shot("rename").await;
    user.click_part("confirm-rename").await;
    user.find("the new name", &entry("the copy"), PATIENCE).await;

    user.click("Copy").await;
    let script = "return document.querySelector('[data-test=copy-dialog] textarea')?.value ?? ''";
    let copied = user.until("JSON", PATIENCE, async |_| {
        let text = user.script(script).await;
        serde_json::from_str::<Value>(text.as_str()?).ok()
    });
    let copied = copied.await;
    assert_eq!(
        (&copied["name"], &copied["AppCfg"]["Attribute"]),
        (&Value::from("the copy"), &Value::from(7))
    );
    user.shot("copy").await;
    user.click("Close").await;

    user.click("Paste").await;
    user.fill("JSON of a block", "{\"name\":").await;
    user.click_part("confirm-paste").await;
    user.see("This is not a block", PATIENCE).await;
    user.shot("paste-unreadable").await;
    let pasted = block::with(copied, "/name", "pasted").to_string();
    user.fill("JSON of a block", &pasted).await;
    user.click_part("confirm-paste").await;
    user.find("the pasted block", &entry("pasted"), PATIENCE).await;

    user.click("Delete").await;
    user.see("This cannot be undone", PATIENCE).await;
    user.shot("delete").await;
    user.click_part("confirm-delete").await;
    user.gone("the deleted block", &entry("pasted")).await;
    user.click("the copy").await;
    save_if_needed(&mut user).await;
    eventually("what is stored", PATIENCE, async || {
        let stored = relay.rest.get("blocks").await.body;
        let names: Vec<_> = stored.as_array()?.iter().map(|block| block["name"].clone()).collect();
        (names == ["get-1-1-7", "the copy"]).then_some(())
    })
    .await;
    user.shot("end").await;
    user.close().await;
}

#[tokio::test]
async fn who_comes_second_sees_both_versions_and_chooses() {
    let relay = Relay::start().await;
    let id = relay.rest.create(&block::product_name("0,0")).await;
    let journey = Journey::start("deck_conflict").await;
    let mut first = journey.open("first", &relay.page()).await;
    let mut second = journey.open("second", &relay.page()).await;
    for user in [&mut first, &mut second] {
        user.click("get-1-1-7").await;
    }
    second.fill("Attribute", "2").await;
    first.fill("Attribute", "1").await;
    first.click("Save").await;
    first.see("saved, revision 2", PATIENCE).await;
    if second.can_use("save").await {
        second.click("Save").await;
    }
    second.find("both versions", &part("conflict"), PATIENCE).await;
    second.shot("conflict").await;
    assert_eq!(
        relay.rest.get(&format!("blocks/{id}")).await.body["AppCfg"]["Attribute"],
        1,
        "nothing is overwritten"
    );
    second.click("Store mine").await;
    second.see("saved, revision 3", PATIENCE).await;
    first.see("saved, revision 3", PATIENCE).await;
    assert_eq!(relay.rest.get(&format!("blocks/{id}")).await.body["AppCfg"]["Attribute"], 2);
    first.close().await;
    // A refused Save is an answer that the browser logs as an error.
    second.close_with_expected_errors().await;
}

async fn save_if_needed(user: &mut Browser) {
    if user.can_use("save").await {
        user.click("Save").await;
    }
}

/// XPath of a block in the list.
fn entry(name: &str) -> String {
    format!("{}//*[normalize-space(.)='{name}']", part("entry"))
}

#[tokio::test]
async fn every_view_has_an_address_that_survives_back_and_reload() {
    let relay = Relay::start().await;
    relay.rest.create(&block::product_name("0,0")).await;
    let journey = Journey::start("addresses").await;
    let mut user = journey.open("user", &relay.page()).await;
    user.click("Monitor").await;
    user.click("get-1-1-7").await;
    user.find("the block", &part("form"), PATIENCE).await;
    let address = user.driver().current_url().await.expect("an address").to_string();

    user.driver().back().await.expect("there is a page before");
    user.see("of 1 failing", PATIENCE).await;
    user.driver().forward().await.expect("there is a page after");
    user.find("the block", &part("form"), PATIENCE).await;
    user.driver().refresh().await.expect("the page loads again");
    user.find("the block", &part("form"), PATIENCE).await;
    assert_eq!(user.driver().current_url().await.expect("an address").as_str(), address);
    user.driver().goto(format!("{}no/such/page", relay.page())).await.expect("the page loads");
    user.see("There is no such page", PATIENCE).await;
    user.shot("no-such-page").await;
    user.click("To the deck").await;
    user.click("get-1-1-7").await;
    user.find("the block", &part("form"), PATIENCE).await;
    user.close().await;
}
