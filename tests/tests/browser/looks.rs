//! Every page in both themes and three widths: nothing sticks out. The screenshots are for people.

use cipdeck_tests::PATIENCE;
use cipdeck_tests::block::{self, with};
use cipdeck_tests::browser::{Browser, Journey};
use cipdeck_tests::relay::Relay;
use serde_json::json;

#[tokio::test]
async fn no_page_sticks_out_of_its_window() {
    let relay = Relay::start().await;
    let good = relay.rest.create(&with(block::product_name("0,0"), "/name", "drive-name")).await;
    let wrong = relay.rest.create(&with(block::get("0,0", 238, 1, 1), "/name", "no-such-class")).await;
    for id in [&good, &wrong] {
        relay.rest.run(id).await;
    }
    let cyclic = with(block::get("0,0", 147, 7, 9), "/CtrlCfg", json!({ "TriggerType": 1000 }));
    let cyclic = relay.rest.create(&with(cyclic, "/name", "drive-current")).await;
    relay.rest.post(&format!("blocks/{cyclic}/in"), &json!({ "IN": true })).await;
    let journey = Journey::start("looks").await;
    let mut user = journey.open("user", &relay.page()).await;
    for theme in ["light", "dark"] {
        for width in [1440, 1024, 480] {
            user.resize(width, 900).await;
            user.click("Deck").await;
            fits(&mut user, &format!("{theme}-{width}-deck")).await;
            for name in ["drive-name", "no-such-class"] {
                user.click("Monitor").await;
                user.click(name).await;
                user.see("Result", PATIENCE).await;
                fits(&mut user, &format!("{theme}-{width}-{name}")).await;
            }
            for page in ["Monitor", "Connections", "Help"] {
                user.click(page).await;
                fits(&mut user, &format!("{theme}-{width}-{page}")).await;
            }
        }
        user.click(if theme == "light" { "Dark" } else { "Light" }).await;
    }
    user.close().await;
}

async fn fits(user: &mut Browser, stage: &str) {
    user.shot(stage).await;
    let excess = "return document.scrollingElement.scrollWidth - window.innerWidth";
    let excess = user.script(excess).await.as_i64().expect("a number");
    assert!(excess <= 0, "{stage}: {excess} px stick out");
}
