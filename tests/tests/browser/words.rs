//! SEND_REQ and DATA_EXCH in Control Expert's terms, against the built-in simulated device.

use cipdeck_tests::PATIENCE;
use cipdeck_tests::browser::{Browser, Journey, field, part};
use cipdeck_tests::command::Service;
use cipdeck_tests::relay::Relay;
use serde_json::{Value, json};

const PRODUCT_NAME: &str = "0000 030E 0120 0124 0730";

#[tokio::test]
async fn a_send_req_is_typed_as_words_and_runs_as_in_the_controller() {
    let relay = Relay::start().await;
    let journey = Journey::start("words").await;
    let mut user = journey.open("user", &page(&relay, "")).await;
    user.see("No SEND_REQ and no DATA_EXCH yet", PATIENCE).await;
    user.shot("empty").await;
    user.click("New block").await;
    user.click_part("preset-empty").await;
    user.shot("new").await;
    user.click_part("create").await;
    user.see("SEND_REQ for TSX ETC 100", PATIENCE).await;
    user.shot("no-words").await;
    user.fill("Data_to_Send", PRODUCT_NAME).await;
    assert_eq!(value(&user, "Service").await, "14", "the fields show the words");
    user.see("Get_Attribute_Single", PATIENCE).await;
    assert_eq!(value(&user, "Management_Param[3]").await, "10");
    user.point_at("//*[@data-test='sent-words']//button[@data-byte='3']").await;
    user.see("3 words, 6 bytes", PATIENCE).await;
    user.shot("typed").await;
    // Reloaded before it was ever stored.
    user.driver().refresh().await.unwrap();
    user.see("not saved", PATIENCE).await;
    assert_eq!(value(&user, "Data_to_Send").await, PRODUCT_NAME);

    user.click("Run").await;
    verdict(&user, "good", "Exchange correct, the device agreed").await;
    user.see("cipdeck demo drive", PATIENCE).await;
    let activity = user.find("the activity bit", &part("activity"), PATIENCE).await;
    assert!(activity.contains("up at the start, down at the end"), "{activity}");
    let length = user.find("the length", &part("live-length"), PATIENCE).await;
    assert!(length.starts_with("length: 10 bytes before, 23 bytes received"), "{length}");
    let lamp = user.find("the lamp", &part("activity-bit"), PATIENCE).await;
    assert_eq!(lamp.trim(), "activity bit 0");
    assert_eq!(user.find("word 0", &part("word-0"), PATIENCE).await, "0100", "exchange number 1, not active");
    let report = user.find("the report", &part("communication-report"), PATIENCE).await;
    assert_eq!(report, "Exchange correct");
    user.point_at("//*[@data-test='received-words']//button[@data-byte='0']").await;
    user.see("reply to", PATIENCE).await;
    user.shot("good").await;

    user.fill("Class", "238").await;
    assert_eq!(value(&user, "Data_to_Send").await, "0000 030E EE20 0124 0730", "the words show the fields");
    user.click("Run").await;
    verdict(&user, "refused", "Exchange correct, but the device refused: 16#05").await;
    let report = user.find("the report", &part("communication-report"), PATIENCE).await;
    assert_eq!(report, "Exchange correct", "communication report 0 all the same");
    user.shot("refused").await;
    user.click_at("//a[contains(@class, 'back')]", "All blocks").await;
    user.see("but the device refused: 16#05", PATIENCE).await;
    user.shot("list").await;
    user.close().await;
}

