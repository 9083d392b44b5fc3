//! A block made, run and corrected in the editor.

use cipdeck_tests::PATIENCE;
use cipdeck_tests::block;
use cipdeck_tests::browser::{Browser, Journey, part};
use cipdeck_tests::fake_plc::{self, FakePlc};
use cipdeck_tests::peers::CiplinkAdapter;
use cipdeck_tests::relay::Relay;
use thirtyfour::Key;

#[tokio::test]
async fn a_block_made_in_the_editor_reads_a_device_and_explains_its_refusal() {
    let relay = Relay::start().await;
    relay.rest.create(&block::product_name("0,0")).await;
    let adapter = CiplinkAdapter::start();
    let journey = Journey::start("editor").await;
    let mut user = journey.open("user", &relay.page()).await;
    user.click("New block").await;
    user.fill("Name", "vendor-id").await;
    user.fill("Path", &adapter.path()).await;
    user.fill("Attribute", "1").await;
    user.shot("made").await;
    user.click("Run").await;
    user.find("DN", &lit("DN"), PATIENCE).await;
    let value = user.find("a value", &part("decoded-value"), PATIENCE).await;
    assert!(value.starts_with(&CiplinkAdapter::VENDOR_ID.to_string()), "the vendor id: {value}");
    user.shot("vendor-id").await;

    user.fill("Class", "238").await;
    user.click("Run").await;
    user.find("ER", &lit("ER"), PATIENCE).await;
    let codes = user.find("the numbers", &part("error-codes"), PATIENCE).await;
    assert!(codes.contains("224") && codes.contains("5 (0x05)"), "{codes}");
    let name = user.find("the error in words", &part("error-name"), PATIENCE).await;
    assert!(name.to_lowercase().contains("path destination unknown"), "{name}");
    user.shot("refused").await;

    user.fill("Service", "300").await;
    let finding = finding_at(&user, "AppCfg-Service").await;
    assert!(finding.contains("1 to 127"), "{finding}");
    assert!(!user.can_use("run").await, "Run is disabled");
    user.shot("finding").await;
    user.close().await;
}

#[tokio::test]
async fn bad_input_is_a_finding_at_its_field_and_nothing_is_sent() {
    let relay = Relay::start().await;
    let plc = FakePlc::start(fake_plc::answering(&[1])).await;
    let id = relay.rest.create(&block::product_name(&plc.path())).await;
    let journey = Journey::start("editor_bad_input").await;
    let mut user = journey.open("user", &relay.page()).await;
    user.click("get-1-1-7").await;
    let long = "00".repeat(491);
    let three_hops = format!("{},1,0,1,0", plc.path());
    let rows = [
        ("Service", "AppCfg-Service", "1x", "14"),
        ("Class", "AppCfg-Class", "-1", "1"),
        ("Path", "TargetCfg-Path", "", &plc.path()),
        ("Path", "TargetCfg-Path", &three_hops, &plc.path()),
        ("Path", "TargetCfg-Path", "6,1", &plc.path()),
        ("ReqData", "ReqData", &long, ""),
        ("ReqData", "ReqData", "0A 0", ""),
    ];
    for (number, (label, field, wrong, right)) in rows.into_iter().enumerate() {
        user.fill(label, wrong).await;
        let finding = finding_at(&user, field).await;
        assert!(finding.starts_with("Error"), "{label} {wrong}: {finding}");
        assert!(!user.can_use("run").await, "{label} {wrong}: Run is disabled");
        assert!(!user.can_use("save").await, "{label} {wrong}: Save is disabled");
        user.shot(&format!("{number}-{label}")).await;
        user.fill(label, right).await;
        user.until("Run can be used again", PATIENCE, async |_| user.can_use("run").await.then_some(()))
            .await;
    }
    assert_eq!(relay.rest.get(&format!("blocks/{id}")).await.body["revision"], 1, "nothing is stored");
    assert_eq!(plc.requests().len(), 0, "nothing is sent");
    user.close().await;
}

#[tokio::test]
async fn every_byte_says_what_it_is() {
    let relay = Relay::start().await;
    let id = relay.rest.create(&block::with(block::product_name("0,0"), "/name", "product-name")).await;
    relay.rest.run(&id).await;
    let journey = Journey::start("bytes").await;
    let mut user = journey.open("user", &relay.page()).await;
    user.click("product-name").await;
    user.point_at(&byte("request-bytes", "0E")).await;
    let pointed =
        user.find("what 0E is", &explanation("request-bytes", "Get_Attribute_Single"), PATIENCE).await;
    assert!(pointed.to_lowercase().contains("service"), "{pointed}");
    user.shot("pointed-at").await;
    user.press(&byte("request-bytes", "0E"), Key::Right).await;
    user.find("the next byte", &explanation("request-bytes", "3 words"), PATIENCE).await;
    user.press(&byte("reply-bytes", "8E"), Key::End).await;
    user.find("the product name", &explanation("reply-bytes", "cipdeck demo drive"), PATIENCE).await;
    user.shot("walked-to").await;
    user.close().await;
}

/// XPath of the button of the part that begins with a byte.
fn byte(view: &str, byte: &str) -> String {
    format!("({}//button[starts-with(@aria-label, '{byte}')])[1]", part(view))
}

/// XPath of an explanation that contains a text.
fn explanation(view: &str, text: &str) -> String {
    format!("{}//*[@class='explanation'][contains(., '{text}')]", part(view))
}

async fn finding_at(user: &Browser, field: &str) -> String {
    user.find(&format!("a finding at {field}"), &format!("//*[@id='field-{field}-finding']"), PATIENCE).await
}

/// XPath of a status bit that is set.
fn lit(bit: &str) -> String {
    format!("{}//*[@data-bit='{bit}' and @data-on='true']", part("status-bits"))
}
