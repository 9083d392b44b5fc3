//! The devices' document against simulated controllers: from an empty page to a changed value, a bad tag among good ones,
//! a cable that is pulled.

use std::fmt::Write as _;
use std::time::Instant;

use cipdeck_tests::PATIENCE;
use cipdeck_tests::browser::{Browser, Journey, part};
use cipdeck_tests::command::Service;
use cipdeck_tests::measure::measured;
use cipdeck_tests::relay::Relay;
use cipdeck_tests::rest::Rest;
use serde_json::{Value, json};

use crate::monitor::{BUDGET_MS, spent_in_frames};

/// Of the screen.
const FRAMES_PER_SECOND: f64 = 60.0;

const OMRON: [&str; 2] = ["--profile", "omron"];

#[tokio::test]
async fn a_device_a_group_and_variables_are_made_read_and_changed() {
    let plc = Service::simulate("127.0.0.1:0", &OMRON).await;
    let relay = Relay::start().await;
    let journey = Journey::start("devices").await;
    let mut user = journey.open("user", &format!("{}devices", relay.page())).await;
    user.see("No devices yet", PATIENCE).await;
    user.shot("empty").await;
    makes_the_device(&mut user, &plc.address).await;
    makes_the_group(&mut user).await;
    adds_a_variable(&mut user).await;
    adds_parts(&mut user).await;
    reads(&mut user).await;
    looks(&mut user).await;
    changes_a_value(&mut user).await;
    copies_the_device(&mut user).await;
    // Findings are answers with another status, which the browser logs.
    user.close_with_expected_errors().await;
}

async fn makes_the_device(user: &mut Browser, address: &str) {
    user.click("New device").await;
    user.click_part("store-device").await;
    user.see("must not be empty", PATIENCE).await;
    user.fill("Name", "NX line 4").await;
    user.fill("Site", "Hall 3").await;
    user.fill("Path", "4,not an address").await;
    user.click_at("//select[@id='device-profile']/option[@value='omron']", "Omron").await;
    user.click_part("store-device").await;
    user.find("the finding at the path", "//*[@id='device-path-said'][@role='alert']", PATIENCE).await;
    user.shot("device-wrong").await;
    user.fill("Addresses", address).await;
    user.click_part("find-do").await;
    user.see("cipdeck demo NX", PATIENCE).await;
    user.click("Take over").await;
    user.until("the path is filled in", PATIENCE, async |driver| {
        let path = driver.find(thirtyfour::By::Id("device-path")).await.ok()?.prop("value").await.ok()??;
        (path == format!("4,{address}")).then_some(())
    })
    .await;
    user.fill("Name", "NX line 4").await;
    user.fill("Site", "Hall 3").await;
    user.shot("device").await;
    user.click_part("store-device").await;
    user.see("This device has none yet", PATIENCE).await;
}

async fn makes_the_group(user: &mut Browser) {
    user.fill("New group", "Process").await;
    user.fill("Reads every, ms", "5").await;
    user.see("a number from 10 to 3600000 is needed", PATIENCE).await;
    user.fill("Reads every, ms", "200").await;
    user.shot("group").await;
    user.click_part("add-group").await;
    user.see("This group has no variables yet.", PATIENCE).await;
}

async fn adds_a_variable(user: &mut Browser) {
    user.click_part("add-variable").await;
    user.click_part("store-variable").await;
    user.see("must not be empty", PATIENCE).await;
    user.fill("Address", "a..b").await;
    user.click_part("store-variable").await;
    user.find("the finding at the address", "//*[@id='variable-address-said'][@role='alert']", PATIENCE)
        .await;
    user.shot("variable-wrong").await;
    user.fill("Address", "grHWCs_PV").await;
    user.fill("Unit", "°C").await;
    user.shot("variable").await;
    user.click_part("store-variable").await;
    user.find("the variable", &row("grHWCs_PV"), PATIENCE).await;
}

