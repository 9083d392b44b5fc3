//! What lies on the desk of `/code` and what is taken from it: kept over a reload, copied, cleaned of what nobody sees.

use cipdeck_tests::PATIENCE;
use cipdeck_tests::block;
use cipdeck_tests::browser::{Browser, Journey, part};
use cipdeck_tests::relay::Relay;
use serde_json::{Value, json};
use thirtyfour::{By, Key};

const PRODUCT_NAME: &str = "0E 03 20 01 24 01 30 07";

#[tokio::test]
async fn a_text_survives_leaving_and_what_was_saved_is_not_saved_twice() {
    let relay = Relay::start().await;
    let journey = Journey::start("desk_kept").await;
    let mut user = journey.open("user", &page(&relay)).await;
    let text = format!("{PRODUCT_NAME}\n\n0E 03 20 01 24 01 30 06");
    paste(&user, &text).await;
    user.see("2 blocks", PATIENCE).await;
    user.find("that it is kept", &part("kept"), PATIENCE).await;
    user.click_at(&format!("({})[2]", part("keep")), "the second block").await;
    user.fill("Device of the blocks whose text names none", "192.168.1.7").await;
    user.click_part("save").await;
    user.see("1 saved.", PATIENCE).await;
    user.shot("saved").await;
    user.click("SEND_REQ").await;
    user.see("No SEND_REQ and no DATA_EXCH yet", PATIENCE).await;
    user.driver().back().await.expect("the way back");
    user.see("2 blocks", PATIENCE).await;
    assert_eq!(typed(&user).await, text);
    user.find("what was saved", &part("saved"), PATIENCE).await;
    user.see("4,192.168.1.7", PATIENCE).await;
    assert!(!user.can_use("save").await, "one is saved, the other one is not wanted");
    user.shot("back").await;
    paste(&user, &"x := 1;\n".repeat(1 << 18)).await;
    user.find("that it is too much", &part("not-kept"), PATIENCE).await;
    user.driver().refresh().await.expect("a reload");
    user.see("What can be read", PATIENCE).await;
    paste(&user, PRODUCT_NAME).await;
    user.find("that it is kept", &part("kept"), PATIENCE).await;
    user.click_part("clear").await;
    user.see("What can be read", PATIENCE).await;
    user.driver().refresh().await.expect("a reload");
    user.see("What can be read", PATIENCE).await;
    assert_eq!(typed(&user).await, "", "cleared is cleared");
    user.close().await;
}

#[tokio::test]
async fn what_is_copied_is_the_code_and_can_be_pasted() {
    let relay = Relay::start().await;
    let id = relay.rest.create(&block::product_name("4,192.168.1.100")).await;
    let journey = Journey::start("desk_copied").await;
    let mut user = journey.open("user", &format!("{}/{id}?as=ccw-st", page(&relay))).await;
    let rights = json!({ "permissions": ["clipboardReadWrite", "clipboardSanitizedWrite"] });
    user.chromium("Browser.grantPermissions", rights).await;
    let shown = "return [...document.querySelectorAll('.code-line')].map(line => line.textContent).join('')";
    user.find("code", &part("code"), PATIENCE).await;
    let shown = user.script(shown).await;
    user.click_part("copy").await;
    user.see("Copied.", PATIENCE).await;
    user.shot("copied").await;
    user.go(&page(&relay)).await;
    user.until("the field takes a paste", PATIENCE, async |driver| {
        let field = driver.find(By::XPath(part("code-text"))).await.ok()?;
        field.send_keys(Key::Control + "v").await.ok()
    })
    .await;
    user.see("1 block", PATIENCE).await;
    let lines = |text: &str| text.trim_end().replace("\r\n", "\n");
    assert_eq!(lines(&typed(&user).await), lines(shown.as_str().expect("a text")));
    user.shot("pasted").await;
    user.close().await;
}

#[tokio::test]
async fn what_nobody_sees_is_named_and_can_be_taken_out() {
    let relay = Relay::start().await;
    let journey = Journey::start("desk_unseen").await;
    let mut user = journey.open("user", &page(&relay)).await;
    let words = ["0000", "03\u{AD}0E", "0120", "0124", "0730"];
    let words = words.iter().enumerate().map(|(at, word)| format!("Data[{at}]\u{A0}:= 16#{word};\n"));
    let call = "Management[2] := 30;\nManagement[3] := 10;\n\
                SEND_REQ(ADDR('0.2.0.192.168.1.102'), 16#000E, Data, Management, Reply);\n";
    paste(&user, &(words.collect::<String>() + call)).await;
    let said = user.find("what nobody sees", &part("unseen"), PATIENCE).await;
    assert!(said.contains("6 characters cannot be seen, the first in line 1"), "{said}");
    user.shot("unseen").await;
    user.click_part("take-out").await;
    user.see("1 block", PATIENCE).await;
    user.gone("the hint", &part("unseen")).await;
    let request = user.find("the request", &part("request"), PATIENCE).await;
    assert_eq!(request, PRODUCT_NAME);
    assert!(user.can_use("save").await);
    user.shot("taken-out").await;
    user.close().await;
}

fn page(relay: &Relay) -> String {
    format!("{}code", relay.page())
}

/// As a paste: keys would be one event for each letter.
async fn paste(user: &Browser, text: &str) {
    user.find("the field", &part("code-text"), PATIENCE).await;
    let script = format!(
        "const area = document.getElementById('code-text'); area.value = {}; \
         area.dispatchEvent(new InputEvent('input', {{ bubbles: true }})); return 0",
        Value::from(text)
    );
    user.script(&script).await;
}

/// What is in the field.
async fn typed(user: &Browser) -> String {
    user.find("the field", &part("code-text"), PATIENCE).await;
    let text = user.script("return document.getElementById('code-text').value").await;
    text.as_str().expect("a text").to_owned()
}
