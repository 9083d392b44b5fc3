//! A relay as it is shipped, over TLS: set-up with the code, three users, a write in a window that everybody sees, a
//! tablet that is locked out while it watches.

use std::time::{Duration, Instant};

use cipdeck_tests::PATIENCE;
use cipdeck_tests::block;
use cipdeck_tests::browser::{Browser, Journey, control, part};
use cipdeck_tests::command::Service;
use cipdeck_tests::measure::measured;
use cipdeck_tests::shipped::Shipped;

const PASSWORD: &str = "correct horse battery staple";
/// Until somebody who is locked out sees it.
const LOCKED_OUT: Duration = Duration::from_secs(1);
/// What two browsers on a busy machine may add until the page has shown it and WebDriver has read it.
const GRACE: Duration = Duration::from_secs(1);

#[tokio::test]
async fn a_relay_is_set_up_and_each_role_does_its_part() {
    let relay = Shipped::start().await;
    let drive = Service::simulate("127.0.0.1:0", &[]).await;
    let journey = Journey::start("office").await;
    let mut admin = journey.open_trusting("admin", &format!("http://{}/", relay.address)).await;
    set_up(&mut admin, &relay).await;
    let secure = relay.secure().await;

    admin.go(&format!("{secure}/office/users")).await;
    admin.see("You are signed out", PATIENCE).await;
    admin.click_part("sign-in-link").await;
    sign_in(&mut admin, "root").await;
    for (name, role) in [("eva", "engineer"), ("otto", "operator"), ("vera", "viewer")] {
        add_user(&mut admin, name, role).await;
    }
    admin.shot("users").await;
    admin.click("Allowed").await;
    admin.fill("Target", &drive.address).await;
    admin.click_part("add-target").await;
    admin.find("the target is listed", &part("allowed-target"), PATIENCE).await;
    admin.shot("allowed").await;
    let link = make_link(&mut admin).await;

    let mut eva = journey.open_trusting("eva", &format!("{secure}/office/sign-in?next=%2F")).await;
    sign_in(&mut eva, "eva").await;
    eva.see("Send a first message", PATIENCE).await;
    let mut tablet = watching(&journey, &link).await;
    writes(&mut eva, &mut tablet, &drive.address).await;

    let mut otto = journey.open_trusting("otto", &format!("{secure}/office/sign-in?next=%2Fdeck%2Fb1")).await;
    sign_in(&mut otto, "otto").await;
    is_refused(&mut otto).await;
    closes_the_window(&mut otto, &eva).await;

    is_locked_out(&mut admin, &mut tablet).await;
    leaves_a_trail(&mut admin).await;
    for browser in [admin, eva, otto, tablet] {
        // What is refused is logged by the browser itself.
        browser.close_with_expected_errors().await;
    }
}

/// The first administrator, with a wrong code before the right one.
async fn set_up(admin: &mut Browser, relay: &Shipped) {
    admin.see("This relay is not set up yet", PATIENCE).await;
    admin.click("Set it up").await;
    admin.fill("Set-up code", "0000-0000-0000").await;
    admin.fill("Name of the administrator", "root").await;
    admin.fill("Password", "short").await;
    admin.click_part("set-up").await;
    admin.see("at least 12 characters: 7 more", PATIENCE).await;
    admin.fill("Password", PASSWORD).await;
    admin.click_part("set-up").await;
    admin.see("this is not the set-up code", PATIENCE).await;
    admin.shot("wrong-code").await;
    let code = relay.code().await.to_lowercase().replace('-', " ");
    admin.fill("Set-up code", &code).await;
    admin
        .until("the administrator is made", PATIENCE, async |_| {
            // After a wrong code the relay waits for a moment.
            let page = admin.text().await;
            if page.contains("The administrator is made") {
                return Some(());
            }
            admin.script("document.querySelector('[data-test=set-up]')?.click()").await;
            None
        })
        .await;
    admin.shot("set-up").await;
    let shown = admin.find("the fingerprint", &part("fingerprint"), PATIENCE).await;
    assert_eq!(shown, relay.fingerprint().await, "what the terminal shows, too");
}

async fn sign_in(user: &mut Browser, name: &str) {
    user.fill("Name", name).await;
    user.fill("Password", PASSWORD).await;
    user.click_part("sign-in").await;
    user.see(&format!("{name}, "), PATIENCE).await;
}

async fn add_user(admin: &mut Browser, name: &str, role: &str) {
    admin.fill("Name", name).await;
    admin.fill("Role", role).await;
    admin.fill("First password", PASSWORD).await;
    admin.click_part("add-user").await;
    admin.see(&format!("{name} can sign in now"), PATIENCE).await;
}