#[tokio::test]
async fn the_other_forms_have_their_own_words_and_a_write_asks() {
    let relay = Relay::start().await;
    let journey = Journey::start("words_forms").await;
    let mut user = journey.open("user", &page(&relay, "/new")).await;
    user.click_part("form-etc101").await;
    user.fill("IP address of the device", "192.168.1.256").await;
    user.see("“256” is over 255", PATIENCE).await;
    user.shot("wrong-ip").await;
    assert!(!user.can_use("create").await);
    user.fill("IP address of the device", "192.168.1.102").await;
    user.click_part("preset-modbus-read").await;
    user.click_part("create").await;
    user.see("SEND_REQ for TSX ETC 101", PATIENCE).await;
    assert_eq!(value(&user, "Data_to_Send").await, "0000 C0A8 0166 024E 4420 0124 0000 000A");
    assert_eq!(value(&user, "IP").await, "192.168.1.102");
    assert_eq!(value(&user, "Data").await, "0 10", "as UINT");
    user.point_at("//*[@data-test='sent-words']//button[@data-byte='3']").await;
    user.see("192, its 1st number", PATIENCE).await;
    user.shot("etc101").await;
    user.fill("IP", "0.0.0.0").await;
    assert_eq!(value(&user, "Data_to_Send").await, "0000 0000 0000 024E 4420 0124 0000 000A");
    user.click("Run").await;
    verdict(&user, "good", "Exchange correct, the device agreed: 24 bytes").await;
    user.shot("modbus-read").await;

    user.click_at("//a[contains(@class, 'back')]", "All blocks").await;
    user.click("New block").await;
    user.click_part("form-data-exch").await;
    user.click_part("preset-modbus-write").await;
    user.click_part("create").await;
    assert_eq!(value(&user, "Address").await, "ADDMX('0.2.0{0.0.0.0}UNC.CIP')");
    user.shot("data-exch").await;
    user.click("Write…").await;
    user.see("Open the write window?", PATIENCE).await;
    user.click_part("window-open").await;
    user.see("Confirm within", PATIENCE).await;
    let bytes = user.find("the bytes", &part("write-bytes"), PATIENCE).await;
    assert_eq!(bytes, "50 02 20 44 24 01 64 00 01 00 D2 04");
    user.shot("asked").await;
    user.click_part("write-confirm").await;
    verdict(&user, "good", "Exchange correct, the device agreed").await;
    user.see("Written, and read back as written.", PATIENCE).await;
    user.shot("written").await;
    user.close().await;
}

#[tokio::test]
async fn what_is_typed_wrong_stays_and_is_said_where_it_is() {
    let relay = Relay::start().await;
    let id = relay.rest.create(&send_req("wrong", "ADDR('0.2.0.0.0.0.0')", PRODUCT_NAME)).await;
    let journey = Journey::start("words_wrong").await;
    let mut user = journey.open("user", &page(&relay, &format!("/{id}"))).await;
    for (words, says) in [
        ("0000 030", "'030' at character 6"),
        ("0000 030E0", "'030E0' at character 6"),
        ("0000 03GE", "'03GE' at character 6"),
        ("", "must not be empty"),
    ] {
        user.fill("Data_to_Send", words).await;
        user.see(says, PATIENCE).await;
        assert_eq!(value(&user, "Data_to_Send").await, words, "it stays");
        assert!(!user.can_use("run").await, "{words}");
    }
    user.fill("Data_to_Send", "0000 030").await;
    user.see("there are no fields", PATIENCE).await;
    user.shot("half-a-word").await;
    user.fill("Data_to_Send", PRODUCT_NAME).await;
    user.fill("Instance", "1x").await;
    user.find("what waits", &part("waiting-parts"), PATIENCE).await;
    assert_eq!(value(&user, "Data_to_Send").await, PRODUCT_NAME);
    user.click_part("path-bytes").await;
    assert_eq!(value(&user, "Path").await, "20 01 24 01 30 07");
    user.click_part("path-numbers").await;
    assert_eq!(value(&user, "Instance").await, "1x", "nothing is lost");
    user.shot("waiting").await;
    user.click_part("forget-parts").await;
    assert_eq!(value(&user, "Instance").await, "1");
    user.fill("Address", "ADDR('0.2.0.192.168.1.256')").await;
    user.see("over 255", PATIENCE).await;
    user.find("the place", &part("marked"), PATIENCE).await;
    user.shot("address").await;
    user.fill("Address", "ADDR('0.2.0.0.0.0.0')").await;
    user.fill("Management_Param[2]", "3s").await;
    user.find("its finding", "//*[@id='field-Management_Param-2-finding']", PATIENCE).await;
    user.fill("Management_Param[2]", "0").await;
    user.find("the loud word", &part("waits-for-ever"), PATIENCE).await;
    user.fill("Management_Param[2]", "30").await;
    user.click_part("auto-length").await;
    user.fill("Management_Param[3]", "8").await;
    user.point_at("//*[@data-test='sent-words']//button[@data-byte='8']").await;
    user.see("Management_Param[3] ends before it", PATIENCE).await;
    user.shot("length").await;
    user.close().await;
}

