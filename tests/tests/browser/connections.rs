//! The Connections page: who holds a buffer, who waits and why, and targets that do not answer.

use cipdeck_tests::PATIENCE;
use cipdeck_tests::block::{self, with};
use cipdeck_tests::browser::{Browser, Journey, part};
use cipdeck_tests::fake_plc::{self, Act, FakePlc, messages};
use cipdeck_tests::relay::Relay;
use serde_json::json;
use tokio::net::TcpListener;

#[tokio::test]
async fn five_slow_targets_hold_four_buffers_and_the_fifth_waits() {
    let relay = Relay::start().await;
    // First, because it may have to wait for its turn: the messages wait for ten seconds only.
    let journey = Journey::start("connections_five_targets").await;
    let mut user = journey.open("user", &relay.page()).await;
    let mut targets = Vec::new();
    for number in 1..=5 {
        let target =
            FakePlc::start(messages(|request| vec![Act::Hold, Act::Send(request.success(&[1]))])).await;
        trigger(&relay, &format!("tank-{number}"), &target.path()).await;
        targets.push(target);
    }
    user.click("Connections").await;
    user.see("4 of 4 buffers held, 1 waiting", PATIENCE).await;
    assert_eq!(count(&user, &format!("{}[@data-held='true']", part("buffer"))).await, 4);
    let waiting = user.find("who waits", &part("waiting"), PATIENCE).await;
    assert!(waiting.contains("tank-5") && waiting.contains(&targets[4].address().to_string()), "{waiting}");
    assert!(
        waiting.contains("waits for a buffer: all are held by tank-1, tank-2, tank-3, tank-4"),
        "{waiting}"
    );
    in_both_themes(&mut user, "four-of-five").await;
    targets[1].release();
    user.see("4 of 4 buffers held, 0 waiting", PATIENCE).await;
    let second = user.find("the second buffer", &format!("({})[2]", part("buffer")), PATIENCE).await;
    assert!(second.contains("tank-5"), "the free buffer is taken, the others stay: {second}");
    for target in [&targets[0], &targets[2], &targets[3], &targets[4]] {
        target.release();
    }
    user.see("0 of 4 buffers held, 0 waiting", PATIENCE).await;
    user.see("session open", PATIENCE).await;
    user.shot("all-answered").await;
    user.close().await;
}

#[tokio::test]
async fn a_second_message_to_a_busy_target_says_what_it_waits_for() {
    let relay = Relay::start().await;
    // First, because it may have to wait for its turn: the messages wait for ten seconds only.
    let journey = Journey::start("connections_busy_target").await;
    let mut user = journey.open("user", &relay.page()).await;
    let target = FakePlc::start(messages(|request| vec![Act::Hold, Act::Send(request.success(&[1]))])).await;
    trigger(&relay, "tank-level", &target.path()).await;
    user.click("Connections").await;
    user.see("sent, waits for the reply", PATIENCE).await;
    trigger(&relay, "tank-name", &target.path()).await;
    user.see("holds a buffer, waits for its target: busy with tank-level", PATIENCE).await;
    user.shot("busy").await;
    target.release();
    target.release();
    user.see("0 of 4 buffers held", PATIENCE).await;
    user.close().await;
}

#[tokio::test]
async fn a_dead_target_is_one_message_with_its_blocks_under_it() {
    let relay = Relay::start().await;
    let dead = TcpListener::bind(("127.0.0.1", 0)).await.expect("a free port").local_addr().expect("bound");
    let path = fake_plc::path(dead);
    for name in ["pump-speed", "pump-current", "pump-state"] {
        let id = relay.rest.create(&with(block::product_name(&path), "/name", name)).await;
        assert_eq!(relay.rest.run(&id).await["Status"]["Error"], true);
    }
    relay.rest.create(&with(block::product_name("0,0"), "/name", "demo")).await;
    let journey = Journey::start("connections_dead_target").await;
    let mut user = journey.open("user", &relay.page()).await;
    for page in ["Monitor", "Connections"] {
        user.click(page).await;
        let message = user.find("the message", &part("down"), PATIENCE).await;
        assert!(message.contains(&dead.to_string()) && message.contains("3 blocks"), "{page}: {message}");
        assert!(message.contains("refused"), "{page}: {message}");
        assert_eq!(count(&user, &part("down")).await, 1, "one message");
        in_both_themes(&mut user, page).await;
        user.click_at(&format!("{}/summary", part("down")), "the message").await;
        for name in ["pump-speed", "pump-current", "pump-state"] {
            user.find(name, &format!("{}//a[.='{name}']", part("down")), PATIENCE).await;
        }
        user.shot(&format!("{page}-open")).await;
    }
    user.click("Monitor").await;
    let red =
        "//td[contains(@class, 'col-error') and not(contains(@class, 'quiet')) and string-length(.) > 0]";
    assert_eq!(count(&user, red).await, 0, "no row repeats it");
    user.close().await;
}

/// Stores a block of this name and sets its IN.
async fn trigger(relay: &Relay, name: &str, path: &str) {
    let block = with(with(block::product_name(path), "/name", name), "/TargetCfg/UcmmTimeout", 10_000);
    let id = relay.rest.create(&block).await;
    let reply = relay.rest.post(&format!("blocks/{id}/in"), &json!({ "IN": true })).await;
    assert_eq!(reply.status, 200, "{reply:?}");
}

async fn count(user: &Browser, xpath: &str) -> usize {
    let script = format!("return document.evaluate(\"count({xpath})\", document).numberValue");
    let count = user.script(&script).await.as_u64().expect("a count");
    usize::try_from(count).expect("few")
}

/// Screenshots for people.
async fn in_both_themes(user: &mut Browser, stage: &str) {
    for theme in ["light", "dark"] {
        for width in [1280, 900] {
            user.resize(width, 800).await;
            user.shot(&format!("{stage}-{theme}-{width}")).await;
        }
        user.click(if theme == "light" { "Dark" } else { "Light" }).await;
    }
    user.resize(1280, 800).await;
}