/// A structure before its member, an array before its element.
async fn adds_parts(user: &mut Browser) {
    for (shape, parent, own) in [("structure", "stSet", "speed"), ("array", "arSet", "[3]")] {
        user.click_part("add-variable").await;
        user.click_at(&format!("//input[@id='shape-{shape}']"), shape).await;
        user.fill("Address", parent).await;
        user.shot(shape).await;
        user.click_part("store-variable").await;
        user.see(&format!("Add a part of {parent}"), PATIENCE).await;
        user.fill("Address", own).await;
        user.click_at("//input[@id='variable-writable']", "May be written").await;
        let whole = user.find("the full address", &part("full-address"), PATIENCE).await;
        assert!(whole.ends_with(&cipdeck_shared::config::join_address(parent, own)), "{whole}");
        user.shot(&format!("{shape}-part")).await;
        user.click_part("store-variable").await;
        user.find("the part", &row(own), PATIENCE).await;
    }
    user.see("5 variables. The group is off", PATIENCE).await;
    user.shot("off").await;
}

async fn reads(user: &mut Browser) {
    user.click_part("group-switch").await;
    user.see("5 variables: 5 good, 0 stale, 0 bad, 0 waiting", PATIENCE).await;
    assert_eq!(user.find("speed", &value("speed"), PATIENCE).await, "1500");
    assert_eq!(user.find("an element", &value("[3]"), PATIENCE).await, "40");
    let before = user.find("a value that moves", &value("grHWCs_PV"), PATIENCE).await;
    user.until("another value", PATIENCE, async |driver| {
        let now = driver.find(thirtyfour::By::XPath(value("grHWCs_PV"))).await.ok()?.text().await.ok()?;
        (now != before).then_some(())
    })
    .await;
    user.shot("values").await;
}

/// The trend, the other pages, both themes, and narrow windows.
async fn looks(user: &mut Browser) {
    user.click_at(&format!("{}//input[@type='checkbox']", row("grHWCs_PV")), "trend").await;
    // Some seconds of it.
    user.find("a line", "//*[name()='path'][@data-test='series'][string-length(@d) > 200]", PATIENCE).await;
    fits(user, "trend").await;
    user.click_part("theme").await;
    fits(user, "trend-other-theme").await;
    user.click_part("trend-pause").await;
    user.click_part("trend-close").await;
    user.resize(800, 1000).await;
    fits(user, "narrow").await;
    user.resize(1280, 860).await;
    user.click("NX line 4").await;
    user.see("Requests to read all once", PATIENCE).await;
    user.see("answers", PATIENCE).await;
    fits(user, "device-state").await;
    user.click("Process").await;
}

/// Old and new before, read back after, and in the list of writes.
async fn changes_a_value(user: &mut Browser) {
    user.click("Write speed").await;
    user.see("Open the write window?", PATIENCE).await;
    user.shot("window").await;
    user.click_part("window-open").await;
    user.fill("New value", "fast").await;
    user.click_part("write-ask").await;
    user.find("the finding", "//*[@id='new-value-said'][@role='alert']", PATIENCE).await;
    user.shot("value-wrong").await;
    user.fill("New value", "1450.5").await;
    user.click_part("write-ask").await;
    assert_eq!(user.find("the old value", &part("write-old"), PATIENCE).await, "1500");
    assert_eq!(user.find("the new value", &part("write-new"), PATIENCE).await, "1450.5");
    user.shot("old-and-new").await;
    user.click_part("write-confirm").await;
    user.see("Written, and read back as written.", PATIENCE).await;
    user.shot("written").await;
    user.click_part("close").await;
    user.until("the new value in the table", PATIENCE, async |driver| {
        let now = driver.find(thirtyfour::By::XPath(value("speed"))).await.ok()?.text().await.ok()?;
        (now == "1450.5").then_some(())
    })
    .await;
    user.click("NX line 4").await;
    let entry = user.find("the entry in the list", &part("write-line"), PATIENCE).await;
    assert!(entry.contains("stSet.speed") && entry.contains("1450.5"), "{entry}");
    user.shot("writes").await;
}