#[tokio::test]
async fn a_changed_block_is_not_overwritten_and_a_device_that_is_gone_is_said() {
    let relay = Relay::start().await;
    let simulator = Service::simulate("127.0.0.1:0", &[]).await;
    let address = format!("ADDR('0.2.0.{}')", simulator.address);
    let id = relay.rest.create(&send_req("shared", &address, PRODUCT_NAME)).await;
    let journey = Journey::start("words_conflict").await;
    let mut user = journey.open("user", &page(&relay, &format!("/{id}"))).await;
    user.see("a controller always uses 44818", PATIENCE).await;
    user.fill("Attribute", "6").await;
    let mut other = send_req("shared", &address, PRODUCT_NAME);
    other["Management_Param"] = json!([0, 0, 50, 10]);
    other["revision"] = json!(1);
    relay.rest.put(&format!("blocks/{id}"), &other).await;
    user.click("Save").await;
    user.find("the choice", &part("conflict"), PATIENCE).await;
    user.see("Data_to_Send", PATIENCE).await;
    user.shot("conflict").await;
    user.click_part("take-theirs").await;
    user.see("saved, revision 2", PATIENCE).await;
    assert_eq!(value(&user, "Management_Param[2]").await, "50");
    user.click("Run").await;
    verdict(&user, "good", "Exchange correct").await;
    drop(simulator);
    user.click("Run").await;
    verdict(&user, "failed", "Report 16#").await;
    user.shot("failed").await;
    user.close_with_expected_errors().await;
}

#[tokio::test]
async fn the_pages_of_words_fit_into_their_windows() {
    let relay = Relay::start().await;
    let good = relay.rest.create(&send_req("product-name", "ADDR('0.2.0.0.0.0.0')", PRODUCT_NAME)).await;
    let refused = relay
        .rest
        .create(&send_req("no-such-class", "ADDR('0.2.0.0.0.0.0')", "0000 030E EE20 0124 0730"))
        .await;
    for id in [&good, &refused] {
        relay.rest.run(id).await;
    }
    let journey = Journey::start("words_looks").await;
    let mut user = journey.open("user", &page(&relay, "")).await;
    for theme in ["light", "dark"] {
        for (width, height) in [(1280, 900), (900, 900), (480, 900)] {
            user.resize(width, height).await;
            for (name, at) in [
                ("list", String::new()),
                ("new", "/new".to_owned()),
                ("good", format!("/{good}")),
                ("refused", format!("/{refused}")),
            ] {
                user.go(&page(&relay, &at)).await;
                let sign = match name {
                    "list" => "but the device refused",
                    "new" => "Nothing is sent yet.",
                    "good" => "the device agreed",
                    _ => "What to try",
                };
                user.see(sign, PATIENCE).await;
                fits(&mut user, &format!("{theme}-{width}-{name}")).await;
            }
        }
        user.click(if theme == "light" { "Dark" } else { "Light" }).await;
    }
    user.close().await;
}

fn page(relay: &Relay, rest: &str) -> String {
    format!("http://{}/words{rest}", relay.address)
}

fn send_req(name: &str, address: &str, words: &str) -> Value {
    json!({
        "name": name, "kind": "SEND_REQ", "Dialect": "ETC100", "Address": address, "Data_to_Send": words,
        "Management_Param": [0, 0, 30, 2 * words.split(' ').count()],
    })
}

/// What is in a field.
async fn value(user: &Browser, label: &str) -> String {
    user.until(&format!("the value of {label}"), PATIENCE, async |driver| {
        let found = driver.find(thirtyfour::By::XPath(field(label))).await.ok()?;
        found.prop("value").await.ok()?
    })
    .await
}

async fn verdict(user: &Browser, word: &str, says: &str) {
    let xpath = format!("//*[@data-test='verdict' and @data-verdict='{word}']");
    let text = user.find(word, &xpath, PATIENCE).await;
    assert!(text.contains(says), "{text}");
}

async fn fits(user: &mut Browser, stage: &str) {
    user.shot(stage).await;
    let excess = "return document.scrollingElement.scrollWidth - window.innerWidth";
    let excess = user.script(excess).await.as_i64().expect("a number");
    assert!(excess <= 0, "{stage}: {excess} px stick out");
}
