//! Routes, class 3 connections and discovery, from the page to the simulator.

use cipdeck_tests::PATIENCE;
use cipdeck_tests::block;
use cipdeck_tests::browser::{Browser, Journey, field, part};
use cipdeck_tests::command::Service;
use cipdeck_tests::relay::Relay;

#[tokio::test]
async fn a_routed_read_is_explained_sent_and_answered_or_refused_by_a_router() {
    let relay = Relay::start().await;
    relay.rest.create(&block::product_name("0,0")).await;
    let simulator = Service::simulate("127.0.0.1:0", &[]).await;
    let journey = Journey::start("route").await;
    let mut user = journey.open("user", &relay.page()).await;
    user.click("New block").await;
    user.click("How a path is written").await;
    user.shot("path-help").await;
    user.fill("Path", &format!("4,{},1,1", simulator.address)).await;
    user.see("then backplane slot 1, by Unconnected_Send", PATIENCE).await;
    user.see("Unconnected_Send around the request", PATIENCE).await;
    let inner =
        format!("{}//button[contains(@aria-label, 'embedded message › service')]", part("request-bytes"));
    user.point_at(&inner).await;
    user.see("Get_Attribute_Single", PATIENCE).await;
    user.shot("bytes").await;
    user.click("Run").await;
    value(&user, "cipdeck demo I/O").await;
    user.find("the download", &part("pcapng"), PATIENCE).await;
    user.shot("answered").await;

    user.fill("Path", &format!("4,{},1,3,2,192.168.1.20", simulator.address)).await;
    user.see("then backplane slot 3, then port 2 to 192.168.1.20", PATIENCE).await;
    user.click("Run").await;
    value(&user, "cipdeck demo remote").await;

    user.fill("Path", &format!("4,{},1,9", simulator.address)).await;
    user.click("Run").await;
    let cause = user.find("what happened", &part("cause"), PATIENCE).await;
    assert!(cause.contains("A router on the way refused it, not the device."), "{cause}");
    assert!(cause.contains("hop 2, backplane slot 9"), "{cause}");
    let name = user.find("the extended status", &part("error-name"), PATIENCE).await;
    assert!(name.to_lowercase().contains("link address"), "{name}");
    user.shot("refused").await;
    user.close().await;
}

#[tokio::test]
async fn a_connected_read_opens_a_connection_that_the_page_shows() {
    let relay = Relay::start().await;
    relay.rest.create(&block::product_name("0,0")).await;
    let simulator = Service::simulate("127.0.0.1:0", &["--quirk", "own-connection-id"]).await;
    let journey = Journey::start("connected").await;
    let mut user = journey.open("user", &relay.page()).await;
    user.click("New block").await;
    user.fill("Path", &format!("4,{},1,0", simulator.address)).await;
    user.click_at(&format!("{}/option[@value='1']", field("CipConnMode")), "class 3").await;
    user.see("then backplane slot 0, by class 3 connection", PATIENCE).await;
    user.see("in SendUnitData", PATIENCE).await;
    user.shot("made").await;
    user.click("Run").await;
    value(&user, "cipdeck demo drive").await;
    user.shot("answered").await;
    user.click("Connections").await;
    let target = user.find("the target", &part("target"), PATIENCE).await;
    assert!(target.contains("class 3 connection along 1,0"), "{target}");
    assert!(target.contains("requests: 1"), "{target}");
    assert!(target.contains("answers with the connection id of the request"), "{target}");
    user.shot("connections").await;

    user.click("Deck").await;
    user.click("block").await;
    user.click_at(&field("ConnClose"), "ConnClose").await;
    user.click("Run").await;
    let closed = format!("{}//*[@data-bit='CIPCONN' and @data-on='true']", part("status-bits"));
    user.find("that the connection was closed", &closed, PATIENCE).await;
    user.shot("closed").await;
    user.fill("Path", &format!("4,{},2,192.168.1.10,1,9", simulator.address)).await;
    user.click("Run").await;
    let cause = user.find("what happened", &part("cause"), PATIENCE).await;
    assert!(cause.contains("The connection could not be opened."), "{cause}");
    user.shot("not-opened").await;

    user.click("Deck").await;
    user.click("get-1-1-7").await;
    user.click_at("//summary[contains(., 'Timeouts, connection')]", "the section").await;
    for (label, wrong, field) in
        [("KeepAlive", "-1", "KeepAlive"), ("ConnMsgTimeout", "x", "TargetCfg-ConnMsgTimeout")]
    {
        user.fill(label, wrong).await;
        let finding = user.find("a finding", &format!("//*[@id='field-{field}-finding']"), PATIENCE).await;
        assert!(finding.starts_with("Error"), "{label}: {finding}");
        assert!(!user.can_use("run").await, "{label}: Run is disabled");
        user.shot(label).await;
        user.fill(label, "0").await;
    }
    user.close().await;
}

#[tokio::test]
async fn a_device_is_discovered_and_becomes_a_block_that_runs() {
    let relay = Relay::start().await;
    let simulator = Service::simulate("127.0.0.1:0", &[]).await;
    let journey = Journey::start("discover").await;
    let mut user = journey.open("user", &relay.page()).await;
    user.click("Discover devices").await;
    user.see("one ListIdentity datagram of 24 bytes", PATIENCE).await;
    user.fill("Addresses", "10.0.0.256").await;
    user.see("“10.0.0.256” is not an IPv4 address", PATIENCE).await;
    user.fill("Listen for", "5").await;
    user.see("5 is outside 100 to 10000", PATIENCE).await;
    assert!(!user.can_use("discover-do").await, "nothing is asked");
    user.shot("findings").await;
    user.fill("Listen for", "300").await;
    // A broadcast address of no network here: only the relay can know.
    user.fill("Addresses", "255.255.255.255").await;
    user.click_part("discover-do").await;
    let refused = user.find("a finding", "//*[@id='discover-addresses-finding']", PATIENCE).await;
    assert!(refused.contains("255.255.255.255"), "{refused}");
    user.shot("refused").await;
    // A port of loopback at which nobody listens.
    user.fill("Addresses", "127.0.0.1:9").await;
    user.click_part("discover-do").await;
    user.find("that nobody answered", &part("nobody"), PATIENCE).await;
    user.shot("nobody").await;
    user.fill("Addresses", &simulator.address).await;
    user.click_part("discover-do").await;
    let device = user.find("the device", &part("device"), PATIENCE).await;
    for text in
        ["cipdeck demo drive", "AC Drive Device", "1.001", "00c1dec0", "operational", &simulator.address]
    {
        assert!(device.contains(text), "{text} in {device}");
    }
    user.shot("found").await;
    user.click("New block").await;
    user.click("Run").await;
    value(&user, "cipdeck demo drive").await;
    user.shot("ran").await;
    // The refused request.
    user.close_with_expected_errors().await;
}

async fn value(user: &Browser, text: &str) {
    let value = format!("{}[contains(., '{text}')]", part("decoded-value"));
    user.find(text, &value, PATIENCE).await;
}