/// With its groups and variables, which are not read before somebody says so.
async fn copies_the_device(user: &mut Browser) {
    user.click_part("copy-device").await;
    user.fill_at("//input[@id='copy-path']", "Path", "4,127.0.0.1:1").await;
    user.shot("copy").await;
    user.click_part("copy-do").await;
    user.see("NX line 4 copy", PATIENCE).await;
    user.click_at("//tr[@data-test='group-line']//a", "the copied group").await;
    user.see("5 variables. The group is off", PATIENCE).await;
    user.shot("copied").await;
}

#[tokio::test]
async fn what_a_device_has_is_listed_searched_and_added() {
    let plc = Service::simulate("127.0.0.1:0", &OMRON).await;
    let relay = Relay::start().await;
    let group = made_by_rest(&relay.rest, &plc.address, 200).await;
    let journey = Journey::start("devices_browse").await;
    let mut user = journey.open("user", &format!("{}devices/{group}", relay.page())).await;
    user.click_part("browse").await;
    user.until("all names are there", PATIENCE, async |driver| {
        let progress =
            driver.find(thirtyfour::By::XPath(part("browse-progress"))).await.ok()?.text().await.ok()?;
        progress.contains("names, in").then_some(())
    })
    .await;
    user.shot("listed").await;
    user.fill("Search names and types", "stmotor").await;
    let line = "//tr[@data-test='symbol'][@data-name='stMotor']";
    user.click_at(&format!("{line}//button"), "members").await;
    let member = "//tr[@data-test='symbol'][@data-name='stMotor.speed']//input";
    user.click_at(member, "stMotor.speed").await;
    user.shot("members").await;
    user.fill("Search names and types", "TAG").await;
    user.click_at("//tr[@data-test='symbol'][@data-name='TAG1']//input", "TAG1").await;
    user.see("2 ticked", PATIENCE).await;
    user.click_part("browse-add").await;
    // The member brings along its structure.
    user.see("3 variables: 3 good", PATIENCE).await;
    user.find("the member", &row("speed"), PATIENCE).await;
    user.shot("added").await;
    user.close().await;
}

#[tokio::test]
async fn five_thousand_variables_stay_within_the_budget_of_a_frame() {
    let plc = Service::simulate("127.0.0.1:0", &OMRON).await;
    let relay = Relay::start().await;
    let group = made_by_rest(&relay.rest, &plc.address, 1000).await;
    let variable = |number: usize| json!({ "name": format!("temperature {number:04}"), "address": format!("arTemp[{}]", number % 10) });
    let new = json!({ "variables": (0..5000).map(variable).collect::<Vec<_>>() });
    let reply = relay.rest.post(&format!("groups/{group}/variables"), &new).await;
    assert_eq!(reply.status, 201, "{reply:?}");
    let journey = Journey::start("devices_5000").await;
    let mut user = journey.open("user", &format!("{}devices/{group}", relay.page())).await;
    user.see("5000 variables: 5000 good", PATIENCE).await;
    user.chromium("Performance.enable", json!({})).await;
    let begin = Instant::now();
    let (spent, all) = spent_in_frames(&user, 10.0).await;
    let seconds = begin.elapsed().as_secs_f64();
    user.shot("live").await;
    let rows = user.script("return document.querySelectorAll('[data-test=variable]').length").await;
    let per_frame = spent / (seconds * FRAMES_PER_SECOND);
    measured(format!(
        "Devices, 5,000 variables that all change every second: {:.1} ms of script for each of {all} pictures with \
         new values, {per_frame:.2} ms for each of {FRAMES_PER_SECOND} frames a second; {rows} rows are in the document",
        spent / all
    ));
    assert!(rows.as_u64().is_some_and(|rows| rows < 100), "windowed: {rows}");
    assert!(per_frame < BUDGET_MS, "{per_frame} ms of script per frame");
    user.close().await;
}