/// A view link, as the tablet's camera reads it from the QR code.
async fn make_link(admin: &mut Browser) -> String {
    admin.click("View links").await;
    admin.fill("Where the tablet hangs", "line-4").await;
    admin.click_part("make-link").await;
    admin.find("the QR code", &part("qr"), PATIENCE).await;
    admin.shot("view-link").await;
    admin.find("the address", &part("link-url"), PATIENCE).await
}

/// A tablet that hangs on the wall.
async fn watching(journey: &Journey, link: &str) -> Browser {
    let mut tablet = journey.open_trusting("tablet", "about:blank").await;
    tablet.resize(768, 1024).await;
    tablet.go(link).await;
    tablet.see("line-4, view link", PATIENCE).await;
    tablet.shot("monitor-empty").await;
    tablet
}

/// The engineer opens the window, sees old and new, confirms; the tablet sees the window and has no commands.
async fn writes(eva: &mut Browser, tablet: &mut Browser, drive: &str) {
    let path = format!("4,{drive}");
    eva.fill("Address of the device", drive).await;
    eva.click("Send").await;
    eva.see("cipdeck demo drive", PATIENCE).await;
    eva.click("Paste").await;
    eva.fill("JSON of a block", &block::set(&path, 147, 41, 9, "f401").to_string()).await;
    eva.click("Add block").await;
    eva.click("Write…").await;
    eva.see("Open the write window?", PATIENCE).await;
    eva.click_part("window-open").await;
    eva.find("the old value", &part("write-old"), PATIENCE).await;
    eva.find("the new value", &part("write-new"), PATIENCE).await;
    eva.shot("old-and-new").await;
    tablet.see("Writing is possible. Opened by eva", PATIENCE).await;
    assert!(!tablet.can_use("window-close").await, "a tablet closes nothing");
    eva.click_part("write-confirm").await;
    eva.see("Written, and read back as written.", PATIENCE).await;
    eva.shot("written").await;

    tablet.see("set-147-41-9", PATIENCE).await;
    fits(tablet, "monitor-light").await;
    tablet.click_part("theme").await;
    fits(tablet, "monitor-dark").await;
    tablet.click("set-147-41-9").await;
    tablet.see("You may look only", PATIENCE).await;
    assert!(!tablet.can_use("run").await && !tablet.can_use("in-switch").await);
    fits(tablet, "block-dark").await;
}

/// What is not on the list of writes is refused in words, before anything is sent.
async fn is_refused(otto: &mut Browser) {
    otto.click("set-147-41-9").await;
    otto.click("Write…").await;
    let why = otto.find("the refusal", &part("write-refused"), PATIENCE).await;
    assert!(why.contains("list"), "{why}");
    otto.shot("refused").await;
    otto.click_part("write-cancel").await;
}

async fn closes_the_window(otto: &mut Browser, eva: &Browser) {
    otto.click_part("window-close").await;
    otto.gone("the banner", &part("write-banner")).await;
    eva.gone("the banner", &part("write-banner")).await;
}

async fn is_locked_out(admin: &mut Browser, tablet: &mut Browser) {
    admin.click("Revoke").await;
    let confirm = format!("//dialog{}", control("Revoke"));
    let started = Instant::now();
    admin.click_at(&confirm, "Revoke").await;
    tablet.see("You are signed out", LOCKED_OUT + GRACE).await;
    measured(format!(
        "a tablet shows that it is locked out {:?} after the click on Revoke",
        started.elapsed()
    ));
    tablet.shot("locked-out").await;
    assert!(!tablet.text().await.contains("set-147-41-9"), "nothing of the plant is left on the screen");
}

async fn leaves_a_trail(admin: &mut Browser) {
    admin.click("Audit").await;
    admin.see("The chain has been read from its beginning, and holds.", PATIENCE).await;
    let events = ["write_requested", "write_permitted", "write_ended", "window_closed", "token_revoked"];
    for event in events {
        admin.find(event, &format!("//tr[@data-event='{event}']"), PATIENCE).await;
    }
    admin.shot("audit").await;
    admin.click("History").await;
    admin.find("a run", &part("run"), PATIENCE).await;
    admin.shot("history").await;
}

async fn fits(user: &mut Browser, stage: &str) {
    user.shot(stage).await;
    let excess = "return document.scrollingElement.scrollWidth - window.innerWidth";
    let excess = user.script(excess).await.as_i64().expect("a number");
    assert!(excess <= 0, "{stage}: {excess} px stick out");
}