#[tokio::test]
async fn a_bad_tag_among_fifty_good_ones_is_told_and_the_others_are_read() {
    let plc = Service::simulate("127.0.0.1:0", &OMRON).await;
    let relay = Relay::start().await;
    let group = made_by_rest(&relay.rest, &plc.address, 200).await;
    let journey = Journey::start("devices_bad_tag").await;
    let mut user = journey.open("user", &format!("{}devices/{group}", relay.page())).await;
    user.click_part("paste").await;
    let mut lines = "name\taddress\ttype\n".to_owned();
    for number in 0..50 {
        let _ = writeln!(lines, "long {number:02}\tarLong[{number}]\tDINT");
    }
    lines += "wrong\tno_such_tag\tDINT\nbroken\tx..y\tDINT\n";
    // As a paste: keys would move the focus at each tab.
    let script = format!(
        "const area = document.getElementById('paste-text'); area.value = {}; \
         area.dispatchEvent(new InputEvent('input', {{ bubbles: true }})); return 0",
        json!(lines)
    );
    user.script(&script).await;
    user.see("51 good, 1 wrong", PATIENCE).await;
    user.find("the broken line", &part("preview-wrong"), PATIENCE).await;
    user.shot("preview").await;
    user.click_part("paste-do").await;
    user.see("51 variables: 50 good, 0 stale, 1 bad, 0 waiting", PATIENCE).await;
    user.fill("Filter variables", "wrong").await;
    let why = user.find("the reason", &format!("{}//*[@data-test='reason']", row("wrong")), PATIENCE).await;
    assert!(!why.is_empty());
    user.shot("bad").await;
    user.close().await;
}

#[tokio::test]
async fn a_pulled_cable_is_seen_and_values_come_back_by_themselves() {
    let plc = Service::simulate("127.0.0.1:0", &OMRON).await;
    let address = plc.address.clone();
    let relay = Relay::start().await;
    let group = made_by_rest(&relay.rest, &address, 200).await;
    let new = json!({ "variables": [{ "name": "PV", "address": "grHWCs_PV" }, { "name": "SP", "address": "grHWCs_SP" }] });
    relay.rest.post(&format!("groups/{group}/variables"), &new).await;
    let journey = Journey::start("devices_cable").await;
    let mut user = journey.open("user", &format!("{}devices/{group}", relay.page())).await;
    user.see("2 variables: 2 good", PATIENCE).await;
    plc.process.kill();
    user.see("2 variables: 0 good, 2 stale", PATIENCE).await;
    assert_eq!(user.find("the last value", &value("SP"), PATIENCE).await, "65", "it stays, and is marked");
    user.see("no answer", PATIENCE).await;
    user.find("why, in words", &part("device-trouble"), PATIENCE).await;
    user.shot("pulled").await;
    drop(plc);
    let _plc = Service::simulate(&address, &OMRON).await;
    user.see("2 variables: 2 good", PATIENCE).await;
    user.see("answers", PATIENCE).await;
    user.shot("back").await;
    user.close().await;
}

/// The line of a variable.
fn row(name: &str) -> String {
    format!("//tr[@data-test='variable'][@data-name='{name}']")
}

/// The value of a variable.
fn value(name: &str) -> String {
    format!("{}//*[@data-test='value']", row(name))
}

/// A device with one group that is read; the group's id.
async fn made_by_rest(rest: &Rest, address: &str, period_ms: u32) -> String {
    let made = async |path: &str, body: Value| {
        let reply = rest.post(path, &body).await;
        assert_eq!(reply.status, 201, "{path} {body}: {reply:?}");
        reply.body["id"].as_str().expect("an id").to_owned()
    };
    let path = format!("4,{address}");
    let device = json!({ "name": "NX", "path": path, "profile": "omron", "timeout_ms": 500 });
    let device = made("devices", device).await;
    made("groups", json!({ "device": device, "name": "Process", "period_ms": period_ms, "on": true })).await
}

async fn fits(user: &mut Browser, stage: &str) {
    user.shot(stage).await;
    let excess = "return document.scrollingElement.scrollWidth - window.innerWidth";
    let excess = user.script(excess).await.as_i64().expect("a number");
    assert!(excess <= 0, "{stage}: {excess} px stick out");
}
